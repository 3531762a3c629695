"""The only module that imports numba: how a kernel is compiled and where it is kept.

numba's own cache looks at the file of a kernel, not at the files it imports, so an edit in `earth.py`
would leave a stale kernel behind; it cannot read where it must not write; and a file of it that a crash
or a full disk left short ends the program. Ours is a folder that carries the hash of every source file
that a kernel can reach: change one and all kernels compile again, once. In it is one file a kernel and
signature, with a checksum, written whole or not at all. What is damaged is thrown away and made anew;
where nothing can be kept, kernels are compiled in memory, and that is said.
"""

from __future__ import annotations

import hashlib
import multiprocessing
import os
import pickle
import secrets
import shutil
import stat
import sys
import tempfile
import time
import zlib
from collections.abc import Callable
from contextlib import suppress
from functools import cache
from pathlib import Path
from typing import Any, Final, TypeVar, cast

import numba
from numba.core.caching import CompileResultCacheImpl, FunctionCache
from numba.core.serialize import dumps
from numba.extending import register_jitable

F = TypeVar("F", bound=Callable[..., Any])

_PACKAGE = Path(__file__).parent
FAST = {"reassoc", "contract", "arcp", "nsz"}
"""Fast-math flags that keep NaN and infinity alive: a kernel must be able to notice them."""


_FILES = ("_numba", "units", "earth", "attitude")
_WITH = (
    "trip",
    "filters",
    "inertial",
    "sensors",
    "measurements",
    "denoise",
    "bridges",
    "learners",
    "witnesses",
)
_ROOMS = (*(f"{name}.py" for name in _FILES), *_WITH)
"""Modules that hold kernels, and all that those may import (the floors keep it so)."""
_KEPT = 30.0 * 86400.0
"""Kernels of versions that last compiled longer ago are thrown away [s]."""
_SUM: Final = 8
"""Bytes of a file's checksum: length and CRC-32 of what follows it."""


@cache
def _version() -> str:
    digest = hashlib.sha256(numba.__version__.encode())
    for room in _ROOMS:
        place = _PACKAGE / room
        for path in [place] if place.suffix else sorted(place.rglob("*.py")):
            digest.update(path.read_bytes())
    return f"kernels-{digest.hexdigest()[:16]}"


@cache
def _places() -> tuple[Path, ...]:
    """Folders for kernels, best first: the user's cache, one of the user's own under the temporary folder."""
    named = os.environ.get("NUMBA_CACHE_DIR")
    home = Path(os.environ.get("XDG_CACHE_HOME") or "")
    if not home.is_absolute():
        home = Path(os.path.expanduser("~"), ".cache")
    first = Path(named) if named else home / "gapless"
    own = _temporary()
    found = [first] if first.is_absolute() or named else []
    return tuple(place / _version() for place in (*found, *([own] if own else [])))


def _temporary() -> Path | None:
    """A folder that nobody else can have put kernels into, or None."""
    user = os.getuid() if hasattr(os, "getuid") else 0
    try:
        root = tempfile.gettempdir()
        if root == os.getcwd() and root not in (os.environ.get("TMPDIR"), "/tmp", "/var/tmp", "/usr/tmp"):
            return None  # for want of a better one; the user's work is there
        own = Path(root) / f"gapless-{user}"
        with suppress(FileNotFoundError):
            found = own.lstat()
            private = stat.S_ISDIR(found.st_mode) and (os.name == "nt" or not found.st_mode & 0o022)
            return own if private and found.st_uid == user else None
    except OSError:
        return None
    return own


def _tidy(root: Path) -> None:
    """Throw away the kernels of versions long gone."""
    for old in root.glob("kernels-*"):
        with suppress(OSError):
            if time.time() - old.stat().st_mtime > _KEPT:
                shutil.rmtree(old, ignore_errors=True)


_dumps: Callable[[Any], bytes] = dumps
_said: set[str] = set()


def _say(kind: str, line: str) -> None:
    """One line on stderr, once a kind and not from each worker; nobody need be there to read it."""
    if kind in _said or multiprocessing.parent_process() is not None:
        return
    _said.add(kind)
    with suppress(OSError, ValueError, AttributeError):  # stderr is closed, or gone
        print(f"{chr(13)}\x1b[K" * sys.stderr.isatty() + f"gapless: {line}", file=sys.stderr, flush=True)


class _Cache(FunctionCache):
    """Where a dispatcher looks for a compiled kernel, and leaves one."""

    def __init__(self, function: Callable[..., Any]) -> None:
        self._py_func = function
        self._base = f"{function.__module__.removeprefix('gapless.')}.{function.__qualname__}"
        self._impl = object.__new__(CompileResultCacheImpl)  # its start looks for a place to write to
        self._cache_path = ""
        self._enabled = True

    def flush(self) -> None:
        """Forget nothing: what a file holds is told by its name."""

    def load_overload(self, sig: Any, target_context: Any) -> Any:
        """The kernel for a signature, or None to have it compiled."""
        target_context.refresh()
        name = self._named(sig, target_context.codegen())
        for place in _places():
            try:
                data = (place / name).read_bytes()
            except OSError:
                continue
            with suppress(Exception):  # whatever a damaged or foreign file makes of a library
                if data[:_SUM] == _checksum(data[_SUM:]):
                    return self._impl.rebuild(target_context, pickle.loads(data[_SUM:]))
            with suppress(OSError):
                (place / name).unlink()
            _say("compiling", f"removed damaged kernels in {place}; compiling kernels again")
        _say("compiling", "compiling kernels, once per version (about ten seconds)")
        return None

    def save_overload(self, sig: Any, data: Any) -> None:
        """Keep a compiled kernel where that is possible."""
        if data.library.has_dynamic_globals or any(not one.can_cache for one in data.lifted):
            return
        content = _dumps(self._impl.reduce(data))
        failed = None
        for place in _places():
            try:
                _write(place / self._named(sig, data.codegen), _checksum(content) + content)
            except OSError as error:
                failed = failed or (place, error.strerror or str(error))
                continue
            if failed is not None:
                _say("place", f"kernels cannot be kept in {failed[0]} ({failed[1]}); they are in {place}")
            return
        told = "have no place" if failed is None else f"cannot be kept in {failed[0]} ({failed[1]})"
        _say("place", f"kernels {told}; they are compiled in memory, in each run")

    def _named(self, sig: Any, codegen: Any) -> str:
        key: Any = self._index_key  # numba has no types
        told = hashlib.sha256(repr(key(str(sig), codegen)).encode()).hexdigest()
        return f"{self._base}.{told[:16]}.nbc"


def _checksum(content: bytes) -> bytes:
    return len(content).to_bytes(4, "little") + zlib.crc32(content).to_bytes(4, "little")


def _write(path: Path, content: bytes) -> None:
    if not path.parent.is_dir():
        path.parent.parent.mkdir(mode=0o700, parents=True, exist_ok=True)
        path.parent.mkdir(exist_ok=True)
        _tidy(path.parent.parent)
    temporary = path.with_name(f".{path.name}.{secrets.token_hex(4)}.part")
    try:
        temporary.write_bytes(content)
        os.replace(temporary, path)
    finally:
        temporary.unlink(missing_ok=True)


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
    return cast(F, _kept(numba.njit(fastmath=FAST, error_model="numpy")(function)))


def long_kernel(function: F) -> F:
    """Like `kernel`, for work of milliseconds: meanwhile other threads of Python run.

    Parameters
    ----------
    function : callable

    Returns
    -------
    callable
    """
    return cast(F, _kept(numba.njit(fastmath=FAST, error_model="numpy", nogil=True)(function)))


def inline(function: F) -> F:
    """Let kernels call a plain Python function, which stays one for Python."""
    inlined: F = register_jitable(forceinline=True)(function)
    return inlined


def _kept(dispatcher: Any) -> Any:
    """A dispatcher that keeps what it compiles, unless numba is told not to compile at all."""
    if hasattr(dispatcher, "_cache"):
        dispatcher._cache = _Cache(dispatcher.py_func)
    return dispatcher
