"""Run the pages' code again; put what it prints, the picture, recipes and their defaults in place.

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
WALKED = ("tutorial.md", "gallery/*.md")
"""Pages whose code is run."""
CONFIGURATION = Path(__file__).parent / "configuration.md"
_CODE = re.compile(r"```python\n(.*?)```", re.DOTALL)
_RECIPE = re.compile(r"```toml\n.*?```", re.DOTALL)
_ROW = re.compile(r"\| `(\w+)` \| `.*?` \|")
_BLOCK = re.compile(r"```(\w+)\n(.*?)```", re.DOTALL)
_PASSING = re.compile(r"^(wrote .*|\d+ outages scored in .*)\n", re.MULTILINE)
_EACH = re.compile(r"^urban-consumer-\d+, protocol.*?(?=^Prefix law)", re.MULTILINE | re.DOTALL)
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
            exec(compile(code(), str(README), "exec", dont_inherit=True), names)
        finally:
            os.chdir(here)
    return said.getvalue(), names


def walk(page: str) -> str:
    """A page with what its commands and its Python print today.

    Recipes that it shows are saved under their names, commands are run in a folder that is thrown
    away, blocks of Python one after the other, and a block of text takes what was printed before it, but
    for files, seconds and the tables of single drives.

    Parameters
    ----------
    page : str

    Returns
    -------
    str
    """
    from click.testing import CliRunner

    from gapless.cli import gapless

    said, here, wide = "", Path.cwd(), {"COLUMNS": "100"}
    names: dict[str, Any] = {"__name__": "page"}
    parts = _BLOCK.split(page)
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        try:
            for k in range(1, len(parts), 3):
                kind, text = parts[k], parts[k + 1]
                if kind == "toml":
                    name = re.search(r'^name = "(.+)"', text, re.MULTILINE)
                    assert name is not None, "a recipe on such a page has a name"
                    Path(f"{name[1]}.toml").write_text(text, "utf-8")
                elif kind == "sh":
                    words = text.split()[1:]
                    result = CliRunner().invoke(gapless, words, prog_name="gapless", env=wide)
                    assert result.exit_code == 0, result.output
                    told = _EACH.sub("(and a table for each drive)\n\n", _PASSING.sub("", result.output))
                    said = told.strip() + "\n"
                elif kind == "python":
                    with contextlib.redirect_stdout(io.StringIO()) as printed:
                        exec(compile(text, "page", "exec", dont_inherit=True), names)
                    said = printed.getvalue()
                elif kind == "text":
                    parts[k + 1] = said
        finally:
            os.chdir(here)
    body = parts[:1]
    for k in range(1, len(parts), 3):
        body.append(f"```{parts[k]}\n{parts[k + 1]}```{parts[k + 2]}")
    return "".join(body)


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
            table = recipe
            for part in line[3:].strip().strip("[]").split("."):
                table = table.get(part, recipe)
        key = _ROW.match(line)
        if key is not None:
            shown = msgspec.json.format(msgspec.json.encode(table[key[1]]), indent=0).decode()
            line = f"| `{key[1]}` | `{shown}` |{line[key.end() :]}"
        lines.append(line)
    return "".join(lines)


def with_recipe(page: str, name: str) -> str:
    """A paper's page with its recipe as it is today.

    Parameters
    ----------
    page : str
    name : str
        Of the built-in system; without one of that name the page stays as it is.

    Returns
    -------
    str
    """
    from gapless.systems.library import names, source

    return _RECIPE.sub(f"```toml\n{source(name)}```", page, count=1) if name in names() else page


def main() -> None:
    """Output, pages whose code is run, recipes, defaults, picture."""
    printed, _ = run()
    text = README.read_text("utf-8")
    README.write_text(_OUTPUT.sub(lambda m: m[1] + printed + m[3], text, count=1), "utf-8")
    print(printed, end="")
    CONFIGURATION.write_text(with_defaults(CONFIGURATION.read_text("utf-8")), "utf-8")

    for page in (found for pattern in WALKED for found in sorted(CONFIGURATION.parent.glob(pattern))):
        page.write_text(walk(page.read_text("utf-8")), "utf-8")

    for page in sorted(CONFIGURATION.parent.glob("papers/*.md")):
        page.write_text(with_recipe(page.read_text("utf-8"), page.stem), "utf-8")

    import make_picture

    make_picture.main()


if __name__ == "__main__":
    main()
