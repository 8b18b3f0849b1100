"""From an empty folder to an identified pendulum with a record of one's own: by clicks and numbers, without TOML."""

import json

import numpy as np
import pytest
from playwright.sync_api import Page
from scipy.integrate import solve_ivp

from browser.running_studio import opener, running_studio
from browser.visitor import Visitor, wait_until

pytestmark = pytest.mark.slow
TEXT = "(document.body?.innerText ?? '')"
MOST_CLICKS = 25
LENGTH, MASS = 0.62, 0.9
"""Of the pendulum that was measured (m, kg): known, and not those of the template."""
DRAG, ANGLE, ZERO = 0.035, -35.0, 90.0
"""N m s; initial angle from the horizontal and zero of the sensor, which measures from the vertical (degrees)."""
NOISE = 0.15  # degrees
COUNTED = "addEventListener('pointerdown', (event) => event.isTrusted && clicked(event.target.innerText), true)"


@pytest.fixture(scope="module")
def record(tmp_path_factory):
    """A record as a data logger writes it: blanks, degrees, milliseconds, time not from 0."""
    inertia = MASS * LENGTH**2 / 3
    times = np.arange(0, 6, 0.02)

    def rates(_: float, state: np.ndarray) -> list[float]:
        return [state[1], -(MASS * 9.81 * LENGTH / 2 * np.cos(state[0]) + DRAG * state[1]) / inertia]

    motion = solve_ivp(rates, (0, 6), [np.deg2rad(ANGLE), 0.0], t_eval=times, rtol=1e-10, atol=1e-12)
    noise = np.random.default_rng(12).normal(0, NOISE, len(times))
    angles = np.rad2deg(motion.y[0]) + ZERO + noise
    rows = [f"{12000 + 1000 * time:9.0f} {angle:10.3f}" for time, angle in zip(times, angles, strict=True)]
    file = tmp_path_factory.mktemp("records") / "my pendulum (2).csv"
    file.write_text("\n".join(["% rig 7", " time_ms  angle_deg", *rows]) + "\n")
    return file


@pytest.fixture
def root(tmp_path):
    return tmp_path


@pytest.fixture
def start(chromium: Visitor, root):
    """The first page of a studio for an empty folder, and the clicks in it so far."""
    with running_studio(root) as address:
        page = opener(chromium, address)("/", height=1000)
        clicks: list[str] = []

        def clicked(text: str) -> None:
            clicks.append(text)

        page.expose_function("clicked", clicked)
        page.add_init_script(COUNTED)
        page.reload()
        wait_until(page, "window.did_handshake")
        yield page, clicks


def shows(page: Page, text: str) -> None:
    wait_until(page, f"{TEXT}.includes({text!r})")


def enter(page: Page, field: str, value: str) -> None:
    """Click into a field and replace its content."""
    page.get_by_label(field).click()
    page.keyboard.press("Control+a")
    page.keyboard.insert_text(value)
    page.keyboard.press("Enter")


def choose(page: Page, menu: str, entry: str) -> None:
    page.get_by_label(menu).click()
    page.get_by_role("option", name=entry, exact=True).click()
    wait_until(page, "!document.querySelector('.q-menu')")


def test_from_an_empty_folder_to_an_identified_pendulum(chromium, start, root, record, tmp_path_factory):
    page, clicks = start
    pictures = tmp_path_factory.mktemp("steps")

    def look(name: str) -> None:
        page.screenshot(path=pictures / f"{name}.png")

    look("1-empty")
    page.get_by_role("link", name="New study").first.click()
    page.get_by_role("button", name="Parameters from a measured motion").click()
    shows(page, "Valid.")
    page.locator("[data-part=rod]").first.click()
    look("2-study")
    page.get_by_role("tab", name="Forms").click()
    enter(page, "length", "620 mm")
    enter(page, "mass", "0.9 kg")
    wait_until(page, "/length = .620 mm/.test(document.querySelector('.cm-content').innerText)")
    look("3-form")
    page.get_by_role("tab", name="Data").click()
    page.get_by_label("Use of column x").wait_for()
    look("4-data")
    with page.expect_file_chooser() as chooser:
        page.get_by_role("button", name="Add measured data").click()
    chooser.value.set_files(record)
    page.get_by_label("Use of column angle_deg").wait_for()
    look("5-uploaded")
    choose(page, "Use of column angle_deg", "rod.start.angle (rad)")
    shows(page, "The times begin at 12 s")
    look("6-mapped")
    page.get_by_role("button", name="Write into the study").click()
    shows(page, "The study has these choices")
    look("7-written")
    page.get_by_role("button", name="Estimate the offset").click()
    shows(page, "rod.start.angle offset from 300 samples")
    look("8-offset")
    page.get_by_role("button", name="Run").click()
    wait_until(page, "location.pathname.startsWith('/run/')")
    look("9-running")
    wait_until(page, f"{TEXT}.includes('finished') && Boolean(document.querySelector('iframe'))")
    page.wait_for_timeout(1500)
    look("10-identified")
    (run,) = (root / "runs").iterdir()
    best = json.loads((run / "state.json").read_text())["best"]
    truth = {"drag": DRAG, "angle": np.deg2rad(ANGLE), "rod.start.angle offset": np.deg2rad(ZERO)}
    for name, value in truth.items():
        assert abs(best["values"][name] - value) < 3 * best["deviations"][name], (name, best)
    assert best["deviations"]["drag"] < 0.02 * DRAG
    assert len(clicks) <= MOST_CLICKS, clicks
    assert chromium.complaints == []
