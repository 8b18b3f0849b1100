"""Pages in Chromium, driven by Playwright, and what they wrote, threw and requested."""

import time
from pathlib import Path

from playwright.sync_api import Browser, ConsoleMessage, Error, Frame, Page, Request, WebError

PATIENCE = 120_000.0
"""Longest time (ms) of one action."""


class Visitor:
    """Opens each page in a context with the properties of a device."""

    def __init__(self, browser: Browser) -> None:
        self.browser = browser
        self.complaints: list[str] = []
        self.requests: list[str] = []

    def page(
        self, *, width: int = 1200, height: int = 900, scale: float = 1.0, scheme: str = "light", touch: bool = False
    ) -> Page:
        """Return an empty page. ``scale`` is the number of pixels of a screenshot per pixel of the page."""
        context = self.browser.new_context(
            viewport={"width": width, "height": height},
            device_scale_factor=scale,
            color_scheme="dark" if scheme == "dark" else "light",
            has_touch=touch,
            is_mobile=touch,
        )
        context.set_default_timeout(PATIENCE)
        context.on("console", self._console)
        context.on("weberror", self._error)
        context.on("request", self._request)
        return context.new_page()

    def open(self, path: Path, **device) -> Page:
        """Return a page with a report, when its figures are drawn."""
        page = self.page(**device)
        page.goto(path.as_uri())
        wait_for_figures(page)
        return page

    def close(self) -> None:
        """Close all pages: an animation that plays takes half a core."""
        for context in self.browser.contexts:
            context.close()

    def _console(self, message: ConsoleMessage) -> None:
        self.complaints.append(message.text)

    def _error(self, error: WebError) -> None:
        self.complaints.append(str(error.error))

    def _request(self, request: Request) -> None:
        if not request.url.startswith(("data:", "blob:")):
            self.requests.append(request.url)


def wait_until(page: Page | Frame, script: str) -> None:
    """Wait until the value of a script is true, over navigations too.

    Playwright's ``wait_for_function`` cannot wait here: it uses ``eval`` in the page, which the policy of reports forbids.
    """
    end = time.monotonic() + PATIENCE / 1000
    while not _value(page, script):
        assert time.monotonic() < end, f"not true after {PATIENCE / 1000:g} s: {script}"
        page.wait_for_timeout(50)


def _value(page: Page | Frame, script: str) -> object:
    """Value of a script; None while one page replaces another."""
    try:
        return page.evaluate(script)
    except Error as error:
        if "context was destroyed" in str(error) or "navigation" in str(error):
            return None
        raise


def wait_for_figures(page: Page | Frame) -> None:
    """Wait until a report has drawn its figures."""
    wait_until(page, "document.documentElement.dataset.ready === 'yes'")


def move_focus(page: Page, inside: Frame | None = None) -> None:
    """Press Tab and wait until the focus has moved; ``inside`` is the frame that receives it."""
    place = inside or page.main_frame
    place.evaluate("window.focused = document.hasFocus() && document.activeElement; true")
    page.keyboard.press("Tab")
    wait_until(place, "document.hasFocus() && document.activeElement !== window.focused")
