import pytest
from small_papers import small_paper


@pytest.fixture(scope="session")
def small():
    """A paper of short drives: two methods that exist and one that does not."""
    return small_paper()


@pytest.fixture(scope="session")
def done(small):
    from gapless.papers.experiment import reproduce

    return reproduce(small, processes=1)
