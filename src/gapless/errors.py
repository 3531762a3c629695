"""Everything gapless raises on purpose: one line that says what, where and what next."""

from __future__ import annotations

import multiprocessing


class GaplessError(Exception):
    """Base of every error that a user can mend; the command line prints it as one line."""


class RecordingError(GaplessError):
    """A recording or a log cannot be read as it stands."""


class ConfigError(GaplessError):
    """A configuration key is unknown or a value is out of range."""


class ModelError(GaplessError):
    """A learner cannot be saved, or a saved one is damaged, foreign or does not fit."""


class AlignmentError(GaplessError):
    """The data never allowed an initial position, velocity or attitude."""


class LaboratoryError(GaplessError):
    """A system cannot be scored: it reads the future."""


class SweepError(GaplessError):
    """The workers of a sweep cannot go on; what is stored stays, and the same sweep goes on from there."""


class MissingExtraError(GaplessError):
    """An optional dependency is not installed.

    Parameters
    ----------
    package : str
        The distribution that is missing.
    extra : str
        The extra of gapless that brings it.
    """

    def __init__(self, package: str, extra: str) -> None:
        super().__init__(f"{package} is not installed; run: pip install 'gapless[{extra}]'")


def registered_elsewhere() -> str:
    """What to add where a name is in no registry: registries are each process's own.

    Returns
    -------
    str
        Empty but in a worker process.
    """
    if multiprocessing.parent_process() is None:
        return ""
    return (
        "; one of your own must be registered at the top of your script, outside of "
        'if __name__ == "__main__", for each worker process has its own names'
    )
