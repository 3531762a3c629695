"""Run the README's Python again; put what it prints, its picture and the recipe's defaults in place.

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
CONFIGURATION = Path(__file__).parent / "configuration.md"
_CODE = re.compile(r"```python\n(.*?)```", re.DOTALL)
_ROW = re.compile(r"\| `(\w+)` \| `.*?` \|")
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


def with_defaults(page: str) -> str:
    """The configuration page with the defaults of today; its keys and words stay.

    Parameters
    ----------
    page : str

    Returns
    -------
    str
    """
    import msgspec

    from gapless.systems.recipe import System

    lines: list[str] = []
    table = recipe = msgspec.to_builtins(System())
    for line in page.splitlines(keepends=True):
        if line.startswith("## "):
            table = recipe.get(line[3:].strip().strip("[]"), recipe)
        key = _ROW.match(line)
        if key is not None:
            shown = msgspec.json.format(msgspec.json.encode(table[key[1]]), indent=0).decode()
            line = f"| `{key[1]}` | `{shown}` |{line[key.end() :]}"
        lines.append(line)
    return "".join(lines)


def main() -> None:
    """Output, defaults, picture."""
    printed, _ = run()
    text = README.read_text("utf-8")
    README.write_text(_OUTPUT.sub(lambda m: m[1] + printed + m[3], text, count=1), "utf-8")
    print(printed, end="")
    CONFIGURATION.write_text(with_defaults(CONFIGURATION.read_text("utf-8")), "utf-8")

    import make_picture

    make_picture.main()


if __name__ == "__main__":
    main()
