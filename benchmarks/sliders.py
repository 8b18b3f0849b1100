"""From a slider of the studio to the new picture, in a real browser, for the pendulum of the demo.

A key moves the slider of a parameter by a step. The time runs from the event in the page until the mechanism and the
curves are drawn with the new values. Times are divided by the time of a loop in plain Python that runs before each
move, and multiplied by the loop's time on a quiet machine.
"""

import os
import re
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np
from playwright.sync_api import Page, sync_playwright

from benchmarks import timing
from benchmarks.startup import QUIET, ROOT, _loop

STUDY = "flexible-pendulum"
MOVES = 40
LIMIT = 20_000.0  # ms of one move
WATCH = """
() => {
  const epoch = (time) => performance.timeOrigin + time;
  const slider = document.querySelector("input[type=range][aria-label=theta1]");
  slider.addEventListener("input", () => { window.moved = epoch(performance.now()); }, true);
  for (const plot of document.querySelectorAll(".js-plotly-plot")) {
    plot.on("plotly_afterplot", () => { window.plotted = epoch(performance.now()); });
  }
  new MutationObserver(() => { window.played = epoch(performance.now()); }).observe(
    document.querySelector(".player"), { attributes: true, attributeFilter: ["data-number"] });
  slider.focus();
}
"""
DRAWN = "() => window.played > window.moved && window.plotted > window.moved"
TIMES = """() => {
  const { taken, simulated, computed, received, answered } = document.querySelector(".player").dataset;
  return { moved, played, plotted, taken, simulated, computed, received, answered };
}"""


def main() -> list[dict[str, object]]:
    with tempfile.TemporaryDirectory() as folder, sync_playwright() as playwright:
        shutil.copytree(ROOT / "studies" / STUDY, Path(folder, "studies", STUDY))
        command = [sys.executable, "-m", "dalembert.cli", "studio", folder, "--port", "0", "--no-browser"]
        with subprocess.Popen(command, stdout=subprocess.PIPE, text=True, cwd=ROOT) as studio:
            assert studio.stdout is not None
            address = re.findall(r"http://\S+", studio.stdout.readline())[0].rstrip("/")
            browser = playwright.chromium.launch(executable_path=chromium())
            page = browser.new_page(viewport={"width": 1440, "height": 900})
            page.goto(f"{address}/study/{STUDY}/identify")
            page.get_by_role("tab", name="Sliders").click()
            page.wait_for_selector(".player[data-number]", timeout=60_000)
            page.wait_for_selector(".effect", timeout=60_000)
            page.evaluate(WATCH)
            moves = [_move(page) for _ in range(MOVES + 5)][5:]
            browser.close()
            studio.terminate()
    rows = [_row(name, np.array([move[name] for move in moves])) for name in moves[0]]
    timing.report("sliders", "From a slider to the new picture in the studio", rows)
    return rows


def _move(page: Page) -> dict[str, float]:
    """Times (ms) of one move, scaled to a quiet machine."""
    scale = QUIET / _loop()
    page.keyboard.press("ArrowRight")
    page.wait_for_function(DRAWN, timeout=LIMIT, polling=5)
    at = {name: float(value) for name, value in page.evaluate(TIMES).items()}
    total = max(at["played"], at["plotted"]) - at["moved"]
    parts = {
        "simulation": 1000 * at["simulated"],
        "film and curves": 1000 * (at["computed"] - at["simulated"]),
        "transfer": (1000 * at["received"] - at["moved"]) + (at["taken"] - 1000 * at["answered"]),
        "drawing": max(at["played"], at["plotted"]) - at["taken"],
    }
    own = {"all": total, **parts, "remaining": total - sum(parts.values())}
    page.wait_for_timeout(500)  # until the effects of the parameters are computed
    return {name: scale * span for name, span in own.items()}


def _row(name: str, times: np.ndarray) -> dict[str, object]:
    return {"part": name, "median, ms": float(np.median(times)), "95 %, ms": float(np.quantile(times, 0.95))}


def chromium() -> str:
    """The program of the browser."""
    found = os.environ.get("CHROMIUM") or next(filter(None, map(shutil.which, ("chromium", "chromium-browser"))), None)
    if found is None:
        raise RuntimeError("Chromium is not installed. Install it, or name the program in CHROMIUM.")
    return found


if __name__ == "__main__":
    main()
