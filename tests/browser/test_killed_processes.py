"""Processes that are killed: the page says so in a sentence, what was computed is kept, and everything can be continued."""

import json
import os
import re
import signal
from contextlib import suppress
from pathlib import Path

import pytest
from playwright.sync_api import Page

from browser.running_studio import ended, opener, start_studio
from browser.visitor import wait_until
from dalembert.study.template import begin

pytestmark = pytest.mark.slow
TEXT = "(document.body?.innerText ?? '')"
MODEL = """
import time
import numpy as np
from dalembert.forward import PythonModel

def slow(parameters):
    return PythonModel(response, parameters, ["x"], np.linspace(0, 1, 3))

def response(rate):
    time.sleep(0.01)
    return np.exp(-rate * np.linspace(0, 1, 3))
"""
SWEEP = """
[parameters]
rate = { lower = 0.5, upper = 2.0 }
[model]
forward = "slow.py:slow"
[sweep]
at = 0.5
channels = ["x"]
sensitivities = false
over = { rate = { count = 800 } }
"""


@pytest.fixture
def studio(tmp_path):
    """A studio as its process and its address."""
    process, address = start_studio(tmp_path)
    with process, ended(process):
        yield process, address


def children(process: int) -> list[int]:
    """Processes that a process started, but for runs, which have sessions of their own."""
    found = []
    for entry in Path("/proc").glob("[0-9]*"):
        try:
            parent, _, session = entry.joinpath("stat").read_text().rpartition(")")[2].split()[1:4]
        except OSError:
            continue
        if int(parent) == process and session != entry.name:
            found.append(int(entry.name))
    return found


def click(page: Page, name: str) -> None:
    page.get_by_role("button", name=name).first.click()


def started(visit, root: Path) -> Page:
    """The page of a run that is going on."""
    folder = root / "studies" / "long"
    folder.mkdir(parents=True)
    (folder / "slow.py").write_text(MODEL)
    (folder / "study.toml").write_text(SWEEP)
    page = visit("/study/long/study")
    wait_until(page, f"{TEXT}.includes('Valid.')")
    click(page, "Run")
    wait_until(page, f"location.pathname === '/run/long' && /rate = .* of 800/.test({TEXT})")
    return page


def test_a_killed_run_is_resumed(chromium, studio, tmp_path):
    page = started(opener(chromium, studio[1]), tmp_path)
    state = tmp_path / "runs" / "long" / "state.json"
    os.kill(json.loads(state.read_text())["process"], signal.SIGKILL)
    wait_until(page, f"{TEXT}.includes('The process of this run ended by the signal SIGKILL.')")
    assert "What it computed is kept. Resume continues it." in page.inner_text("body")
    click(page, "Resume")
    wait_until(page, f"{TEXT}.includes('finished')")
    events = [json.loads(line) for line in (tmp_path / "runs" / "long" / "events.jsonl").read_text().splitlines()]
    assert [event["event"] for event in events if event["event"].startswith("run-")] == [
        "run-started",
        "run-resumed",
        "run-ended",
    ]


def test_a_run_outlives_a_studio_that_is_killed(chromium, studio, tmp_path):
    process, address = studio
    page = started(opener(chromium, address), tmp_path)
    own = children(process.pid)
    process.kill()
    process.wait()
    wait_until(page, f"{TEXT}.includes('Connection lost.')")
    again, _ = start_studio(tmp_path, address.rpartition(":")[2])
    with again, ended(again):
        wait_until(page, f"{TEXT}.includes('finished')")
    assert not [one for one in own if Path(f"/proc/{one}").exists()]


def test_a_killed_process_of_a_study_is_replaced(chromium, studio, tmp_path):
    process, address = studio
    begin("identify", tmp_path / "studies" / "mine")
    page = opener(chromium, address)("/study/mine/mine")
    page.locator("[data-part=rod]").first.wait_for()
    page.get_by_role("tab", name="Sliders").click()
    wait_until(page, f"/[Mm]isfit/.test({TEXT})")
    page.get_by_role("slider").first.focus()
    for number in range(10):
        page.keyboard.press("ArrowRight")
        page.wait_for_timeout(30 * number)
        for child in children(process.pid):
            with suppress(ProcessLookupError):  # one that ended with another
                os.kill(child, signal.SIGKILL)
    page.keyboard.press("ArrowLeft")
    wait_until(page, f"/[Mm]isfit/.test({TEXT}) && !{TEXT}.includes('ended by the signal')")
    assert chromium.complaints == []


def test_a_run_that_is_not_there_is_a_sentence(chromium, studio):
    page = opener(chromium, studio[1])("/run/nothing")
    wait_until(page, f"{TEXT}.includes('There is no run of this name')")
    assert re.search(r"\bmissing\b", page.inner_text("body"))
