"""A real browser: Debian's Chromium, headless, driven by Playwright."""

import os
import shutil
from collections.abc import Iterator

import pytest
from playwright.sync_api import Browser, sync_playwright

from browser.visitor import Visitor

NAMES = ("chromium", "chromium-browser", "google-chrome", "chrome")


@pytest.fixture(scope="module")
def browser() -> Iterator[Browser]:
    """The browser of one module; ``CHROMIUM`` in the environment names the program.

    Playwright runs an event loop in this thread, in which other tests could not start theirs: it ends with the module.
    """
    program = os.environ.get("CHROMIUM") or next(filter(None, map(shutil.which, NAMES)), None)
    if program is None:
        pytest.skip("Chromium is not installed. Install it, or name the program in CHROMIUM.")
    with sync_playwright() as playwright:
        running = playwright.chromium.launch(executable_path=program)
        yield running
        running.close()


@pytest.fixture
def chromium(browser: Browser) -> Iterator[Visitor]:
    """The browser for one test, without pages of earlier ones."""
    assert browser.contexts == []
    visitor = Visitor(browser)
    yield visitor
    visitor.close()
