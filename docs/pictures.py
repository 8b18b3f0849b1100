"""Take the pictures of these pages: ``python docs/pictures.py RUN``, RUN the finished demo's folder.

``python docs/pictures.py RUN FIRST FINAL`` takes those of the tutorial on raw records too, from the folders of its two
runs.

Needs Chromium, which the tests of pages drive as well.
"""

import os
import re
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

HERE = Path(__file__).parent
sys.path.insert(0, str(HERE.parent / "tests"))

from playwright.sync_api import Page, sync_playwright  # noqa: E402

from browser.visitor import Visitor, wait_until  # noqa: E402 - from the tests

DEVICE = {"width": 1200, "scale": 0.75}


def take(page: Page, name: str, top: float, bottom: float) -> None:
    """A strip of a page as ``pictures/NAME.png``."""
    clip = {"x": 0, "y": top, "width": DEVICE["width"], "height": bottom - top}
    page.screenshot(path=HERE / "pictures" / f"{name}.png", clip=clip, full_page=True)


def end_of(page: Page, selector: str) -> float:
    return page.evaluate(f"document.querySelector('{selector}').getBoundingClientRect().bottom + scrollY")


def report(browser: Visitor, run: Path) -> None:
    page = browser.open(run / "report.html", **DEVICE)
    page.evaluate("document.querySelector('#parameters').remove()")  # the headline shows them
    take(page, "report", 0, end_of(page, "#mechanism"))


def records(browser: Visitor, first: Path, final: Path) -> None:
    """The record with a wrong reading in the first study, and the one that is predicted in the final one."""
    for name, run, figure in (("records-first", first, "experiment-3-1"), ("records-final", final, "experiment-4-1")):
        page = browser.open(run / "report.html", **DEVICE)
        wait_until(page, f"document.querySelector('#figure-{figure} .main-svg')")
        begin = page.evaluate(f"document.querySelector('#figure-{figure}').getBoundingClientRect().top + scrollY")
        take(page, name, begin, end_of(page, f"#figure-{figure}"))


def studio(browser: Visitor, workspace: Path) -> None:
    """A study with its sliders."""
    command = [Path(sys.executable).with_name("dalembert"), "studio", workspace, "--port", "0", "--no-browser"]
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as serving:
        address = re.search(r"http://\S+", serving.stdout.readline())[0].rstrip("/")
        page = browser.page(width=1280)
        page.emulate_media(reduced_motion="reduce")  # the mechanism stays at its first position
        page.goto(f"{address}/new")
        page.get_by_label("Name (optional)").fill("pendulum")
        page.locator("button", has_text="measured motion").first.click()
        page.get_by_role("tab", name="Sliders").click()
        wait_until(page, "document.querySelector('.effect')?.checkVisibility()")
        page.screenshot(path=HERE / "pictures" / "studio.png")
        serving.terminate()


if __name__ == "__main__":
    with tempfile.TemporaryDirectory() as folder, sync_playwright() as playwright:
        program = os.environ.get("CHROMIUM") or shutil.which("chromium")
        chromium = Visitor(playwright.chromium.launch(executable_path=program))
        report(chromium, Path(sys.argv[1]))
        studio(chromium, Path(folder))
        if len(sys.argv) > 2:
            records(chromium, Path(sys.argv[2]), Path(sys.argv[3]))
        chromium.close()
