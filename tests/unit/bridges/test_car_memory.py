"""A car's wheels in a file: the same memory comes back, and nothing else gets in."""

import json

import numpy as np
import pytest

from gapless.bridges.comb import Memory
from gapless.bridges.orders import BINS, Spectrum
from gapless.bridges.vehicle import TRUST, recalled, written
from gapless.bridges.wheels import Wheels
from gapless.errors import ConfigError


@pytest.fixture
def memory():
    rng, found = np.random.default_rng(1), Memory.empty(47.0)
    for _ in range(200):
        found = found.after(Spectrum(rng.standard_normal((6, BINS)), 40.0, rng.uniform(4.0, 20.0), -2.0))
    return found


def test_a_memory_comes_back_with_the_same_comb_but_less_weight(memory, tmp_path):
    path = tmp_path / "car.json"
    path.write_bytes(written(memory))
    back = recalled(str(path))
    assert back.windows == pytest.approx(TRUST)
    share = TRUST / memory.windows
    for name in ("total", "count", "square", "mean", "speeds", "levels"):
        # two roundings
        np.testing.assert_allclose(getattr(back, name), share * getattr(memory, name), rtol=1e-15)
    assert written(memory) == written(memory)
    assert Wheels({}, vehicle=str(path)).memory.windows == back.windows


@pytest.mark.parametrize(
    ("spoil", "says"),
    [
        (lambda held: held.pop("total"), "total"),
        (lambda held: held.update(kind="other"), "another kind"),
        (lambda held: held.update(version=1), "version 1"),
        (lambda held: held.update(speeds=[1.0, 2.0]), "speeds of shape"),
        (lambda held: held.update(windows=float("nan")), "windows is not finite"),
        (lambda held: held.update(windows=-1.0), "windows is negative"),
        (lambda held: held.update(mean="a"), "mean|could not convert"),
        (lambda held: held.update(levels=[[-1.0, 0.0, 0.0]] * 3), "levels hold a negative"),
    ],
)
def test_anything_else_is_refused_in_one_line(memory, tmp_path, spoil, says):
    held = json.loads(written(memory))
    spoil(held)
    path = tmp_path / "car.json"
    path.write_text(json.dumps(held))
    with pytest.raises(ConfigError, match=says) as caught:
        recalled(str(path))
    assert "\n" not in str(caught.value)
    assert "car.json" in str(caught.value)


@pytest.mark.parametrize("data", [b"", b"{", b"\xff\xfe", b"[1, 2]", b"[" * 100_000])
def test_a_truncated_or_foreign_file_is_refused(tmp_path, data):
    path = tmp_path / "car.json"
    path.write_bytes(data)
    with pytest.raises(ConfigError, match="no car's wheels"):
        recalled(str(path))
    with pytest.raises(ConfigError, match="No such file"):
        recalled(str(tmp_path / "nothing.json"))


@pytest.mark.parametrize(
    "wrong",
    [
        {"temper": "a"},
        {"floor": -1.0},
        {"deaf": 1.0},
        {"widest": float("nan")},
        {"least": True},
        {"vehicle": 5},
    ],
)
def test_wrong_parameters_are_refused_by_name(wrong):
    with pytest.raises(ConfigError, match=f"bridge.parameters: {next(iter(wrong))} is .*give"):
        Wheels({}, **wrong)
