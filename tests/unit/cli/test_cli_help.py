import re
import subprocess
import sys

import pytest
from command_line import COMPILING

VERBS = ("", "inspect", "fuse", "systems", "bench", "reproduce", "report", "simulate", "convert", "sweep")
HEAVY = ("matplotlib", "numpy", "numba", "pyarrow", "msgspec", "pandas", "scipy", "fsspec", "distributed")


@pytest.mark.parametrize("verb", VERBS)
def test_help_imports_nothing_heavy(verb):
    words = [verb, "--help"] if verb else ["--help"]
    script = (
        "import sys; from gapless.cli import gapless\n"
        f"gapless({words!r}, standalone_mode=False)\n"
        f"sys.exit(' '.join(sorted(set({HEAVY!r}) & set(sys.modules))) or 0)"
    )
    done = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True)
    assert (done.returncode, done.stderr) == (0, "")


@pytest.mark.parametrize("verb", VERBS)
def test_help_fits_a_terminal(shell, verb):
    text = shell(*([verb] if verb else []), "--help").output
    assert max(map(len, text.splitlines())) <= 80
    assert "\\" not in text  # click's marks are none of a reader's business


def test_verbs_are_listed_whole_and_in_the_order_of_need(shell):
    listed = shell("--help").output.split("Commands:\n")[1]
    assert re.findall(r"^  (\w+)", listed, re.MULTILINE) == list(VERBS[1:])
    assert "..." not in listed


def test_names_in_the_help_are_those_there_are(shell):
    """Help must not import the registries, so it repeats their names."""
    from gapless.cli.fuse import FORMATS
    from gapless.io import WRITERS
    from gapless.sensors import grade_names
    from gapless.simulate import PROFILES
    from gapless.systems.adjust import ADDED, PARTS
    from gapless.systems.recipe import System

    said = re.sub(r"-\s+", "-", shell("simulate", "--help").output)
    for name in (*PROFILES, *grade_names()):
        assert name in said
    assert {"parquet", *FORMATS} == set(WRITERS)
    said = " ".join(shell("fuse", "--help").output.split())
    assert "gapless systems" in said
    for name in (*System().constraints, *System().sensors, *PARTS, *ADDED):
        assert name in said


def test_version(shell):
    from gapless import __version__

    assert shell("--version").output == f"gapless {__version__}\n"


def test_the_process_does_without_scipy():
    """numba would import scipy.linalg, 0.13 s, for nothing that we use."""
    script = (
        "import sys; from gapless.cli import main\n"
        "try: main()\nexcept SystemExit as end: assert end.code == 2\n"
        "assert 'numba' in sys.modules\nassert sys.modules['scipy'] is None"
    )
    words = [sys.executable, "-c", script, "inspect", "nowhere"]
    done = subprocess.run(words, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    assert done.stderr.removeprefix(COMPILING) == "gapless: nowhere: no such file or folder; check the path\n"
