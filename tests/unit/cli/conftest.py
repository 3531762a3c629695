import pytest
from command_line import Shell


@pytest.fixture
def shell():
    return Shell()


@pytest.fixture(scope="session")
def drive(tmp_path_factory):
    """A drive of 160 s: long enough to align (37 s) and for an outage."""
    folder = tmp_path_factory.mktemp("recordings") / "drive"
    Shell()("simulate", "--duration", 160, "--mounting", 0, -2, 4, "--out", folder)
    return folder
