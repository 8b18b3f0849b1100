"""Measured data, guided: columns are corrected by menus, problems by buttons; large files do not block the studio."""

import re
import time
import tomllib
from pathlib import Path
from shutil import copytree

import numpy as np
import pytest
from playwright.sync_api import Page

from browser.running_studio import opener, running_studio
from browser.visitor import Visitor, wait_until
from dalembert.study.template import begin

pytestmark = pytest.mark.slow
STUDIES = Path(__file__).parents[2] / "studies"
TEXT = "(document.body?.innerText ?? '')"
LONGEST_ANSWER = 5.0
"""Seconds, on a machine whose cores other processes use as well."""
LONGEST_LOADING = 300.0
"""Seconds for a file of 50 MB, on such a machine."""


@pytest.fixture
def root(tmp_path):
    return tmp_path / "empty"


@pytest.fixture
def visit(chromium: Visitor, root):
    """Open pages of a studio for a folder."""
    root.mkdir()
    with running_studio(root) as address:
        yield opener(chromium, address)


def choose(page: Page, menu: str, entry: str) -> None:
    """Choose an entry of a menu."""
    page.get_by_label(menu).click()
    page.get_by_role("option", name=entry, exact=True).click()
    wait_until(page, "!document.querySelector('.q-menu')")


def test_columns_are_corrected_by_menus_and_problems_by_buttons(visit, root, tmp_path):
    study = begin("identify", root / "studies" / "drag")
    rows = [f"{10 * row};{20 + 700 * (row == 60) + np.cos(row / 9):.3f};{row}" for row in range(200)]
    rows[30] = "300;;30"
    (study.parent / "own.csv").write_text("\n".join(["a;b;c", *rows]))
    page = visit("/study/drag/drag")
    page.get_by_role("tab", name="Data").click()
    page.get_by_label("Use of column x").wait_for()
    choose(page, "Data file", "own.csv")
    choose(page, "Use of column a", "times")
    choose(page, "Use of column b", "rod.end.angle (rad)")
    choose(page, "Unit of column b", "deg")
    wait_until(page, f"{TEXT}.includes('1 value of the column \\'b\\' lies far from the values around it')")
    wait_until(page, f"{TEXT}.includes('They are taken to be in ms: 100 samples a second')")
    page.get_by_role("button", name="Write into the study").click()
    page.get_by_role("button", name="Save").click()
    wait_until(page, f"{TEXT}.includes('Saved.')")
    data = tomllib.loads(study.read_text())["data"]
    assert data == {
        "file": "own.csv",
        "time": "a",
        "columns": {"rod.end.angle": "b"},
        "units": {"a": "ms", "b": "deg"},
        "missing": "leave-out",
    }
    page.get_by_role("button", name="Undo").click()
    wait_until(page, "document.querySelector('.cm-content').innerText.includes('motion.csv')")
    page.get_by_label("Use of column x").wait_for()


def test_a_file_without_times_and_with_words_is_put_right(visit, root):
    study = begin("identify", root / "studies" / "drag")
    cells = [f"{20 + 10 * np.cos(row / 9):.3f}" for row in range(200)]
    cells[30] = "dropout"
    (study.parent / "own.csv").write_text("\n".join(["angle", *cells]))
    page = visit("/study/drag/drag")
    page.get_by_role("tab", name="Data").click()
    page.get_by_label("Use of column x").wait_for()
    choose(page, "Data file", "own.csv")
    choose(page, "Use of column angle", "rod.end.angle (rad)")
    page.get_by_label("Sampling rate (Hz)").fill("50")
    page.get_by_role("button", name="Take it as a missing value").click()
    wait_until(page, f"!{TEXT}.includes('dropout')")
    page.get_by_role("button", name="Write into the study").click()
    page.get_by_role("button", name="Save").click()
    wait_until(page, f"{TEXT}.includes('Saved.')")
    data = tomllib.loads(study.read_text())["data"]
    assert (data["sampling"], data["missing"]) == (50, ["dropout"])


def test_a_file_of_50_mb_does_not_block_the_studio(visit, root, tmp_path):
    study = begin("identify", root / "studies" / "large")
    rows = 1_250_000
    times = 1000 + np.arange(rows) * 0.5
    line = "%.4f;%.11f;%.13f\n"
    file = tmp_path / "large.csv"
    with file.open("w") as text:
        text.write("time_ms;angle_deg;current\n")
        for part in np.array_split(times, 25):
            text.write((line * len(part)) % tuple(np.c_[part, np.sin(part / 1000), np.cos(part / 300)].ravel()))
    assert file.stat().st_size > 50e6
    page, other = visit("/study/large/large"), visit("/")
    page.get_by_role("tab", name="Data").click()
    page.get_by_label("Use of column x").wait_for()
    page.locator("input[type=file]").first.set_input_files(file)
    longest = 0.0
    end = time.monotonic() + LONGEST_LOADING
    while not page.get_by_label("Use of column angle_deg").is_visible():
        longest = max(longest, answer_time(other))
        assert time.monotonic() < end, page.inner_text("body")
    choose(page, "Use of column angle_deg", "rod.start.angle (rad)")
    wait_until(page, f"{TEXT}.includes('The record has 1250000 samples')")
    page.get_by_role("button", name="Decimate").click()
    page.get_by_role("button", name="Write into the study").click()
    end = time.monotonic() + LONGEST_LOADING
    while "angle from 5000 samples" not in page.inner_text("body"):
        longest = max(longest, answer_time(other))
        assert time.monotonic() < end, page.inner_text("body")
    assert longest < LONGEST_ANSWER
    assert (study.parent / "large.csv").stat().st_size == file.stat().st_size


def answer_time(page: Page) -> float:
    """Seconds until the studio answers a request for a page."""
    return page.evaluate(
        "async () => { const t = performance.now(); await fetch('/'); return (performance.now() - t) / 1000 }"
    )


def test_the_channel_of_a_column_is_picked_in_the_drawing(visit, root):
    study = begin("identify", root / "studies" / "drag")
    page = visit("/study/drag/drag")
    page.get_by_role("tab", name="Data").click()
    page.get_by_label("Use of column y").wait_for()
    page.get_by_role("button", name="Pick the channel of column y in the drawing").click()
    drawing = page.get_by_role("dialog").locator("g.body[data-part=rod]")
    drawing.wait_for()
    page.keyboard.press("Escape")
    wait_until(page, "!document.querySelector('.q-dialog__inner')")
    page.get_by_role("button", name="Pick the channel of column y in the drawing").click()
    drawing.wait_for()
    drawing.click()
    page.get_by_role("button", name="rod.end.angle", exact=True).click()
    wait_until(page, "!document.querySelector('.q-dialog__inner')")
    wait_until(page, "document.querySelector('[aria-label=\"Use of column y\"]').value.startsWith('rod.end.angle')")
    page.get_by_role("button", name="Write into the study").click()
    page.get_by_role("button", name="Save").click()
    wait_until(page, f"{TEXT}.includes('Saved.')")
    assert tomllib.loads(study.read_text())["data"]["columns"]["rod.end.angle"] == "y"


def test_the_channel_of_a_column_is_picked_in_three_dimensions(visit, root):
    copytree(STUDIES / "spatial-slider-crank", root / "studies" / "crank")
    page = visit("/study/crank/identify")
    page.get_by_role("tab", name="Data").click()
    pick = page.get_by_role("button", name=re.compile("^Pick the channel of column ")).first
    pick.click()
    name = page.get_by_role("dialog").locator(".model-space button[aria-label='body slider']")
    name.wait_for()
    name.click()
    page.get_by_text("Channels of body slider:").wait_for()
    offers = page.get_by_role("group", name="Channels of the part").get_by_role("button")
    channel = offers.first.inner_text()
    assert channel.startswith("slider.")
    offers.first.click()
    wait_until(page, "!document.querySelector('.q-dialog__inner')")
    wait_until(page, f"[...document.querySelectorAll('input')].some((one) => one.value.startsWith('{channel}'))")
