"""Learners of the papers, as scikit-learn estimators; one method a file.

`make` builds one by name and `LEARNERS` holds the names; `saved` keeps a fitted one in a file that
runs nothing when it is read; `nar` goes on with a series. All need the extra `learn`, which is
imported when the first is made.
"""

import sys

from gapless.learners.registry import LEARNERS, Regressor, make

__all__ = ["LEARNERS", "Regressor", "make"]

if sys.modules.get("scipy", sys) is None:  # the process `gapless` hides it from numba; a learner needs it
    del sys.modules["scipy"]
