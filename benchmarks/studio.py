"""What a user of the studio waits for: its start, the pages of a study and of a run, and long lists, in a real browser.

Seconds by the clock, and processor seconds of the studio's processes and of the browser's, scaled by a loop in plain
Python that runs before each of them. On a busy machine the clock says little: compare the processor seconds. The start
is in a fresh profile of the browser, the others in one that has the studio's files.
"""

import json
import os
import re
import shutil
import statistics
import subprocess
import sys
import tempfile
import time
from collections import defaultdict
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from datetime import UTC, datetime, timedelta
from pathlib import Path

from playwright.sync_api import Browser, BrowserContext, ViewportSize, sync_playwright

from benchmarks import timing
from benchmarks.sliders import STUDY, chromium
from benchmarks.startup import QUIET, ROOT, _loop

RUNS, STUDIES, REPEATS = 1000, 300, 3
SETTLED = 8.0
"""Seconds in which the studio has started."""
VIEW: ViewportSize = {"width": 1440, "height": 900}
STUDY_PAGE = {"its text": ".cm-content .cm-line", "checked": "text=Valid.", "drawn": ".model-drawing svg"}
RUN_PAGE = {"its state": "[role=status]", "its report": "iframe"}
TABLE = {"the newest listed": ".ag-row", "all listed": f".ag-root[aria-rowcount='{RUNS + 1}']"}
CARDS = {"listed": "[role=listitem]"}
Times = dict[str, dict[str, float]]
"""Seconds by the clock and of the processor until something is shown."""


@dataclass
class Studio:
    """A studio in processes of its own.

    Parameters
    ----------
    address : str
    process : int
    """

    address: str
    process: int

    def open(self, profile: BrowserContext, path: str, shown: dict[str, str]) -> Times:
        """Times until elements are shown in a new page."""
        scale, used, began = QUIET / _loop(), self.used(), time.perf_counter()
        return self.watched(profile, path, shown, scale, began, used)

    def used(self) -> tuple[float, float]:
        """Processor seconds of the studio and of the browser."""
        own = _processor_time(self.process)
        return own, _processor_time(os.getpid()) - own - time.process_time()

    def watched(
        self,
        profile: BrowserContext,
        path: str,
        shown: dict[str, str],
        scale: float,
        began: float,
        used: tuple[float, float],
    ) -> Times:
        """Times since a moment until elements are shown in a new page."""
        page, found = profile.new_page(), {}
        page.goto(f"{self.address}{path}", wait_until="commit")
        for name, element in shown.items():
            page.wait_for_selector(element, timeout=120_000)
            own, browser = (now - before for now, before in zip(self.used(), used, strict=True))
            wall = time.perf_counter() - began
            found[name] = {"wall s": scale * wall, "CPU s": scale * own, "browser, CPU s": scale * browser}
        page.close()
        return found


def main() -> list[dict[str, object]]:
    with tempfile.TemporaryDirectory() as folder, sync_playwright() as playwright:
        root, browser = Path(folder), playwright.chromium.launch(executable_path=chromium())
        rows = [*_of_a_study(root, browser), *_of_lists(root, browser)]
        browser.close()
    timing.report("studio", "What a user of the studio waits for (on a busy machine, compare processor seconds)", rows)
    return rows


def _of_a_study(root: Path, browser: Browser) -> Iterator[dict[str, object]]:
    """The start of the studio, and the pages of a study and of a run."""
    path = f"/study/{STUDY}/identify"
    shutil.copytree(ROOT / "studies" / STUDY, root / "studies" / STUDY)
    yield from _rows("the studio's start and a study's page", [_cold(root, browser, path) for _ in range(REPEATS)])
    study, run = root / "studies" / STUDY / "identify.toml", root / "runs" / "identify"
    subprocess.run([sys.executable, "-m", "dalembert.cli", "run", study, "--out", run], check=True, capture_output=True)
    with _studio(root) as studio:
        profile = browser.new_context(viewport=VIEW)
        studio.open(profile, path, STUDY_PAGE)
        yield from _rows("a study's page", [studio.open(profile, path, STUDY_PAGE) for _ in range(REPEATS)])
        yield from _rows("a run's page, first opening", [studio.open(profile, "/run/identify", RUN_PAGE)])
        yield from _rows("a run's page", [studio.open(profile, "/run/identify", RUN_PAGE) for _ in range(REPEATS)])


def _of_lists(root: Path, browser: Browser) -> Iterator[dict[str, object]]:
    """Many runs and many studies."""
    _copies(root)
    with _studio(root) as studio:
        time.sleep(SETTLED)
        for name, path, shown in ((f"{RUNS} runs", "/", TABLE), (f"{STUDIES} studies", "/studies", CARDS)):
            profile = browser.new_context(viewport=VIEW)
            yield from _rows(f"{name}, first opening", [studio.open(profile, path, shown)])
            yield from _rows(name, [studio.open(profile, path, shown) for _ in range(REPEATS)])


def _rows(what: str, found: list[Times]) -> Iterator[dict[str, object]]:
    """Medians, a row for each thing that was waited for."""
    for name, kinds in found[0].items():
        medians = {kind: round(statistics.median(times[name][kind] for times in found), 2) for kind in kinds}
        yield {"what": what, "until": name, **medians}


def _cold(root: Path, browser: Browser, path: str) -> Times:
    """Times from the start of the studio."""
    profile, scale, began = browser.new_context(viewport=VIEW), QUIET / _loop(), time.perf_counter()
    others = _processor_time(os.getpid()) - time.process_time()
    with _studio(root) as studio:
        return studio.watched(profile, path, STUDY_PAGE, scale, began, (0.0, others))


@contextmanager
def _studio(root: Path) -> Iterator[Studio]:
    command = [sys.executable, "-m", "dalembert.cli", "studio", str(root), "--port", "0", "--no-browser"]
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True, cwd=ROOT, start_new_session=True) as studio:
        assert studio.stdout is not None
        address = re.findall(r"http://\S+", studio.stdout.readline())[0].rstrip("/")
        yield Studio(address, studio.pid)
        studio.terminate()


def _copies(root: Path) -> None:
    """Make many runs and studies, each with a name of its own."""
    run, study = root / "runs" / "identify", root / "studies" / STUDY
    state = json.loads((run / "state.json").read_text())
    for number in range(RUNS - 1):
        copy = root / "runs" / f"identify {number}"
        shutil.copytree(run, copy, ignore=shutil.ignore_patterns("*.html", "*.nc"))
        since = (datetime.now(UTC) - timedelta(minutes=number)).isoformat(timespec="seconds")
        (copy / "state.json").write_text(json.dumps({**state, "since": since}))
    for number in range(STUDIES - 1):
        copy = root / "studies" / f"study {number}"
        copy.mkdir()
        for name in ("identify.toml", "table-a1.csv"):
            shutil.copy(study / name, copy)


def _processor_time(first: int) -> float:
    """Processor seconds of a process and of all that descend from it, with those that have ended."""
    ticks, children = {}, defaultdict(list)
    for process in Path("/proc").glob("[0-9]*"):
        try:
            fields = (process / "stat").read_text().rpartition(")")[2].split()
        except OSError:  # it has ended
            continue
        children[int(fields[1])].append(int(process.name))
        ticks[int(process.name)] = sum(map(int, fields[11:15]))
    found, total = [first], 0
    while found:
        process = found.pop()
        total += ticks.get(process, 0)
        found += children[process]
    return total / os.sysconf("SC_CLK_TCK")


if __name__ == "__main__":
    main()
