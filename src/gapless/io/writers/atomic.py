"""Files that are there whole or not at all."""

from __future__ import annotations

import os
import secrets
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path


@contextmanager
def atomic(path: str | os.PathLike[str]) -> Iterator[Path]:
    """Lend a temporary name in the same folder; rename it to `path` if the block ends well.

    Whatever ends the block otherwise, an interrupt included, the temporary file is removed and a
    file that was at `path` stays as it was.

    Parameters
    ----------
    path : str or path
        Its folder is made if it is not there.

    Yields
    ------
    Path
        To be written to and closed within the block.
    """
    path = Path(path)
    path.parent.mkdir(parents=True, exist_ok=True)
    temporary = path.with_name(f".{path.name}.{secrets.token_hex(4)}.part")
    try:
        yield temporary
        os.replace(temporary, path)
    finally:
        temporary.unlink(missing_ok=True)
