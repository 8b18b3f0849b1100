"""A real browser: the installed Chromium or Chrome, or Playwright's own, headless, driven by Playwright."""

import os
import shutil
from collections.abc import Iterator
from importlib import import_module
from pathlib import Path

import pytest
from playwright.sync_api import Browser, Playwright, sync_playwright

from browser.visitor import Visitor

NAMES = ("chromium", "chromium-browser", "google-chrome", "google-chrome-stable", "chrome")
FOLDERS = ("/usr/bin", "/usr/local/bin", "/snap/bin", "/opt/google/chrome")
"""Where browsers are installed, which the search path need not contain."""
APPLICATION = "/Applications/Google Chrome.app/Contents/MacOS/Google Chrome"
MISSING = (
    "No Chromium is installed. Install it: 'apt install chromium', or 'playwright install chromium' for Playwright's "
    "own. Or name the program in the environment variable CHROMIUM."
)

REQUIRED = os.environ.get("BROWSER_TESTS") == "required"
"""Where a machine with a browser tests every change, a missing program or package must not hide failures: it fails."""
if REQUIRED:
    for package in ("anywidget", "axe_playwright_python"):
        import_module(package)


@pytest.fixture(scope="module")
def browser() -> Iterator[Browser]:
    """The browser of one module; ``CHROMIUM`` in the environment names the program.

    Playwright runs an event loop in this thread, in which other tests could not start theirs: it ends with the module.
    """
    with sync_playwright() as playwright:
        program = _program(playwright)
        if program is None:
            (pytest.fail if REQUIRED else pytest.skip)(MISSING)
        running = playwright.chromium.launch(executable_path=program)
        yield running
        running.close()


def _program(playwright: Playwright) -> str | None:
    """Path of the browser; None if there is none."""
    if named := os.environ.get("CHROMIUM"):
        return named
    places = [APPLICATION, playwright.chromium.executable_path]
    search = os.pathsep.join([os.environ.get("PATH", ""), *FOLDERS])
    installed = (shutil.which(name, path=search) for name in NAMES)
    return next(filter(None, installed), None) or next((place for place in places if Path(place).is_file()), None)


@pytest.fixture
def chromium(browser: Browser) -> Iterator[Visitor]:
    """The browser for one test, without pages of earlier ones."""
    assert browser.contexts == []
    visitor = Visitor(browser)
    yield visitor
    visitor.close()
