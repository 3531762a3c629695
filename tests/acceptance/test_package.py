"""The package as a user imports it."""

import subprocess
import sys

import pytest

import gapless as gp


def test_public_names_are_there():
    for name in gp.__all__:
        assert getattr(gp, name).__doc__, name
    assert set(gp.__all__) <= set(dir(gp))
    assert gp.__all__ == sorted(gp.__all__, key=lambda name: (name[0].islower(), name))


def test_a_name_that_is_not_there():
    with pytest.raises(AttributeError, match="no attribute 'fusion'"):
        _ = gp.fusion


def test_import_costs_nothing_until_something_is_asked_for():
    script = "import sys, gapless; sys.exit(' '.join(n for n in ('numpy', 'numba') if n in sys.modules) or 0)"
    assert subprocess.run([sys.executable, "-c", script]).returncode == 0


def test_names_mean_the_same_whatever_was_imported_first():
    """`simulate` is a package, so the call has a name of its own."""
    import gapless.simulate
    from gapless.simulate import simulate

    assert gp.simulate_drive is simulate
    assert gp.simulate is gapless.simulate
