"""What a learner is shown, and what is made of its answers."""

import numpy as np
import pytest
from made_up import ORIGIN, drive

from gapless import earth
from gapless.bridges.epochs import FEATURES, features
from gapless.bridges.error import ErrorModel
from gapless.bridges.increment import IncrementModel
from gapless.inertial.belief import Belief
from gapless.inertial.coast import STATE
from gapless.inertial.layout import Layout
from gapless.measurements.gnss import Position


def believing(x):
    belief = Belief(Layout(()))
    belief.x[:STATE] = x
    return belief


def test_every_feature_is_finite_and_named_once():
    epoch = drive(5)[-1]
    sizes = {name: len(f(epoch)) for name, f in FEATURES.items()}
    row = features(list(FEATURES), epoch)
    assert np.isfinite(row).all()
    assert len(row) == sum(sizes.values())


def test_rows_of_an_error_model_hold_nothing_of_the_epoch_that_they_ask_for():
    epochs = drive(40)
    model = ErrorModel(("velocity", "position"), 3, 4, "gnss", ("position", "velocity"), 2)
    x, y = model.pairs(epochs)
    assert x.shape == (40 - 4, 3 * 4 + 4 * 4)
    assert y.shape == (40 - 4, 4)
    other = [*epochs[:-1], epochs[-1]._replace(gnss_error=epochs[-1].gnss_error + 5.0)]
    spoilt, targets = model.pairs(other)
    assert (spoilt == x).all()
    assert (targets[-1] == y[-1] + 5.0).all()


def test_no_window_reaches_over_a_new_start_of_the_shadow_or_a_gap():
    epochs = drive(40, segment_every=20)
    model = ErrorModel(("velocity",), 1, 5, "gnss", ("position",), 2)
    x, _ = model.pairs(
        epochs
    )  # before the first epoch nothing is known, before the second start no error was
    assert len(x) == (20 - 5) + 20
    assert (x[20 - 5][2:] == 0.0).all()
    epochs[10] = epochs[10]._replace(dt=np.nan)
    assert len(model.pairs(epochs)[0]) == (10 - 5) + (10 - 5) + 20


def test_a_segment_is_learned_and_gone_through_as_a_whole():
    """Three errors at a time, from the last two; the row after a segment holds what it predicted last."""
    epochs = drive(30)
    model = ErrorModel((), 1, 2, "gnss", ("position",), 2, segment=3)
    x, y = model.pairs(epochs)
    assert model.outputs == y.shape[1] == 6
    assert len(x) == 30 - 2 - 2
    assert y[4] == pytest.approx(np.concatenate([e.gnss_error[:2] for e in epochs[6:9]]))
    course, told = model.begin(epochs, epochs[-1].fix), np.arange(6.0)
    for k in range(3):
        course = model.carry(course, epochs[-1], told if k == 0 else np.full(6, np.nan))
        assert course.error == pytest.approx([2.0 * k, 2.0 * k + 1.0])
    assert model.row(course, epochs[-1]) == pytest.approx([2.0, 3.0, 4.0, 5.0])
    assert model.carry(course, epochs[-1], told + 10.0).error == pytest.approx([10.0, 11.0])


def test_no_segment_reaches_over_a_gap():
    epochs = drive(30)
    epochs[10] = epochs[10]._replace(dt=np.nan)
    x, _ = ErrorModel((), 1, 2, "gnss", ("position",), 2, segment=3).pairs(epochs)
    assert len(x) == (10 - 2 - 2) + (20 - 2 - 2)


def test_epochs_without_an_error_are_left_out():
    epochs = drive(20)
    epochs[7] = epochs[7]._replace(gnss_error=np.full(6, np.nan))
    assert len(ErrorModel(("velocity",), 1, 0, "gnss", ("position",), 2).pairs(epochs)[0]) == 19


@pytest.mark.parametrize("axes", [2, 3])
def test_a_perfect_answer_puts_the_filter_right(axes):
    """The observation is truth less filter, whatever shadow and filter are."""
    epochs = drive(30)
    model = ErrorModel(("position",), 1, 0, "filter", ("position", "velocity", "attitude"), axes)
    epoch = epochs[-1]
    truth = epoch.shadow.copy()
    truth[:3], truth[3:6] = epoch.fix, epoch.v_n
    off = np.array([3.0, -2.0, 1.0])
    x = truth.copy()
    x[:3] = earth.ned_to_lla(-off, truth[:3])
    x[3:6] -= 0.5
    course = model.begin(epochs[:-1], epochs[-2].fix)
    course = model.carry(course, epoch, model.pairs(epochs)[1][-1])
    said = {part.name: part for part in model.say(course, believing(x), epoch)}
    # tangent planes over the 90 m of the shadow's error: below 0.002 m
    assert said["position"].z == pytest.approx(off[:axes], abs=5e-3)
    assert said["velocity"].z == pytest.approx(np.full(axes, 0.5), abs=1e-9)
    assert said["attitude"].z == pytest.approx(np.zeros(3), abs=1e-9)
    assert (said["velocity"].H[:, 3 : 3 + axes] == np.eye(axes)).all()
    assert (said["velocity"].H[:, :3] == 0.0).all()
    assert model.wrong(course, epoch)["position"] == pytest.approx(np.zeros(axes), abs=1e-12)


def test_predictions_feed_the_next_row():
    epochs = drive(30)
    model = ErrorModel((), 1, 2, "gnss", ("position",), 2)
    course = model.begin(epochs, epochs[-1].fix)
    assert model.row(course, epochs[-1]) == pytest.approx(
        np.concatenate([e.gnss_error[:2] for e in epochs[-2:]])
    )
    course = model.carry(course, epochs[-1], np.array([7.0, 8.0]))
    assert model.row(course, epochs[-1])[2:] == pytest.approx([7.0, 8.0])


def test_increments_add_up_to_where_gnss_went():
    epochs = drive(50)
    model = IncrementModel(("ins_velocity", "force", "rate"), 2, Position())
    x, y = model.pairs(epochs)
    assert x.shape == (49, 9)
    course = model.begin(epochs[:1], epochs[0].fix)
    for epoch, way in zip(epochs[1:], y, strict=True):
        course = model.carry(course, epoch, way)
    # each step in the tangent plane of its own start: 500 m over a sphere of 6.4e6 m turn by 8e-5 rad
    assert np.abs(model.wrong(course, epochs[-1])["position"]).max() < 0.05
    (part,) = model.say(
        course, believing(np.concatenate([epochs[-1].fix, np.zeros(3), [1, 0, 0, 0]])), epochs[-1]
    )
    assert part.name == "position"
    assert np.abs(part.z).max() < 0.05
    assert part.H.shape == (2, 15)


def test_an_increment_over_a_gap_is_not_learned():
    epochs = drive(20)
    epochs[9] = epochs[9]._replace(dt=np.nan)
    assert len(IncrementModel(("force",), 2, Position()).pairs(epochs)[0]) == 18
    assert (epochs[0].fix != ORIGIN).any()


@pytest.mark.parametrize(
    "model",
    [
        ErrorModel(("velocity",), 1, 0, "gnss", ("position",), 2),
        IncrementModel(("velocity",), 2, Position(np.zeros(3))),
    ],
)
def test_nothing_to_learn_from_is_no_rows(model):
    """An outage may begin before a calibration has anything older to train on."""
    assert [len(part) for part in model.pairs([])] == [0, 0]
