"""The papers by name."""

from __future__ import annotations

from importlib import import_module
from typing import Final

from gapless.errors import ConfigError
from gapless.papers.model import Paper

PAPERS: Final = ("wang2018", "liu2019", "georges2015", "aslinezhad2020", "tan2015")
"""Names, which are those of their recipes and modules."""


def paper(name: str) -> Paper:
    """A paper's experiments.

    Parameters
    ----------
    name : str
        One of `PAPERS`.

    Returns
    -------
    Paper

    Raises
    ------
    ConfigError
        If there is none of that name.
    """
    if name not in PAPERS:
        raise ConfigError(f"no paper {name!r}; the papers are {', '.join(PAPERS)}")
    found: Paper = import_module(f"gapless.papers.{name}").PAPER
    return found
