"""A real browser: headless Chromium, asked over its debugging pipe, with nothing between it and the tests."""

import os
import shutil
from collections.abc import Iterator
from pathlib import Path

import pytest

from browser.chromium import Chromium

NAMES = ("chromium", "chromium-browser", "google-chrome", "chrome")


@pytest.fixture(scope="session")
def running(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Chromium]:
    """The browser for all tests; ``CHROMIUM`` in the environment names the program."""
    program = os.environ.get("CHROMIUM") or next(filter(None, map(shutil.which, NAMES)), None)
    if program is None:
        pytest.skip("no Chromium was found, so no page was opened in a browser; install one, or name it in CHROMIUM")
    browser = Chromium(Path(program), tmp_path_factory.mktemp("profile"))
    yield browser
    browser.close()


@pytest.fixture
def chromium(running: Chromium) -> Iterator[Chromium]:
    """The browser for one test. Its pages are closed after it: a page that plays an animation takes half a core."""
    assert running.pages == []
    yield running
    running.close_pages()
