"""A browser for the tests of pages, and pages to test; without one they skip and say why."""

import os
import shutil
import sys
from pathlib import Path

import pytest

sys.path.insert(0, str(Path(__file__).parents[1] / "unit" / "reports"))

import fake_bench
import fake_drive

from gapless.evaluation import score
from gapless.reports import write_report
from gapless.reports.bench import write_bench_report

NAMES = ("chromium", "chromium-browser", "google-chrome", "chrome")
QUIET = (
    *("--no-sandbox", "--disable-gpu", "--disable-quic", "--no-first-run"),
    *("--disable-background-networking", "--disable-component-update", "--disable-sync"),
)


def browser_path():
    """Of GAPLESS_CHROMIUM, or of the first Chromium on the path; None without one."""
    return os.environ.get("GAPLESS_CHROMIUM") or next(filter(None, map(shutil.which, NAMES)), None)


@pytest.fixture(scope="session")
def chromium():
    driver = pytest.importorskip("playwright.sync_api", reason="playwright is not installed: pip install it")
    path = browser_path()
    if path is None:
        pytest.skip("no Chromium: apt-get install chromium, or name one in GAPLESS_CHROMIUM")
    with driver.sync_playwright() as running:
        browser = running.chromium.launch(executable_path=path, args=list(QUIET), headless=True)
        yield browser
        browser.close()


@pytest.fixture(scope="session")
def pages(tmp_path_factory):
    """A fuse page, a bench page, and one of a bench of one recording, by kind."""
    folder = tmp_path_factory.mktemp("pages")
    recording, solution = fake_drive.make()
    write_report(solution, recording, score(solution, recording), folder / "fuse.html")
    bench = fake_bench.make(folder / "bench", lengths=(10, 60), duration=900.0)
    one = fake_bench.make(
        folder / "one", recordings=("kestrel-avenue",), protocols=("passes",), shifts=(0,), duration=900.0
    )
    found = {"bench": write_bench_report(bench), "one": write_bench_report(one)}
    return found | {"fuse": folder / "fuse.html"}


class Visit:
    """An open page, what it asked of the network and what it complained about."""

    def __init__(self, tab, path):
        self.tab, self.asked, self.complaints = tab, [], []
        tab.on("request", lambda r: self.asked.append(r.url))
        tab.on(
            "console", lambda m: self.complaints.append(m.text) if m.type in ("error", "warning") else None
        )
        tab.on("pageerror", lambda e: self.complaints.append(str(e)))
        self.address = path.as_uri()
        tab.set_default_timeout(4000)
        tab.goto(self.address)
        tab.wait_for_function("document.getElementById('embedded').textContent !== ''")
        tab.wait_for_timeout(60)  # a frame or two, for what is drawn in them


@pytest.fixture
def visit(chromium, pages):
    """Open a page: `visit("fuse", width=400, scheme="dark")`; every test ends with a clean console."""
    opened = []

    def go(kind, width=1440, scheme="light"):
        context = chromium.new_context(
            viewport={"width": width, "height": 900}, color_scheme=scheme, has_touch=width < 600
        )
        opened.append((context, Visit(context.new_page(), pages[kind])))
        return opened[-1][1]

    yield go
    for context, one in opened:
        assert one.complaints == []
        assert one.asked == [one.address]  # the page itself, and nothing else
        context.close()
