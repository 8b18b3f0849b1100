"""Take the pictures of these pages: ``python docs/pictures.py RUN``, RUN the finished demo's folder.

``python docs/pictures.py RUN FIRST FINAL`` takes those of the tutorial on raw records too, from the folders of its two
runs.

Needs Chromium, which the tests of pages drive as well.
"""

import base64
import re
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

HERE = Path(__file__).parent
sys.path.insert(0, str(HERE.parent / "tests"))

from browser.chromium import Chromium, Tab  # noqa: E402 - from the tests, which are no package of ours

WIDTH = 1200


def take(tab: Tab, name: str, top: float, bottom: float) -> None:
    """A strip of a page as ``pictures/NAME.png``."""
    clip = {"x": 0, "y": top, "width": WIDTH, "height": bottom - top, "scale": 0.75}
    shot = tab.send("Page.captureScreenshot", clip=clip, captureBeyondViewport=True)
    (HERE / "pictures" / f"{name}.png").write_bytes(base64.b64decode(shot["data"]))


def end_of(tab: Tab, selector: str) -> float:
    return tab.run(f"document.querySelector('{selector}').getBoundingClientRect().bottom + scrollY")


def report(browser: Chromium, run: Path) -> None:
    tab = browser.open(run / "report.html", width=WIDTH)
    tab.run("document.querySelector('#parameters').remove()")  # the headline tells them
    take(tab, "report", 0, end_of(tab, "#mechanism"))


def records(browser: Chromium, first: Path, final: Path) -> None:
    """The record with a wrong reading in the first study, and the one that is predicted in the final one."""
    for name, run, figure in (("records-first", first, "experiment-3-1"), ("records-final", final, "experiment-4-1")):
        tab = browser.open(run / "report.html", width=WIDTH)
        tab.until(f"document.querySelector('#figure-{figure} .main-svg')")
        begin = tab.run(f"document.querySelector('#figure-{figure}').getBoundingClientRect().top + scrollY")
        take(tab, name, begin, end_of(tab, f"#figure-{figure}"))


def studio(browser: Chromium, workspace: Path) -> None:
    command = [Path(sys.executable).with_name("dalembert"), "studio", workspace, "--port", "0", "--no-browser"]
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as serving:
        address = re.search(r"http://\S+", serving.stdout.readline())[0].rstrip("/")
        tab = browser.tab(width=WIDTH, height=900)
        tab.send("Page.navigate", url=f"{address}/new")
        tab.click("[...document.querySelectorAll('button')].find((one) => one.innerText.includes('measured motion'))")
        tab.until("document.querySelectorAll('.js-plotly-plot .trace').length === 2")
        drawing = "document.querySelector('.js-plotly-plot')"
        tab.until(f"{drawing}.querySelector('.main-svg').clientHeight <= {drawing}.clientHeight")  # it has its place
        take(tab, "studio", 0, tab.run("document.documentElement.scrollHeight"))
        serving.terminate()


if __name__ == "__main__":
    with tempfile.TemporaryDirectory() as folder:
        chromium = Chromium(Path(shutil.which("chromium")), Path(folder) / "profile")
        report(chromium, Path(sys.argv[1]))
        studio(chromium, Path(folder))
        if len(sys.argv) > 2:
            records(chromium, Path(sys.argv[2]), Path(sys.argv[3]))
        chromium.close()
