"""The studio without a pointer: each page is walked through by Tab, and a study is built and run by keys."""

import re
import tomllib

import pytest
from playwright.sync_api import Page

from browser.running_studio import opener, running_studio
from browser.studio_pages import PAGES, filled
from browser.visitor import wait_until
from dalembert.study.template import begin

pytestmark = pytest.mark.slow
TEXT = "(document.body?.innerText ?? '')"
MOST_STOPS = 150
FOCUSED = """() => {
    const one = document.activeElement;
    if (!one || one === document.body) return null;
    window.stops ??= new Map();
    if (!window.stops.has(one)) window.stops.set(one, window.stops.size);
    const text = one.cloneNode(true);
    text.querySelectorAll?.('.q-icon').forEach((icon) => icon.remove());
    const look = getComputedStyle(one), field = one.closest('.q-field--focused, .cm-focused, .ag-root, iframe');
    const outlined = look.outlineStyle !== 'none' && parseFloat(look.outlineWidth) > 0;
    const visible = Boolean(field) || outlined || look.boxShadow !== 'none';
    const name = one.ariaLabel || one.labels?.[0]?.innerText || text.textContent || one.title || one.tagName;
    return { number: window.stops.get(one), visible, frame: one.tagName === 'IFRAME', name: name.trim().slice(0, 80) };
}"""


@pytest.fixture(scope="module")
def workspace(tmp_path_factory):
    """A folder with studies and runs, and the address of its studio."""
    with filled(tmp_path_factory.mktemp("keys")) as root, running_studio(root) as address:
        yield root, address


@pytest.fixture
def visit(chromium, workspace):
    return opener(chromium, workspace[1])


def stop(page: Page) -> dict | None:
    """What has the focus: its number in the order of the first visits, its name, and whether the focus can be seen."""
    return page.evaluate(FOCUSED)


def move(page: Page) -> dict | None:
    """Press Tab; Escape before it leaves the text of a study."""
    if page.evaluate("Boolean(document.activeElement?.closest('.cm-editor'))"):
        page.keyboard.press("Escape")
    page.keyboard.press("Tab")
    return stop(page)


def tab_to(page: Page, name: str) -> None:
    """Press Tab until something with a name has the focus, which can be seen there."""
    for _ in range(MOST_STOPS):
        found = move(page)
        if found is not None and re.match(rf"{re.escape(name)}\b", found["name"].strip()):
            assert found["visible"], found
            return
    raise AssertionError(f"Tab does not reach {name!r}")


WALKED = [one for one in PAGES if one.act is None and one.name not in ("report", "comparison")]


@pytest.mark.parametrize("shown", WALKED, ids=lambda shown: shown.name)
def test_tab_moves_through_a_page_and_out_of_it(visit, shown):
    page = visit(shown.path)
    shown.show(page)
    stops = []
    for _ in range(MOST_STOPS):
        found = move(page)
        if found is None or (found["number"] == 0 and stops):
            break
        stops.append(found)
    else:
        raise AssertionError(f"Tab does not leave the page: {[one['name'] for one in stops[-5:]]}")
    assert stops[0]["name"] == "Skip to the content"
    assert [one["name"] for one in stops if not one["visible"]] == []
    numbers = [one["number"] for one in stops if not one["frame"]]
    assert numbers == sorted(set(numbers))


def test_a_dialog_closes_by_escape_and_the_focus_returns(visit):
    page = visit("/study/identify/identify")
    open_panel(page, "Forms")
    tab_to(page, "Add a parameter")
    page.keyboard.press("Enter")
    wait_until(page, "document.activeElement.closest('[role=dialog]') !== null")
    page.keyboard.press("Escape")
    wait_until(page, "document.activeElement.ariaLabel === 'Add a parameter'")
    tab_to(page, "Add a body")
    page.keyboard.press("Enter")
    wait_until(page, "document.activeElement.closest('[role=menu]') !== null")
    page.keyboard.press("Escape")
    wait_until(page, "document.activeElement.ariaLabel === 'Add a body'")


def open_panel(page: Page, name: str) -> None:
    """Go to the tabs, and to one of them by arrow keys."""
    wait_until(page, f"{TEXT}.includes('Valid.')")
    for _ in range(MOST_STOPS):
        move(page)
        if page.evaluate("document.activeElement.getAttribute('role') === 'tab'"):
            break
    for _ in range(4):
        if name in (stop(page) or {"name": ""})["name"]:
            break
        page.keyboard.press("ArrowRight")
    page.keyboard.press("Enter")
    wait_until(page, f"document.querySelector('[role=tab][aria-selected=true]').innerText.includes({name!r})")


def test_a_study_is_built_and_run_by_keys(visit, workspace):
    root, _ = workspace
    file = begin("identify", root / "studies" / "keys")
    page = visit("/study/keys/keys")
    open_panel(page, "Forms")
    tab_to(page, "Add a body")
    page.keyboard.press("Enter")
    wait_until(page, "document.activeElement.closest('[role=menu]') !== null")
    for _ in range(20):
        page.keyboard.press("ArrowDown")
        if page.evaluate("document.activeElement.innerText").startswith("PointMass"):
            break
    page.keyboard.press("Enter")
    wait_until(page, f"{TEXT}.includes('Body \\'body1\\'')")
    tab_to(page, "mass")
    page.keyboard.type("2 kg")
    page.keyboard.press("Enter")
    wait_until(page, "document.querySelector('.cm-content').innerText.includes('2 kg')")
    tab_to(page, "Save")
    page.keyboard.press("Enter")
    wait_until(page, f"{TEXT}.includes('Saved.')")
    assert tomllib.loads(file.read_text())["model"]["body"][1]["mass"] == "2 kg"


def test_a_slider_is_moved_a_column_mapped_and_the_study_run_by_keys(visit, workspace):
    root, _ = workspace
    file = begin("identify", root / "studies" / "keyed")
    page = visit("/study/keyed/keyed")
    open_panel(page, "Sliders")
    tab_to(page, "drag")
    before = page.evaluate("document.activeElement.ariaValueText")
    for _ in range(3):
        page.keyboard.press("ArrowRight")
    wait_until(page, f"document.activeElement.ariaValueText !== {before!r}")
    tab_to(page, "Use as start")
    page.keyboard.press("Enter")
    wait_until(page, "!document.querySelector('.cm-content').innerText.includes('start = 0.1,')")
    open_panel(page, "Data")
    tab_to(page, "Use of column x")
    page.keyboard.press("ArrowDown")
    wait_until(page, "Boolean(document.querySelector('[role=listbox] [role=option]'))")
    page.keyboard.press("ArrowDown")
    page.keyboard.press("Enter")
    tab_to(page, "Write into the study")
    page.keyboard.press("Enter")
    wait_until(page, f"{TEXT}.includes('The study has these choices')")
    tab_to(page, "Save")
    page.keyboard.press("Enter")
    wait_until(page, f"{TEXT}.includes('Saved.')")
    document = tomllib.loads(file.read_text())
    assert document["parameters"]["drag"]["start"] > 0.1
    assert "rod.end.x" not in document["data"]["columns"]
    tab_to(page, "Run")
    page.keyboard.press("Enter")
    wait_until(page, f"location.pathname === '/run/keyed' && {TEXT}.includes('finished')")
    assert (root / "runs" / "keyed" / "result.nc").is_file()
