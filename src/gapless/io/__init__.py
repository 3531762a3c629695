"""Recordings in, solutions out: formats, what is mended on the way in and what is refused."""

from gapless.io.axes import axes_matrix
from gapless.io.frames import recording_from_frames, to_pandas
from gapless.io.readers import READERS, read
from gapless.io.readers.base import Reader
from gapless.io.writers import WRITERS, Writer, write
from gapless.io.writers.atomic import atomic
from gapless.io.writers.recording import write_recording
from gapless.io.writers.table import solution_columns

__all__ = [
    "READERS",
    "WRITERS",
    "Reader",
    "Writer",
    "atomic",
    "axes_matrix",
    "read",
    "recording_from_frames",
    "solution_columns",
    "to_pandas",
    "write",
    "write_recording",
]
