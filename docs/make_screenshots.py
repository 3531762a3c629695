r"""Screenshots of the pages in docs/images, of a simulated drive.

python docs/make_screenshots.py [BENCH]

BENCH is the folder of a bench; otherwise the made-up one of the tests stands in for it. Those committed:

gapless bench --simulated urban --runs 2 --duration 1200 --systems ins,constraints --length 10,60 \
    --shifts 0,60 --protocol both --out BENCH
"""

from __future__ import annotations

import os
import shutil
import sys
import tempfile
from pathlib import Path

import gapless as gp
from gapless.reports import write_report
from gapless.reports.bench import write_bench_report

HERE = Path(__file__).parent
QUIET = (
    *("--no-sandbox", "--disable-gpu", "--disable-quic", "--no-first-run"),
    *("--disable-background-networking", "--disable-component-update", "--disable-sync"),
)
OPEN_OUTAGE = """() => { document.querySelector('#cards .head').click();
    document.getElementById('outages').scrollIntoView(); }"""
NUMBERED = """() => { document.querySelectorAll('[data-from]')[1].click();
    document.getElementById('track').scrollIntoView({ behavior: 'instant' }); }"""
SHOTS = (
    ("fuse-1440", "fuse", 1440, 1300, "light", NUMBERED),
    ("fuse-400", "fuse", 400, 800, "dark", "scrollTo(0, 0)"),
    ("leaderboard-1440", "bench", 1440, 1000, "light", "scrollTo(0, 0)"),
    ("bench-1440", "bench", 1440, 1000, "light", OPEN_OUTAGE),
    ("bench-dark-1440", "bench", 1440, 1000, "dark", OPEN_OUTAGE),
    ("bench-400", "bench", 400, 800, "light", "document.getElementById('board').scrollIntoView()"),
)
"""Name, page, width, height, colours, and what is done before the picture is taken."""


def fuse_page(path: Path) -> None:
    """The drive of the README."""
    drive = gp.simulate_drive("urban", "consumer", duration=800, seed=1)
    solution = gp.fuse(drive, outages=gp.plan(["every=180,length=60,first=240"], drive.duration))
    write_report(solution, drive, gp.score(solution, drive), path)


def bench_page(folder: Path) -> Path:
    """Of the folder that was given, or of the made-up one."""
    if len(sys.argv) > 1:
        return write_bench_report(Path(sys.argv[1]))
    sys.path.insert(0, str(HERE.parent / "tests" / "unit" / "reports"))
    import fake_bench

    return write_bench_report(fake_bench.make(folder / "bench"))


def take(pages: dict[str, Path]) -> None:
    """All pictures, in as few bytes as their colours allow."""
    from playwright.sync_api import sync_playwright

    found = os.environ.get("GAPLESS_CHROMIUM") or shutil.which("chromium")
    with sync_playwright() as running:
        browser = running.chromium.launch(executable_path=found, args=list(QUIET), headless=True)
        for name, kind, width, height, scheme, act in SHOTS:
            tab = browser.new_page(viewport={"width": width, "height": height}, color_scheme=scheme)
            tab.goto(pages[kind].as_uri())
            tab.evaluate(act)
            tab.wait_for_timeout(900)
            tab.screenshot(path=HERE / "images" / f"{name}.png")
            tab.close()
        browser.close()


def main() -> None:
    """Pages into a folder that is thrown away, pictures into docs/images."""
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        fuse_page(folder / "report.html")
        take({"fuse": folder / "report.html", "bench": bench_page(folder)})


if __name__ == "__main__":
    main()
