"""Run the README's Python again, and put what it prints, and its picture, in their places.

python docs/refresh.py
"""

from __future__ import annotations

import contextlib
import io
import os
import re
import tempfile
from pathlib import Path
from typing import Any

README = Path(__file__).parents[1] / "README.md"
_CODE = re.compile(r"```python\n(.*?)```", re.DOTALL)
_OUTPUT = re.compile(r"(```text\n)(.*?)(```)", re.DOTALL)


def code() -> str:
    """The README's Python.

    Returns
    -------
    str
    """
    found = _CODE.search(README.read_text("utf-8"))
    assert found is not None, "the README has a block of Python"
    return found[1]


def output() -> str:
    """What the README says that it prints.

    Returns
    -------
    str
    """
    found = _OUTPUT.search(README.read_text("utf-8"))
    assert found is not None, "the README has a block of text"
    return found[2]


def run() -> tuple[str, dict[str, Any]]:
    """Run the README's Python in a folder that is thrown away.

    Returns
    -------
    printed : str
    names : dict
        What the code left behind.
    """
    names: dict[str, Any] = {}
    here = Path.cwd()
    with tempfile.TemporaryDirectory() as folder, contextlib.redirect_stdout(io.StringIO()) as said:
        os.chdir(folder)
        try:
            exec(compile(code(), str(README), "exec"), names)
        finally:
            os.chdir(here)
    return said.getvalue(), names


def main() -> None:
    """Output first, then the picture."""
    printed, _ = run()
    text = README.read_text("utf-8")
    README.write_text(_OUTPUT.sub(lambda m: m[1] + printed + m[3], text, count=1), "utf-8")
    print(printed, end="")

    import make_picture

    make_picture.main()


if __name__ == "__main__":
    main()
