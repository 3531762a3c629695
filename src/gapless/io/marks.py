"""The mark that every file of ours carries, so that nothing else is ever written over.

Each format says it where it has room: Parquet in its metadata, JSON and GeoJSON as their first key, HTML
as the page's generator, GPX as its creator, KML, Markdown, LaTeX and TOML in a comment, PNG and PDF among
their attributes, plain text in its last line. CSV has no room: there the header tells. `recording.toml`
is meant to be edited, so its mark knows what was written, and an edited one is the user's.
"""

from __future__ import annotations

import os
import re
import zlib
from collections.abc import Callable, Iterable
from pathlib import Path
from typing import Any, Final

from gapless.errors import ConfigError
from gapless.version import __version__

MARK: Final = f"gapless {__version__}"
"""What a file says of its maker."""
PARQUET_KEY: Final = b"gapless"
"""Where Parquet says it: the version is the value of this key of the schema's metadata."""
_HEAD: Final = 4096
_TAIL: Final = 65536
"""Bytes at either end of a file in which a mark is looked for."""
_SOLUTION: Final = rb"time,lat,lon,height,v_north,v_east,v_down,roll,pitch,heading,sd_north,[a-z_,]+,source"
_SAMPLES: Final = rb"experiment,drive,method,where,start,end"
_MEANS: Final = rb"experiment,where,method,measure,n,mean,low,high"
_AT_HEAD: Final = {
    ".json": rb'\s*\{\s*"gapless":',
    ".geojson": rb'\s*\{\s*"gapless":',
    ".html": rb'(?s:.*)<meta name="generator" content="gapless ',
    ".kml": rb"<\?xml[^>]*\?>\s*<!-- gapless ",
    ".gpx": rb'<\?xml[^>]*\?>\s*<gpx version="1.1" creator="gapless\b',
    ".md": rb"<!-- gapless ",
    ".tex": rb"% gapless ",
    ".csv": rb"(?:%s)[\r\n,]" % b"|".join((_SOLUTION, _SAMPLES, _MEANS)),
    ".png": rb"\x89PNG(?s:.*)tEXtSoftware\0gapless ",
}
_AT_TAIL: Final = {
    ".txt": rb"(?:\A|\n)gapless [^\n]+\n\Z",
    ".pdf": rb"/Creator \(gapless ",
}
_MODEL: Final = rb'(?:PK(?s:.{,100})model\.json)?\{\s*"kind": "gapless (?:learner|wheels)"'
_TOML: Final = re.compile(rb"# gapless \S+ ([0-9a-f]{8})(?: ([0-9a-f]+))?\n", re.ASCII)


def is_ours(path: Path) -> bool:
    """Whether a file carries our mark.

    Parameters
    ----------
    path : Path
        Of a file that is there; its suffix names the format.

    Returns
    -------
    bool
        False for whatever cannot be read.
    """
    kind = path.suffix.lower()
    try:
        if not path.is_file():
            return False
        if kind == ".parquet":
            return _parquet(path)
        if kind == ".toml":
            return _told(path.read_bytes()) is not None
        return _found(path, kind)
    except OSError:
        return False


def marked(table: Any) -> Any:
    """An Arrow table whose Parquet file will carry the mark.

    Parameters
    ----------
    table : pyarrow.Table

    Returns
    -------
    pyarrow.Table
    """
    return table.replace_schema_metadata({**(table.schema.metadata or {}), PARQUET_KEY: __version__})


def is_page(path: Path) -> bool:
    """Whether a file is a page of ours, whatever its name.

    Parameters
    ----------
    path : Path

    Returns
    -------
    bool
    """
    return _found(path, ".html")


def is_model(path: Path) -> bool:
    """Whether a file is what `gapless fuse --save-model` writes.

    Parameters
    ----------
    path : Path

    Returns
    -------
    bool
    """
    try:
        with path.open("rb") as file:
            return re.match(_MODEL, file.read(_HEAD)) is not None
    except OSError:
        return False


def check_ours(
    paths: Iterable[Path], force: bool = False, ours: Callable[[Path], bool] = is_ours, cure: str = "--force"
) -> None:
    """Refuse to write where something is that gapless did not write.

    Parameters
    ----------
    paths : iterable of Path
        That would be written.
    force : bool
        Take files away, whoever wrote them.
    ours : callable
        Tells ours from others'.
    cure : str
        How the user asks for `force`.

    Raises
    ------
    ConfigError
        Names the first that is in the way; a folder always is.
    """
    for path in paths:
        if not os.path.lexists(path):
            continue
        if path.is_dir():
            raise ConfigError(f"{path}: is a folder, and a file of that name would be written; move it away")
        if not force and not ours(path):
            raise ConfigError(
                f"{path}: is there, and gapless did not write it as it is; "
                f"move it away, choose another place, or replace it with {cure}"
            )


def in_toml(text: str, origin: str = "") -> str:
    """A TOML text with a mark above it that holds for this text only.

    Parameters
    ----------
    text : str
    origin : str
        What it was made of, as hexadecimal digits; "" if that is not to be told.

    Returns
    -------
    str
    """
    return f"# {MARK} {zlib.crc32(text.encode()):08x}{' ' * bool(origin)}{origin}\n{text}"


def origin_in(path: Path) -> str | None:
    """What a marked TOML file was made of.

    Parameters
    ----------
    path : Path

    Returns
    -------
    str or None
        None where it is not there, not ours, or edited since.
    """
    try:
        return _told(path.read_bytes())
    except OSError:
        return None


def _told(data: bytes) -> str | None:
    mark = _TOML.match(data)
    if mark is None or int(mark[1], 16) != zlib.crc32(data[mark.end() :]):
        return None
    return (mark[2] or b"").decode()


def _parquet(path: Path) -> bool:
    import pyarrow as pa
    import pyarrow.parquet as pq

    try:
        return PARQUET_KEY in (pq.read_metadata(path).metadata or {})
    except pa.ArrowException:
        return False


def _found(path: Path, kind: str) -> bool:
    with path.open("rb") as file:
        if kind in _AT_HEAD:
            return re.match(_AT_HEAD[kind], file.read(_HEAD)) is not None
        if kind not in _AT_TAIL:
            return False
        file.seek(max(0, path.stat().st_size - _TAIL))
        return re.search(_AT_TAIL[kind], file.read()) is not None
