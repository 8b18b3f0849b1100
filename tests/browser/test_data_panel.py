"""Measured data, guided: from an empty folder to an identified pendulum, by clicks alone."""

import json
import tomllib

import numpy as np
import pytest
from playwright.sync_api import Locator, Page
from scipy.integrate import solve_ivp

from browser.running_studio import opener, running_studio
from browser.visitor import Visitor, wait_until
from dalembert.study.template import begin

pytestmark = pytest.mark.slow
TEXT = "(document.body?.innerText ?? '')"
MOST_CLICKS = 25
LONGEST_ANSWER = 5.0
"""Seconds, on a machine whose cores other processes use as well."""
DRAG, ANGLE = 0.12, 40.0
"""Of the pendulum that was measured: N m s, and degrees from the vertical."""


@pytest.fixture(scope="module")
def own(tmp_path_factory):
    """A record of a pendulum as an engineer has it: blanks, degrees, milliseconds, time not from 0."""
    length, mass = 0.8, 1.5
    inertia = mass * length**2 / 3
    times = np.arange(0, 6, 0.02)

    def rates(_: float, state: np.ndarray) -> list[float]:
        return [state[1], -(mass * 9.81 * length / 2 * np.sin(state[0]) + DRAG * state[1]) / inertia]

    motion = solve_ivp(rates, (0, 6), [np.deg2rad(ANGLE), 0.0], t_eval=times, rtol=1e-10, atol=1e-12)
    angles = np.rad2deg(motion.y[0]) + np.random.default_rng(4).normal(0, 0.1, len(times))
    rows = [f"{1500 + 1000 * time:9.0f} {angle:10.3f}" for time, angle in zip(times, angles, strict=True)]
    file = tmp_path_factory.mktemp("records") / "own pendulum.txt"
    file.write_text("\n".join(["% rig 7", " time_ms  angle_deg", *rows]) + "\n")
    return file


@pytest.fixture
def root(tmp_path):
    return tmp_path / "empty"


@pytest.fixture
def visit(chromium: Visitor, root):
    """Open pages of a studio for a folder."""
    root.mkdir()
    with running_studio(root) as address:
        yield opener(chromium, address)


class Hand:
    """Clicks, and counts them."""

    def __init__(self) -> None:
        self.clicks = 0

    def click(self, element: Locator) -> None:
        element.click()
        self.clicks += 1

    def choose_file(self, page: Page, element: Locator, file) -> None:
        """Click a field for files, and in the dialog of the system a file and Open."""
        with page.expect_file_chooser() as chooser:
            self.click(element)
        chooser.value.set_files(file)
        self.clicks += 2

    def choose(self, page: Page, menu: str, entry: str) -> None:
        """Choose an entry of a menu."""
        self.click(page.get_by_label(menu))
        self.click(page.get_by_role("option", name=entry, exact=True))
        wait_until(page, "!document.querySelector('.q-menu')")


def test_from_an_empty_folder_to_an_identified_pendulum(chromium, visit, root, own):
    page, hand = visit("/"), Hand()
    hand.click(page.get_by_role("link", name="New study").first)
    hand.click(page.get_by_role("button", name="Parameters from a measured motion"))
    hand.click(page.get_by_role("tab", name="Data"))
    page.get_by_label("Use of column x").wait_for()
    hand.choose_file(page, page.locator(".q-uploader__input").first, own)
    hand.choose(page, "Use of column angle_deg", "rod.start.angle (rad)")
    wait_until(page, f"{TEXT}.includes('The times begin at 1.5 s')")
    hand.click(page.get_by_role("button", name="Write into the study"))
    wait_until(page, f"{TEXT}.includes('The study has these choices')")
    hand.click(page.get_by_role("button", name="Estimate the offset"))
    wait_until(page, f"{TEXT}.includes('rod.start.angle offset from 300 samples')")
    hand.click(page.get_by_role("button", name="Run"))
    wait_until(page, "location.pathname.startsWith('/run/')")
    wait_until(page, f"{TEXT}.includes('finished') && Boolean(document.querySelector('iframe'))")
    (run,) = (root / "runs").iterdir()
    best = json.loads((run / "state.json").read_text())["best"]["values"]
    assert best["drag"] == pytest.approx(DRAG, rel=0.01)
    assert np.rad2deg(best["angle"]) == pytest.approx(ANGLE - 90, abs=0.2)
    assert np.rad2deg(best["rod.start.angle offset"]) == pytest.approx(90, abs=0.2)
    assert hand.clicks <= MOST_CLICKS
    assert hand.clicks == 11
    assert chromium.complaints == []


def test_columns_are_corrected_by_menus_and_problems_by_buttons(visit, root, tmp_path):
    study = begin("identify", root / "studies" / "drag")
    rows = [f"{10 * row};{20 + 700 * (row == 60) + np.cos(row / 9):.3f};{row}" for row in range(200)]
    rows[30] = "300;;30"
    (study.parent / "own.csv").write_text("\n".join(["a;b;c", *rows]))
    page = visit("/study/drag/drag")
    page.get_by_role("tab", name="Data").click()
    page.get_by_label("Use of column x").wait_for()
    hand = Hand()
    hand.choose(page, "Data file", "own.csv")
    hand.choose(page, "Use of column a", "times")
    hand.choose(page, "Use of column b", "rod.end.angle (rad)")
    hand.choose(page, "Unit of column b", "deg")
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
    while not page.get_by_label("Use of column angle_deg").is_visible():
        longest = max(longest, answer_time(other))
    hand = Hand()
    hand.choose(page, "Use of column angle_deg", "rod.start.angle (rad)")
    wait_until(page, f"{TEXT}.includes('The record has 1250000 samples')")
    page.get_by_role("button", name="Decimate").click()
    page.get_by_role("button", name="Write into the study").click()
    while "angle from 5000 samples" not in page.inner_text("body"):
        longest = max(longest, answer_time(other))
    assert longest < LONGEST_ANSWER
    assert (study.parent / "large.csv").stat().st_size == file.stat().st_size


def answer_time(page: Page) -> float:
    """Seconds until the studio answers a request for a page."""
    return page.evaluate(
        "async () => { const t = performance.now(); await fetch('/'); return (performance.now() - t) / 1000 }"
    )
