"""A real browser: headless Chromium, asked over its debugging pipe, with nothing between it and the tests."""

import os
import shutil
from collections.abc import Iterator
from pathlib import Path

import pytest

from browser.chromium import Chromium

NAMES = ("chromium", "chromium-browser", "google-chrome", "chrome")


@pytest.fixture(scope="session")
def chromium(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Chromium]:
    """The browser; ``CHROMIUM`` in the environment names the program."""
    program = os.environ.get("CHROMIUM") or next(filter(None, map(shutil.which, NAMES)), None)
    if program is None:
        pytest.skip("no Chromium was found, so no page was opened in a browser; install one, or name it in CHROMIUM")
    running = Chromium(Path(program), tmp_path_factory.mktemp("profile"))
    yield running
    running.close()
