"""The only module that imports numba: how a kernel is compiled and where it is kept.

numba's on-disk cache looks at the file of a kernel, not at the files it imports, so an edit in
`earth.py` would leave a stale kernel behind. The cache folder therefore carries the hash of every
source file that a kernel can reach: change one and all kernels compile again, once.
"""

from __future__ import annotations

import hashlib
import os
import shutil
import sys
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any, TypeVar, cast

import numba
from numba.extending import register_jitable

F = TypeVar("F", bound=Callable[..., Any])

_PACKAGE = Path(__file__).parent
FAST = {"reassoc", "contract", "arcp", "nsz"}
"""Fast-math flags that keep NaN and infinity alive: a kernel must be able to notice them."""


_FILES = ("_numba", "units", "earth", "attitude")
_WITH = ("trip", "filters", "inertial", "sensors", "measurements", "denoise", "bridges", "learners")
_ROOMS = (*(f"{name}.py" for name in _FILES), *_WITH)
"""Modules that hold kernels, and all that those may import (the floors keep it so)."""
_KEPT = 30.0 * 86400.0
"""Kernels of versions that last compiled longer ago are thrown away [s]."""


def _cache_dir() -> Path:
    digest = hashlib.sha256()
    for room in _ROOMS:
        place = _PACKAGE / room
        for path in [place] if place.suffix else sorted(place.rglob("*.py")):
            digest.update(path.read_bytes())
    root = os.environ.get("XDG_CACHE_HOME") or os.path.join(os.path.expanduser("~"), ".cache")
    return Path(root) / "gapless" / f"kernels-{digest.hexdigest()[:16]}"


def _tidy(root: Path) -> None:
    """Throw away the kernels of versions long gone."""
    for old in root.glob("kernels-*"):
        if time.time() - old.stat().st_mtime > _KEPT:
            shutil.rmtree(old, ignore_errors=True)


if "NUMBA_CACHE_DIR" not in os.environ:
    _place = _cache_dir()
    vars(numba.config)["CACHE_DIR"] = str(_place)
    if not _place.is_dir():
        print("gapless: compiling kernels, once per version (about ten seconds)", file=sys.stderr)
        _tidy(_place.parent)


def kernel(function: F) -> F:
    """Compile a function that Python calls; cached on disk, compiled at its first call.

    Parameters
    ----------
    function : callable
        Scalars and arrays in, flat argument list (nested tuples cost microseconds a call).

    Returns
    -------
    callable
        The compiled function; `.py_func` is the plain Python one.
    """
    return cast(F, numba.njit(cache=True, fastmath=FAST, error_model="numpy")(function))


def long_kernel(function: F) -> F:
    """Like `kernel`, for work of milliseconds: meanwhile other threads of Python run.

    Parameters
    ----------
    function : callable

    Returns
    -------
    callable
    """
    return cast(F, numba.njit(cache=True, fastmath=FAST, error_model="numpy", nogil=True)(function))


def inline(function: F) -> F:
    """Let kernels call a plain Python function, which stays one for Python."""
    inlined: F = register_jitable(forceinline=True)(function)
    return inlined
