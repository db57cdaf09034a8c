"""A real browser: Debian's chromium, driven by playwright. Where either is missing, tests are skipped."""

import importlib.util
import os
import shutil
import sys
from dataclasses import dataclass, field
from pathlib import Path

import pytest

from twin.report import write_report

NAMES = ("chromium", "chromium-browser", "google-chrome", "google-chrome-stable")
FLAGS = ("--no-sandbox", "--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader")
"""drawn by the processor: the same with and without graphics hardware"""


def browser_path():
    """The browser that is there, or the one that HOBTWIN_BROWSER names."""
    named = os.environ.get("HOBTWIN_BROWSER")
    return named or next((path for name in NAMES if (path := shutil.which(name))), None)


@pytest.fixture(scope="session")
def browser():
    playwright = pytest.importorskip("playwright.sync_api", reason="playwright is not installed")
    path = browser_path()
    if path is None:
        pytest.skip(f"no browser here, none of {', '.join(NAMES)}: apt-get install chromium")
    with playwright.sync_playwright() as driver:
        started = driver.chromium.launch(executable_path=path, args=list(FLAGS))
        yield started
        started.close()


@pytest.fixture(scope="session")
def sample():
    """Builders of parts, inspections and recordings: those of the report's own tests."""
    place = Path(__file__).parents[1] / "twin" / "report" / "conftest.py"
    spec = importlib.util.spec_from_file_location("report_builders", place)
    module = importlib.util.module_from_spec(spec)
    sys.modules["report_builders"] = module
    spec.loader.exec_module(module)
    return module


@dataclass
class Opened:
    """A page from the disk, and what it said and asked for."""

    page: object
    said: list[str] = field(default_factory=list)
    asked: list[str] = field(default_factory=list)

    def tab(self, name):
        self.page.click(f"#tab-{name}")

    def part(self):
        """Wait until the part is drawn."""
        self.page.wait_for_selector(".viewer.ready", state="attached")
        self.page.wait_for_selector("canvas[data-drawn]", state="attached")


@pytest.fixture
def open_page(browser, tmp_path):
    """Write a report and open it from the disk, without network."""
    contexts = []

    def opened(report, *, width=1280, script="", address="", **settings):
        path = tmp_path / "report.html"
        write_report(path, report)
        context = browser.new_context(viewport={"width": width, "height": 900}, offline=True, **settings)
        contexts.append(context)
        page = context.new_page()
        found = Opened(page)
        page.on("console", lambda message: found.said.append(f"{message.type}: {message.text}"))
        page.on("pageerror", lambda error: found.said.append(str(error)))
        page.on("request", lambda request: found.asked.append(request.url))
        if script:
            page.add_init_script(script)
        page.goto(path.as_uri() + address)
        return found

    yield opened
    for context in contexts:
        context.close()
