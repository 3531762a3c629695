import numpy as np
import packing
from hypothesis import given
from hypothesis import strategies as st

from gapless.reports.pack import packed, packed_errors, packed_times

FINITE = st.floats(-1e9, 1e9, allow_nan=False)


@given(st.lists(FINITE | st.just(float("nan")), max_size=50))
def test_what_is_unpacked_is_within_half_a_thousandth_of_its_distance_from_the_median(numbers):
    x = np.array(numbers, float)
    found = packing.values(packed(x))
    known = np.isfinite(x)
    np.testing.assert_array_equal(np.isfinite(found), known)
    if known.any():
        away = np.abs(x[known] - np.median(x[known]))
        # Half precision rounds to 2^-11 of a value; near zero its steps are even, 2^-39 of the reach.
        # The scale is a power of two, so nothing else is rounded but the sum itself.
        allowed = 2.0**-11 * away + 2.0**-38 * away.max() + 1e-15 * np.abs(x[known]).max()
        assert (np.abs(found[known] - x[known]) <= allowed).all()


def test_a_small_change_of_a_large_value_survives_an_outlier():
    x = 9.80 + 1e-4 * np.sin(np.linspace(0, 6, 200))
    x[7] = 5e4
    found = packing.values(packed(x))
    away = np.abs(x - np.median(x))
    assert (np.abs(found - x) <= 2.0**-10 * away + 1e-7).all()  # as above: steps of 5e4 * 2^-39
    assert packing.values(packed(np.full(3, np.nan))).tolist() != []


def test_errors_are_halves_and_the_absurd_is_clipped():
    found = packing.halves(packed_errors(np.array([0.0, 1.5, np.nan, 1e9])))
    assert found[:2].tolist() == [0.0, 1.5]
    assert np.isnan(found[2])
    assert np.isfinite(found[3])


def test_times_keep_their_milliseconds():
    t = np.array([0.0, 0.001, 12345.678, 90_000.0])
    np.testing.assert_allclose(packing.times(packed_times(t)), t, rtol=0, atol=5e-4)  # rounded to 1 ms
