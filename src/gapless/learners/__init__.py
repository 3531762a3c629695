"""Learners of the papers, as scikit-learn estimators; one method a file.

`make` builds one by name and `LEARNERS` holds the names; `saved` keeps a fitted one in a file that
runs nothing when it is read. Everything here needs the extra `learn`.
"""

from gapless.learners.registry import LEARNERS, Regressor, make

__all__ = ["LEARNERS", "Regressor", "make"]
