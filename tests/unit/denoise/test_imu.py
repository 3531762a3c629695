"""Six channels of a log with silences, in threads; and the table of liu2019."""

from dataclasses import dataclass, replace

import numpy as np
import pytest

from gapless.denoise import Emd, EmdCiit, LowPass, Windowed, denoised
from gapless.denoise.compare import CHANNELS, compare, whole_and_causal
from gapless.denoise.imu import stretches
from gapless.errors import RecordingError
from gapless.simulate import simulate
from gapless.trip.recording import Imu


@pytest.fixture(scope="module")
def log():
    """30 s: 0.6 s missing after 12 s, 0.3 s after 20 s, and again before the last 15 samples."""
    imu = simulate("urban", "liu2019", 30.0, 2, rate=100.0).imu
    silences = ((12.3, 0.3), (20.15, 0.15), (29.3, 0.55))
    out = np.any([np.abs(imu.time - middle) < half for middle, half in silences], axis=0)
    return imu.take(~out)


def channels(imu):
    return np.hstack([imu.dtheta, imu.dvel]).T / imu.dt


@pytest.mark.parametrize("denoiser", [EmdCiit(), Windowed(EmdCiit(), 256, 64)], ids=["whole", "causal"])
def test_stretches_between_silences_are_records_of_their_own(log, denoiser):
    out = denoised(log, denoiser)
    cuts = stretches(log.time)
    assert len(cuts) == 3
    for x, y in zip(channels(log), channels(out), strict=True):
        for s in cuts:
            # multiplied by the interval and divided again: one rounding each way
            assert y[s] == pytest.approx(denoiser(x[s], 100.0), rel=1e-14, abs=0.0)
    assert np.array_equal(out.time, log.time)
    assert np.array_equal(out.dt, log.dt)


def test_a_short_stretch_is_left_as_it_is(log):
    last = stretches(log.time)[-1]
    assert 0 < last.stop - last.start < 32
    out = denoised(log, EmdCiit())
    assert channels(out)[:, last] == pytest.approx(channels(log)[:, last], rel=1e-14, abs=0.0)


def test_rates_are_denoised_and_not_increments():
    """Every other interval twice as long: the rates are smooth, the increments are not.

    A filter that takes the samples for evenly spaced moves each by a third of an interval, 0.005 rad/s of
    these rates; of filtered increments the rates would be off by a third.
    """
    dt = np.tile([0.01, 0.02], 400)
    time = np.cumsum(dt)
    rate = np.sin(time)[:, None] + np.zeros((1, 3))
    imu = Imu.from_rates(time, rate, rate, dt)
    out = denoised(imu, LowPass())
    assert out.dtheta / dt[:, None] == pytest.approx(rate, abs=0.01)


def test_threads_change_nothing(log, monkeypatch):
    many = denoised(log, EmdCiit())
    monkeypatch.setattr("os.cpu_count", lambda: 1)
    one = denoised(log, EmdCiit())
    assert np.array_equal(many.dtheta, one.dtheta)
    assert np.array_equal(many.dvel, one.dvel)


def test_the_prefix_law_across_silences(log):
    """Cut anywhere, also in a short stretch, which nobody knows to be one before it ends."""
    denoiser = Windowed(EmdCiit(), 256, 64)
    whole = denoised(log, denoiser)
    for cut in (1, 20, 300, 1200, 1215, 1600, len(log) - 3):
        part = denoised(log.take(slice(0, cut)), denoiser)
        assert np.array_equal(part.dtheta, whole.dtheta[:cut])
        assert np.array_equal(part.dvel, whole.dvel[:cut])


def test_an_empty_log_stays_empty(log):
    assert len(denoised(log.take(slice(0, 0)), Emd())) == 0


def test_a_value_that_is_not_finite_is_refused(log):
    dvel = log.dvel.copy()
    dvel[700, 1] = np.nan
    with pytest.raises(RecordingError, match="sample 700 is nan"):
        denoised(replace(log, dvel=dvel), Emd())


@dataclass(frozen=True)
class Truth:
    """A denoiser that knows: for channels in the order in which it is asked for them."""

    name = "truth"
    text = "truth"

    def __call__(self, x, rate):
        return np.round(x)


def test_the_table_has_its_rows_and_its_order():
    """Forces first. Errors of a tenth on forces that alternate by one, of a hundredth on rates."""
    sign = np.where(np.arange(400) % 2, 1.0, -1.0)[:, None] * np.ones(3)
    time = np.arange(1, 401) / 100.0
    signal = Imu.from_rates(time, sign, sign)
    measured = Imu.from_rates(time, 1.01 * sign, 1.1 * sign)
    raw, known = compare(signal, measured, {"known": Truth()})
    assert len(CHANNELS) == 6
    assert raw.name == "raw"
    assert raw.snr == pytest.approx([20.0] * 3 + [40.0] * 3, abs=1e-6)
    assert known.text == "truth"
    assert min(known.snr) > 200.0
    assert known.gain(raw) > 180.0


def test_the_table_has_every_denoiser_whole_and_causal():
    each = whole_and_causal()
    assert list(each)[:4] == ["wavelet", "wavelet, causal", "emd", "emd, causal"]
    assert list(each)[-1] == "emd-ciit, causal"
    assert each["emd-ciit, causal"].text == "emd-ciit, causal window of 512 samples"
