"""A learner from a file speaks where it fits, and is refused in one line where it does not."""

import numpy as np
import pytest

from gapless.errors import ModelError
from gapless.learners import make
from gapless.learners.saved import dumps
from gapless.measurements.gnss import Position
from gapless.systems.learning import BridgeUse, LearnerUse, bridges


def kept(tmp_path, inputs, outputs):
    rng = np.random.default_rng(0)
    path = tmp_path / "kept.model"
    path.write_bytes(dumps(make("rvfl").fit(rng.normal(size=(50, inputs)), rng.normal(size=(50, outputs)))))
    return LearnerUse(model=str(path))


def test_one_that_fits_is_taken(tmp_path):
    use = BridgeUse(model="error", features=("velocity",))
    (bridge,) = bridges(use, kept(tmp_path, 2, 4), {"position": Position()}, 0.0)
    assert bridge.learned() is not None


@pytest.mark.parametrize(("inputs", "outputs", "segment"), [(2, 2, 1), (3, 4, 1), (8, 4, 2)])
def test_one_that_does_not_fit_is_refused(tmp_path, inputs, outputs, segment):
    """Other inputs, fewer outputs, one epoch instead of two."""
    who = kept(tmp_path, inputs, outputs)
    use = BridgeUse(model="error", features=("velocity",))
    if segment > 1:
        use = BridgeUse(model="error", window=2, segment=segment)
    with pytest.raises(ModelError, match=r"^[^\n]*kept\.model: [^\n]*$"):
        bridges(use, who, {"position": Position()}, 0.0)
