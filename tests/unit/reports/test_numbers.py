import json
import math
from dataclasses import dataclass

import numpy as np
import pytest

from gapless.reports.numbers import compact, distance, duration, measured, number, percent, plain


@pytest.mark.parametrize(
    ("value", "text"),
    [
        (12345.6, "12346"),
        (99.96, "100"),
        (-0.01234, "\u22120.0123"),
        (0.0, "0"),
        (-1e-12, "0"),
        (math.nan, "\u2013"),
        (math.inf, "\u2013"),
        (5.0, "5.00"),
    ],
)
def test_numbers(value, text):
    assert number(value) == text


def test_units_do_not_break_off():
    assert number(3.14159, "m/s") == "3.14\u00a0m/s"
    assert compact(0.05, "m") == "0.05\u00a0m"
    assert (compact(0.0), compact(-3.0), compact(1200.0)) == ("0", "\u22123", "1200")


def test_a_measured_value_has_the_digits_that_its_sd_allows():
    assert measured(-0.15234, 0.0121, "s") == "\u22120.152 ± 0.012\u00a0s"
    assert measured(123.456, 4.2) == "123.5 ± 4.2"
    assert measured(123.456, 42.0) == "123 ± 42"
    assert measured(0.25, None) == "0.25"
    assert measured(0.25, math.nan) == "0.25"


def test_durations_distances_shares():
    assert [duration(s) for s in (59.4, 59.6, 867.0, 3725.0)] == [
        "59\u00a0s",
        "1\u00a0min 00\u00a0s",
        "14\u00a0min 27\u00a0s",
        "1\u00a0h 02\u00a0min",
    ]
    assert (distance(812.4), distance(999.6), distance(5021.0)) == (
        "812\u00a0m",
        "1.00\u00a0km",
        "5.02\u00a0km",
    )
    assert (percent(0.954), percent(math.nan)) == ("95.4\u00a0%", "\u2013")


@dataclass
class Pair:
    left: float
    right: np.ndarray


def test_plain_values_are_json_whatever_they_were():
    found = plain(
        {"a": Pair(math.nan, np.array([1.0, np.inf])), "b": (np.int64(3), np.bool_(True), None, "x")}
    )
    assert found == {"a": {"left": None, "right": [1.0, None]}, "b": [3, True, None, "x"]}
    assert json.loads(json.dumps(found, allow_nan=False)) == found
