import numpy as np
import pytest

from gapless.errors import ConfigError
from gapless.sensors import grade, grade_names, parse_grade

GOOD = {"source": "a datasheet", "rate": "100 Hz"}


def test_every_grade_has_a_source_and_a_rate():
    assert {"perfect", "consumer", "liu2019", "span-cpt", "wang2018", "tactical", "navigation"} <= set(
        grade_names()
    )
    for name in grade_names():
        assert grade(name).name == name
        assert len(grade(name).source) > 10
        assert grade(name).rate >= 50.0


def test_units_become_si():
    wang, liu, span, nav = (grade(n) for n in ("wang2018", "liu2019", "span-cpt", "navigation"))
    assert wang.gyro_bias_sd == pytest.approx(9.696e-8, rel=1e-3)  # 0.02 deg/h
    assert wang.gyro_noise == pytest.approx(np.radians(0.02) / 60.0)
    assert wang.accel_bias_sd == pytest.approx(9.80665e-4)
    assert liu.gyro_noise == pytest.approx(np.radians(0.005))
    assert liu.accel_noise == pytest.approx(110e-6 * 9.80665)
    assert span.accel_bias_sd == pytest.approx(0.4903325)
    assert nav.gyro_scale_sd == pytest.approx(5e-6)


def test_consumer_biases_are_those_of_cheap_parts():
    cheap = grade("consumer")
    assert 2.0 * cheap.accel_bias_sd == pytest.approx(0.5, rel=0.05)
    assert 2.0 * np.degrees(cheap.gyro_bias_sd) == pytest.approx(0.3, rel=0.05)


def test_grades_get_better():
    order = [grade(n) for n in ("consumer", "liu2019", "tactical", "navigation", "perfect")]
    for field in ("gyro_noise", "gyro_bias_sd", "accel_bias_sd"):
        values = [getattr(g, field) for g in order]
        assert values == sorted(values, reverse=True)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"gyro_noise": "0.3 deg/fortnight"}, "deg/sqrt"),
        ({"gyro_noise": "many deg/sqrt(h)"}, "cannot read"),
        ({"gyro_noise": "0.3"}, "write a number and one of"),
        ({"gyro_bias_sd": "-1 deg/h"}, "out of range"),
        ({"gyro_bias_sd": "nan deg/h"}, "out of range"),
        ({"gyro_nois": "1 deg/h"}, "no such field"),
    ],
)
def test_a_bad_grade_says_what_is_wrong(change, message):
    with pytest.raises(ConfigError, match=message):
        parse_grade("mine", GOOD | change)


def test_a_grade_needs_its_source():
    with pytest.raises(ConfigError, match="source and rate missing"):
        parse_grade("mine", {"gyro_noise": "1 deg/sqrt(h)"})


def test_unknown_grade_names_the_known_ones():
    with pytest.raises(ConfigError, match=r"no sensor grade 'golden'.*consumer"):
        grade("golden")
