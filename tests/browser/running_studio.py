"""A studio in a process of its own, and its pages in a browser."""

import re
import subprocess
import sys
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path

from playwright.sync_api import Page

from browser.visitor import Visitor, wait_until

COMMAND = Path(sys.executable).with_name("dalembert")
ALIVE = "document.querySelector('[role=main]') && window.socket?.connected && window.did_handshake"


@contextmanager
def running_studio(root: Path) -> Iterator[str]:
    """The address of a studio for a folder."""
    studio, address = start_studio(root)
    with studio, ended(studio):
        yield address


@contextmanager
def ended(studio: subprocess.Popen) -> Iterator[None]:
    """End a studio after a block, whatever happens in it."""
    try:
        yield
    finally:
        studio.terminate()


def start_studio(root: Path, port: int | str = 0, before: Sequence[str] = ()) -> tuple[subprocess.Popen, str]:
    """Start a studio for a folder, by the arguments of a command ``before`` if given; return it and its address."""
    command = [*before, COMMAND, "studio", root, "--port", str(port), "--no-browser"]
    studio = subprocess.Popen(command, stdout=subprocess.PIPE, text=True)
    assert studio.stdout is not None
    found = re.search(r"http://\S+", studio.stdout.readline())
    assert found is not None
    return studio, found[0].rstrip("/")


def opener(visitor: Visitor, address: str) -> Callable[..., Page]:
    """A function that opens a page of a studio and waits until it is alive."""

    def visit(path: str, **device) -> Page:
        page = visitor.page(**device)
        page.goto(address + path)
        wait_until(page, ALIVE)
        return page

    return visit
