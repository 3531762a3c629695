import sys
from pathlib import Path

import pytest

sys.path.insert(0, str(Path(__file__).parent))

import fake_drive

from gapless.evaluation import score


@pytest.fixture(scope="session")
def drive():
    """Recording, solution and scores of 900 s with three outages and a reference."""
    recording, solution = fake_drive.make()
    return recording, solution, score(solution, recording)
