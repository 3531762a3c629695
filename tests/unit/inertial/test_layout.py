"""Where each error sits."""

import pytest

from gapless.inertial.layout import EXTRAS, LANES, ROW, Layout


def test_core_alone():
    layout = Layout()
    assert (layout.n, layout.width) == (15, 16)
    assert layout.blocks["attitude"] == slice(6, 9)
    assert set(layout.offsets) == {-1}
    assert "axle" not in layout


def test_extras_follow_in_the_order_given():
    layout = Layout(("mounting", "gyro_scale"))
    assert (layout.n, layout.width) == (20, 24)
    assert layout.blocks["mounting"] == slice(15, 17)
    assert layout.blocks["gyro_scale"] == slice(17, 20)
    assert dict(zip(EXTRAS, layout.offsets, strict=True))["gyro_scale"] == 17


def test_everything_fits_a_row():
    layout = Layout(tuple(EXTRAS))
    assert layout.n == 15 + sum(EXTRAS.values())
    assert layout.width % LANES == 0
    assert layout.width <= ROW


@pytest.mark.parametrize("extras", [("flux",), ("axle", "axle")])
def test_unknown_and_repeated_blocks_are_refused(extras):
    with pytest.raises(ValueError, match="choose each once from gyro_scale"):
        Layout(extras)
