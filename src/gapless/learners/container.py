"""A text and arrays in one zip file, read without trust."""

from __future__ import annotations

import io
import math
import zipfile
from typing import Final

import numpy as np
from numpy.lib import format as npy

from gapless.errors import ModelError
from gapless.trip.recording import Array

_TEXT: Final = "model.json"
_STAMP: Final = (1980, 1, 1, 0, 0, 0)
_KINDS: Final = "biufU"


def join(text: str, arrays: list[Array]) -> bytes:
    """A text and arrays as a file that `numpy.load` can open too.

    Parameters
    ----------
    text : str
    arrays : list of ndarray
        Of numbers or text.

    Returns
    -------
    bytes
        The same for the same contents.
    """
    whole = io.BytesIO()
    with zipfile.ZipFile(whole, "w") as archive:
        archive.writestr(zipfile.ZipInfo(_TEXT, _STAMP), text)
        for i, array in enumerate(arrays):
            entry = io.BytesIO()
            npy.write_array(entry, array, version=(1, 0), allow_pickle=False)
            archive.writestr(zipfile.ZipInfo(f"{i}.npy", _STAMP), entry.getvalue())
    return whole.getvalue()


def part(data: bytes, where: str) -> tuple[str, list[Array]]:
    """The text and the arrays of a file.

    Entries are stored as they are: a compressed one might be a bomb. Sizes that an array claims are
    compared with what is there before memory is asked for.

    Parameters
    ----------
    data : bytes
    where : str
        What to call the file in an error.

    Returns
    -------
    text : str
    arrays : list of ndarray

    Raises
    ------
    ModelError
        If it is not such a file, or damaged.
    """
    try:
        with zipfile.ZipFile(io.BytesIO(data)) as archive:
            entries = archive.infolist()
            if any(entry.compress_type != zipfile.ZIP_STORED for entry in entries):
                raise ValueError("it is compressed")
            text = archive.read(_TEXT).decode("utf-8")
            arrays = [_array(archive.read(f"{i}.npy")) for i in range(len(entries) - 1)]
    except Exception as error:  # zipfile says what it pleases of a damaged file
        raise ModelError(
            f"{where}: not a saved learner, or damaged ({error!s:.80}); save it again with gapless"
        ) from None
    return text, arrays


def _array(data: bytes) -> Array:
    stream = io.BytesIO(data)
    if npy.read_magic(stream) != (1, 0):
        raise ValueError("an array of another format")
    shape, fortran, dtype = npy.read_array_header_1_0(stream)
    count = math.prod(shape)
    begin = stream.tell()
    if dtype.kind not in _KINDS or min(shape, default=0) < 0 or count * dtype.itemsize != len(data) - begin:
        raise ValueError("an array that is not what it says")
    if count == 0:
        return np.zeros(shape, dtype)
    flat = np.frombuffer(data, dtype, offset=begin)
    return flat.reshape(shape, order="F" if fortran else "C").copy(order="K")
