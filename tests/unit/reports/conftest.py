import sys
from pathlib import Path

import pytest

sys.path.insert(0, str(Path(__file__).parent))

import fake_bench
import fake_drive

from gapless.evaluation import score


@pytest.fixture(scope="session")
def drive():
    """Recording, solution and scores of 900 s with three outages and a reference."""
    recording, solution = fake_drive.make()
    return recording, solution, score(solution, recording)


@pytest.fixture(scope="session")
def bench_folder(tmp_path_factory):
    """A bench of two recordings, three systems, two lengths and two shifts; two outages are set apart."""
    return fake_bench.make(tmp_path_factory.mktemp("results") / "bench", lengths=(10, 60), duration=900.0)
