"""The sliders of a study: the picture follows the values, which can be written into the study."""

import re
import shutil
from pathlib import Path

import pytest
from playwright.sync_api import Locator, Page

from browser.running_studio import running_studio
from browser.visitor import wait_until
from dalembert.study import load
from dalembert.study.template import begin

pytestmark = pytest.mark.slow
TEXT = "(document.body?.innerText ?? '')"
NUMBER = "Number(document.querySelector('.player')?.dataset.number ?? 0)"
BODY = "document.querySelector('.player-body').getAttribute('d')"
CURVE = "[...document.querySelectorAll('.js-plotly-plot .scatterlayer .js-line')].map((one) => one.getAttribute('d'))"
DECAY = """
import ctypes
import time
import numpy as np
from dalembert.forward import PythonModel

TIMES = np.linspace(0.0, 1.0, 11)

def model(parameters):
    return PythonModel(response, parameters, ["x"], TIMES)

def response(rate):
    if rate > 3.0:
        ctypes.string_at(0)
    return np.exp(-rate * TIMES)
"""
CRASHING = """
[parameters]
rate = { lower = 0.01, upper = 10.0, start = 1.0, unit = "1/s" }
[model]
forward = "decay.py:model"
[sweep]
at = 0.5
channels = ["x"]
over = { rate = { count = 3 } }
"""


@pytest.fixture(scope="module")
def root(tmp_path_factory):
    folder = tmp_path_factory.mktemp("sliders")
    for name in ("pendulum", "written"):
        path = begin("identify", folder / "studies" / name)
        path.write_text(path.read_text().replace("start = 0.1, unit", "start = 0.1, unit", 1) + "# the end\n")
    shutil.copytree(Path(__file__).parents[2] / "studies" / "unknown-load", folder / "studies" / "unknown-load")
    crashing = folder / "studies" / "crashing"
    crashing.mkdir()
    (crashing / "study.toml").write_text(CRASHING)
    (crashing / "decay.py").write_text(DECAY)
    return folder


@pytest.fixture(scope="module")
def address(root):
    with running_studio(root) as found:
        yield found


@pytest.fixture
def sliders(chromium, address):
    """Open the sliders of a study, until something is drawn."""

    def visit(name: str, drawn: str = f"{NUMBER} > 0 && {CURVE}.length > 3", **device) -> Page:
        page = chromium.page(**device)
        page.goto(f"{address}/study/{name}")
        page.get_by_role("tab", name="Sliders").click()
        wait_until(page, drawn)
        return page

    return visit


def way(page: Page, name: str) -> Locator:
    return page.locator(f'input[type=range][aria-label="{name}"]')


def value(page: Page, name: str) -> Locator:
    return page.get_by_label(f"Value of {name}")


def misfit(page: Page) -> float:
    return float(re.search(r"Misfit ([\d.e+-]+)", page.inner_text("main, [role=main]"))[1])


def test_the_picture_follows_a_slider_that_is_dragged(sliders, tmp_path):
    page = sliders("pendulum/pendulum")
    before, number, curves = misfit(page), page.evaluate(NUMBER), page.evaluate(CURVE)
    box = way(page, "drag").bounding_box()
    page.mouse.move(box["x"] + 0.1 * box["width"], box["y"] + box["height"] / 2)
    page.mouse.down()
    for step in range(11, 21):
        page.mouse.move(box["x"] + 0.01 * step * box["width"], box["y"] + box["height"] / 2)
    page.mouse.up()
    wait_until(page, f"{NUMBER} > {number}")
    wait_until(page, "document.querySelectorAll('.effect').length === 4")
    assert float(value(page, "drag").input_value()) == pytest.approx(0.2, abs=0.02)
    wait_until(page, f"JSON.stringify({CURVE}) !== {page.evaluate(f'JSON.stringify(JSON.stringify({curves}))')}")
    assert misfit(page) < before
    page.screenshot(path=tmp_path / "sliders.png")


def test_the_mechanism_plays_after_a_change(sliders):
    page = sliders("pendulum/pendulum")
    wait_until(page, "document.querySelector('.player button').getAttribute('aria-label') === 'Play'")
    number, shown = page.evaluate(NUMBER), page.evaluate(BODY)
    way(page, "angle").focus()
    page.keyboard.press("PageUp")
    wait_until(page, f"{NUMBER} > {number}")
    wait_until(page, "document.querySelector('.player button').getAttribute('aria-label') === 'Pause'")
    page.locator(".player button").press("Enter")
    wait_until(page, "document.querySelector('.player button').getAttribute('aria-label') === 'Play'")
    page.locator(".player input").focus()
    page.keyboard.press("Home")
    assert page.locator(".player output").inner_text() == "t = 0.00 s"
    assert page.evaluate(BODY) != shown


def test_numbers_are_typed_with_a_decimal_comma_or_a_unit(sliders):
    page = sliders("written/written")
    value(page, "drag").fill("0,25")
    value(page, "drag").press("Tab")
    wait_until(page, "document.querySelector('[aria-label=\"Value of drag\"]').value === '0.25'")
    value(page, "angle").fill("\N{MINUS SIGN}0,5 rad")
    value(page, "angle").press("Tab")
    wait_until(page, "document.querySelector('[aria-label=\"Value of angle\"]').value === '-28.6479'")
    number = page.evaluate(NUMBER)
    value(page, "angle").fill("3 kg")
    wait_until(page, f"{TEXT}.includes('is not a number in this unit. Enter a number such as 2.5, or 2.5 deg')")
    value(page, "angle").fill("1000")
    wait_until(page, f"{TEXT}.includes('Enter -')")
    page.get_by_role("button", name="Reset", exact=True).click()
    wait_until(page, f"{NUMBER} > {number}")
    assert value(page, "drag").input_value() == "0.1"


def test_values_are_typed_reset_and_written_into_the_study(sliders, root):
    page = sliders("written/written")
    path = root / "studies" / "written" / "written.toml"
    number = page.evaluate(NUMBER)
    value(page, "drag").fill("0.25")
    wait_until(page, f"{NUMBER} > {number}")
    page.get_by_label("Use drag").press("Enter")
    page.get_by_role("menuitem", name="Reset").click()
    wait_until(page, "document.querySelector('[aria-label=\"Value of drag\"]').value === '0.1'")
    value(page, "drag").fill("0.3")
    value(page, "angle").fill("-30")  # in the unit of the study
    wait_until(page, f"{NUMBER} > {number + 2}")
    page.get_by_role("button", name="Use as start").press("Enter")
    wait_until(page, "document.querySelector('.cm-content').innerText.includes('start = 0.3, unit')")
    page.get_by_label("Use angle").press("Enter")
    page.get_by_role("menuitem", name="Use as value").click()
    page.get_by_role("button", name="Save").click()
    wait_until(page, f"{TEXT}.includes('Saved.')")
    text = path.read_text()
    assert text.endswith("# the end\n")
    assert 'angle = { lower = "-30 deg", upper = "-30 deg" }' in text
    assert [item.start for item in load(path).parameters] == [0.3]


def test_many_parameters_leave_the_drawing_in_sight(sliders, tmp_path):
    page = sliders("unknown-load/identify", width=1400)
    assert page.locator("input[type=range]:visible").count() == 5  # with that of the time
    assert page.locator(".player").bounding_box()["y"] < 700
    before = misfit(page)
    page.get_by_text("96 more parameters").click()
    way(page, "push_30").wait_for(state="visible")  # what is hidden takes no focus, and no key
    way(page, "push_30").press("End")
    wait_until(page, f"!{TEXT}.includes('Misfit {before:.4g} (')")
    assert misfit(page) != before
    page.screenshot(path=tmp_path / "many.png")


def test_a_value_out_of_bounds_is_refused(sliders):
    page = sliders("pendulum/pendulum")
    curve = page.evaluate(CURVE)  # what appears late draws the same curve again
    value(page, "drag").fill("7")
    wait_until(page, f"{TEXT}.includes('Enter 0 to 1')")
    assert page.evaluate(CURVE) == curve


def test_a_model_that_crashes_ends_its_own_process_alone(sliders):
    page = sliders("crashing/study", f"{CURVE}.length === 1")
    way(page, "rate").focus()
    page.keyboard.press("End")
    wait_until(page, f"{TEXT}.includes('ended by the signal SIGSEGV. Check the Python functions')")
    curve = page.evaluate(CURVE)
    page.keyboard.press("Home")
    wait_until(page, f"JSON.stringify({CURVE}) !== JSON.stringify({curve})")
    wait_until(page, f"!{TEXT}.includes('SIGSEGV')")
    assert float(value(page, "rate").input_value()) == 0.01


@pytest.mark.parametrize("scheme", ["light", "dark"])
@pytest.mark.parametrize("width", [768, 390])
def test_the_sliders_fit_a_tablet_and_a_phone(sliders, tmp_path, width, scheme):
    page = sliders("pendulum/pendulum", width=width, height=1024, scheme=scheme)
    page.screenshot(path=tmp_path / f"{width}-{scheme}.png", full_page=True)
    assert page.evaluate("document.documentElement.scrollWidth") <= width
