"""Parts that take turns in the columns are learned apart."""

import numpy as np
import pytest
from sklearn.linear_model import LinearRegression

from gapless.learners import make
from gapless.learners.by_part import ByPart, by_part


def series(seed=0, n=80):
    rng = np.random.default_rng(seed)
    return rng.normal(size=(n, 8)), rng.normal(size=(n, 4))


def test_each_part_is_the_regressor_of_its_own_columns():
    x, y = series()
    found = ByPart(LinearRegression()).fit(x, y).predict(x)
    for own in ([0, 1], [2, 3]):
        shown = x[:, [own[0], own[1], own[0] + 4, own[1] + 4]]
        # a least-squares solution of 80 rows: rounding alone
        assert found[:, own] == pytest.approx(
            LinearRegression().fit(shown, y[:, own]).predict(shown), abs=1e-12
        )


def test_what_happens_to_one_part_is_nothing_to_the_other():
    x, y = series()
    model = make("by_part", seed=3).fit(x, y)
    other = x.copy()
    other[:, [2, 3, 6, 7]] += 1.0
    assert np.array_equal(model.predict(other)[:, :2], model.predict(x)[:, :2])
    assert not np.array_equal(model.predict(other)[:, 2:], model.predict(x)[:, 2:])


def test_a_part_without_inputs_is_refused():
    x, y = series()
    with pytest.raises(ValueError, match=r"^X has 2 columns, none of part 2[^\n]*$"):
        by_part().fit(x[:, :2], y)
