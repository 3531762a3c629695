"""The only module that imports numba: how a kernel is compiled and where it is kept.

numba's on-disk cache looks at the file of a kernel, not at the files it imports, so an edit in
`earth.py` would leave a stale kernel behind. The cache folder therefore carries the hash of every
source file of the package: change one and all kernels compile again, once.
"""

from __future__ import annotations

import hashlib
import os
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any, TypeVar, cast

import numba
from numba.extending import register_jitable

F = TypeVar("F", bound=Callable[..., Any])

_PACKAGE = Path(__file__).parent
FAST = {"reassoc", "contract", "arcp", "nsz"}
"""Fast-math flags that keep NaN and infinity alive: a kernel must be able to notice them."""


def _cache_dir() -> Path:
    digest = hashlib.sha256()
    for path in sorted(_PACKAGE.rglob("*.py")):
        digest.update(path.read_bytes())
    root = os.environ.get("XDG_CACHE_HOME") or os.path.join(os.path.expanduser("~"), ".cache")
    return Path(root) / "gapless" / f"kernels-{digest.hexdigest()[:16]}"


if "NUMBA_CACHE_DIR" not in os.environ:
    _place = _cache_dir()
    vars(numba.config)["CACHE_DIR"] = str(_place)
    if not _place.is_dir():
        print("gapless: compiling kernels, once per version (about ten seconds)", file=sys.stderr)


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


def inline(function: F) -> F:
    """Let kernels call a plain Python function, which stays one for Python."""
    inlined: F = register_jitable(forceinline=True)(function)
    return inlined
