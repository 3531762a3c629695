"""What is driven in tan2015's tests: a run-up, the training, the outage."""

from __future__ import annotations

from itertools import pairwise
from typing import Final

from numpy.random import Generator

from gapless.simulate import Segment
from gapless.units import DEG

KMH: Final = 1.0 / 3.6


def _change(a: float, b: float, seconds: float) -> Segment:
    return Segment(seconds, (b - a) / seconds)


def _turn(angle: float, seconds: float) -> Segment:
    return Segment(seconds, 0.0, angle * DEG / seconds)


def _run_up(speed: float, rng: Generator) -> tuple[Segment, ...]:
    """300 s from rest to a cruise, through what lets a filter find its biases: stops, corners, changes."""
    corners = [float(rng.normal(90.0, 4.0)) * (1.0 if rng.random() < 0.5 else -1.0) for _ in range(4)]
    slow = min(speed, 5.6)
    return (
        Segment(30.0), _change(0.0, slow, 10.0), Segment(10.0), _turn(corners[0], 6.0), Segment(24.0),
        _turn(corners[1], 6.0), Segment(14.0), _change(slow, 0.0, 8.0), Segment(12.0),  # to 120 s
        _change(0.0, slow, 8.0), Segment(22.0), _turn(corners[2], 6.0), Segment(24.0),
        _turn(corners[3], 6.0), Segment(14.0), _change(slow, 0.0, 8.0), Segment(12.0),  # to 220 s
        _change(0.0, speed, 20.0), Segment(60.0),
    )  # fmt: skip


def _wavering(seconds: float, size: float, rng: Generator) -> tuple[Segment, ...]:
    """Straight on, the speed wavering by some size [m/s] and coming back, in pieces of ten seconds."""
    pieces = round(seconds / 10.0)
    steps = size * rng.standard_normal(pieces + 1)
    steps[0] = steps[-1] = 0.0
    return tuple(_change(a, b, 10.0) for a, b in pairwise(steps))


def slow_straight(rng: Generator) -> tuple[Segment, ...]:
    """Test 1: 20 km/h on a straight; the outage of 120 s follows the training.

    Parameters
    ----------
    rng : numpy.random.Generator

    Returns
    -------
    tuple of Segment
        The outage is from 400 s to 520 s.
    """
    v = 20.0 * KMH
    return (*_run_up(v, rng), *_wavering(100.0, 0.1, rng), *_wavering(140.0, 0.1, rng))


def with_a_stop(rng: Generator) -> tuple[Segment, ...]:
    """Test 1 with the 99 s at a crossroad that the paper leaves out of the training.

    Parameters
    ----------
    rng : numpy.random.Generator

    Returns
    -------
    tuple of Segment
        The outage is from 499 s to 619 s.
    """
    v = 20.0 * KMH
    stop = (_change(v, 0.0, 8.0), Segment(83.0), _change(0.0, v, 8.0))
    return (*_run_up(v, rng), *_wavering(100.0, 0.1, rng), *stop, *_wavering(140.0, 0.1, rng))


def fast_straight(rng: Generator) -> tuple[Segment, ...]:
    """Test 2: 70 km/h on a straight, not steady; the outage of 240 s follows the training.

    Parameters
    ----------
    rng : numpy.random.Generator

    Returns
    -------
    tuple of Segment
        The outage is from 560 s to 800 s.
    """
    v = 70.0 * KMH
    return (*_run_up(v, rng), *_wavering(260.0, 1.0, rng), *_wavering(260.0, 1.0, rng))


def _curve() -> tuple[Segment, ...]:
    """81 s at 20 km/h: sixty degrees to the right, straight on, and back."""
    return _turn(60.0, 30.0), Segment(21.0), _turn(-60.0, 30.0)


def slow_curve(rng: Generator) -> tuple[Segment, ...]:
    """Test 3: 20 km/h along a curve, trained on one like it, with the same headings; an outage of 81 s.

    Parameters
    ----------
    rng : numpy.random.Generator

    Returns
    -------
    tuple of Segment
        Curves from 313 s, and from 394 s to 475 s in the outage.
    """
    return (*_run_up(20.0 * KMH, rng), Segment(13.0), *_curve(), *_curve(), Segment(30.0))


def round_the_block(rng: Generator) -> tuple[Segment, ...]:
    """Test 3 with a way round a block between the curve that is trained on and the same in the outage.

    Parameters
    ----------
    rng : numpy.random.Generator

    Returns
    -------
    tuple of Segment
        The curve from 313 s, and again from 554 s to 635 s in the outage.
    """
    right = 90.0 if rng.random() < 0.5 else -90.0
    back = tuple(s for _ in range(4) for s in (_turn(right, 6.0), Segment(34.0)))
    return (*_run_up(20.0 * KMH, rng), Segment(13.0), *_curve(), *back, *_curve(), Segment(30.0))
