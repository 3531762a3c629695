"""The operators of a genetic algorithm, on rows of bits (tan2015, section 3.2)."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt

from gapless.trip.recording import Array

Bits: TypeAlias = npt.NDArray[np.uint8]


def binary(gray: Bits) -> Bits:
    """Binary digits of a Gray code, most significant first.

    B_{n-1} = G_{n-1}, B_i = B_{i+1} XOR G_i (eq. 19, corrected).

    Parameters
    ----------
    gray : ndarray of 0 and 1, shape (n,)

    Returns
    -------
    ndarray of 0 and 1, shape (n,)
    """
    return np.bitwise_xor.accumulate(gray)


def decoded(chromosome: Bits, ranges: Mapping[str, tuple[float, float]]) -> dict[str, float]:
    """Parameters that a chromosome stands for.

    Each has an equal share of the bits; code i of 2^n stands for low + (high - low)(i + 1)/2^n, so
    that high can be reached and low, where a parameter would mean nothing, cannot.

    Parameters
    ----------
    chromosome : ndarray of 0 and 1, shape (bits x parameters,)
    ranges : mapping of str to (low, high)

    Returns
    -------
    dict of str to float
    """
    values = {}
    for (name, (low, high)), gray in zip(ranges.items(), np.split(chromosome, len(ranges)), strict=True):
        code = int("".join(map(str, binary(gray))), 2)
        values[name] = low + (high - low) * (code + 1) / 2 ** len(gray)
    return values


def ranked(rms: Array, pressure: float) -> Array:
    """Fitness by linear ranking, 2 - sp + 2 (sp - 1)(pos - 1)/(N - 1), pos 1 the worst (eq. 20).

    Parameters
    ----------
    rms : ndarray, shape (N,)
        Less is better; of equals the later is the better.
    pressure : float
        sp, 1 to 2.

    Returns
    -------
    ndarray, shape (N,)
        Their sum is N.
    """
    fitness = np.empty(len(rms))
    worst_first = np.argsort(-rms, kind="stable")
    fitness[worst_first] = 2.0 - pressure + 2.0 * (pressure - 1.0) * np.arange(len(rms)) / (len(rms) - 1)
    return fitness


def next_generation(
    people: Bits, rms: Array, pressure: float, crossover: float, mutation: float, rng: Any
) -> Bits:
    """Roulette selection (eq. 21), single-point crossover, mutation.

    Parameters
    ----------
    people : ndarray of 0 and 1, shape (N, b)
    rms : ndarray, shape (N,)
    pressure : float
        sp of the ranking.
    crossover : float
        Probability a pair; where N is odd the last has no partner.
    mutation : float
        Probability a bit.
    rng : numpy.random.RandomState

    Returns
    -------
    ndarray of 0 and 1, shape (N, b)
    """
    count, length = people.shape
    children = people[rng.choice(count, count, p=ranked(rms, pressure) / count)]
    for first in range(0, count - 1, 2):
        if length > 1 and rng.uniform() < crossover:
            point = rng.randint(1, length)
            pair = children[first : first + 2, point:]
            pair[:] = pair[::-1].copy()
    flips: Bits = (rng.uniform(size=people.shape) < mutation).astype(np.uint8)
    mutated: Bits = children ^ flips
    return mutated
