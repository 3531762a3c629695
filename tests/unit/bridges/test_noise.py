"""How sure a bridge is: as its paper has it, or as its held-out misses show."""

import numpy as np
import pytest
from epochs import drive

from gapless.bridges.error import ErrorModel
from gapless.bridges.noise import CalibratedNoise, FilterNoise, Missed, rehearse

HEARD = {"position": np.diag([4.0, 4.0, 9.0]), "velocity": 0.01 * np.eye(3)}


def test_the_papers_noise_is_that_of_the_last_fix():
    noise = FilterNoise().fitted([])
    assert (noise.of("position", 2, HEARD, 100.0, 50) == 4.0 * np.eye(2)).all()
    assert noise.of("velocity", 3, {}, 1.0, 1) is None


def test_uncalibrated_says_nothing():
    assert CalibratedNoise().of("position", 2, HEARD, 1.0, 1) is None
    few = [Missed(1.0, {"position": np.ones(2)})] * 4
    assert CalibratedNoise().fitted(few).of("position", 2, HEARD, 1.0, 1) is None


def test_growth_is_found_and_covers():
    rng = np.random.default_rng(1)
    ages = np.tile(np.arange(1.0, 61.0), 30)
    sd = np.hypot(2.0, 0.5 * ages)
    missed = [Missed(a, {"position": s * rng.normal(size=2)}) for a, s in zip(ages, sd, strict=True)]
    a, b = CalibratedNoise().fitted(missed).growth["position"]
    # the 95 % quantile of a mean of two squares is 3.0 < 3.84, so no tail is added; 1,800 draws scatter
    # by a few per cent
    assert np.sqrt(b) == pytest.approx(0.5, rel=0.15)
    assert np.sqrt(a) == pytest.approx(2.0, rel=0.4)


@pytest.mark.parametrize("wild", [1.0, 100.0])
def test_noise_grows_with_silence_and_with_every_word(wild):
    rng = np.random.default_rng(2)
    missed = [Missed(a, {"position": wild * rng.normal(size=2)}) for a in np.arange(1.0, 40.0)]
    noise = CalibratedNoise().fitted(missed)
    sizes = [noise.of("position", 2, HEARD, age, k)[0, 0] for k, age in enumerate((1.0, 10.0, 60.0), 1)]
    assert sizes == sorted(sizes)
    assert sizes[0] > 4.0
    for r in (noise.of("position", 2, HEARD, 5.0, 5), noise.of("position", 2, {}, 5.0, 5)):
        assert np.linalg.eigvalsh(r).min() > 0.0


def test_rehearsal_is_what_an_outage_would_be():
    epochs = drive(60)
    model = ErrorModel((), 1, 2, "filter", ("position",), 2)
    missed = rehearse(model, lambda row: row[:, 2:], epochs, 10)  # it stays as it was: off by its growth
    first = next(m for m in missed if m.age == 1.0)
    assert first.wrong["position"] == pytest.approx(
        -(epochs[1].filter_error[:2] - epochs[0].filter_error[:2])
    )
    assert max(m.age for m in missed) == 10.0
