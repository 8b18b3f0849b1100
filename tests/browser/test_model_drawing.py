"""The model drawn beside its text: it follows the text, and each shows what is selected in the other."""

import re

import pytest
from playwright.sync_api import Page

from browser.running_studio import running_studio
from browser.visitor import wait_until
from dalembert.study.template import begin

pytestmark = pytest.mark.slow
DRAWING = "document.querySelector('.model-drawing')"
CURSOR = "document.querySelector('.cm-activeLine')?.innerText"


@pytest.fixture(scope="module")
def root(tmp_path_factory):
    folder = tmp_path_factory.mktemp("drawings")
    for template in ("identify", "response", "spatial"):
        begin(template, folder / "studies" / template)
    return folder


@pytest.fixture(scope="module")
def address(root):
    with running_studio(root) as found:
        yield found


@pytest.fixture
def visit(chromium, address):
    """Open a study, until its model is drawn."""

    def visit(name, **device) -> Page:
        page = chromium.page(**device)
        page.goto(f"{address}/study/{name}/{name}")
        wait_until(page, f"{DRAWING}?.querySelector('[data-part]')")
        return page

    return visit


def parts(page, role: str) -> list[str]:
    """Names of the parts of a role in the drawing."""
    return page.evaluate(f"[...{DRAWING}.querySelectorAll('g.{role}')].map((part) => part.dataset.part)")


def chosen(page) -> list[str]:
    return page.evaluate(f"[...{DRAWING}.querySelectorAll('g.chosen')].map((part) => part.dataset.part)")


def line_of(page, start: str):
    return page.locator(".cm-line", has_text=re.compile(f"^{re.escape(start)}")).first


def write(page, start: str, text: str) -> None:
    """Replace a line of the text."""
    line_of(page, start).click()
    page.keyboard.press("End")
    page.keyboard.press("Shift+Home")
    page.keyboard.insert_text(text)


def test_the_drawing_follows_the_text(chromium, visit):
    page = visit("identify")
    assert {role: parts(page, role) for role in ("body", "joint", "channel", "gravity")} == {
        "body": ["rod"],
        "joint": ["pin"],
        "channel": ["rod.end.x"],
        "gravity": ["gravity"],
    }
    shape = f"{DRAWING}.querySelector('g.body path').getAttribute('d')"
    before = page.evaluate(shape)
    write(page, "length", 'length = "500 mm"')
    wait_until(page, f"{shape} !== '{before}'")
    shorter = page.evaluate(shape)
    page.keyboard.press("Control+z")
    wait_until(page, f"{shape} === '{before}'")
    page.keyboard.press("Control+y")
    wait_until(page, f"{shape} === '{shorter}'")
    assert chromium.complaints == []


def test_a_part_selects_its_table_and_a_table_its_part(visit):
    page = visit("identify")
    page.locator("g.body[data-part=rod]").click()
    wait_until(page, f"{CURSOR} === '[[model.body]]'")
    assert chosen(page) == ["rod"]
    marked = page.evaluate("[...document.querySelectorAll('.cm-line.chosen')].map((line) => line.innerText)")
    assert marked[:3] == ["[[model.body]]", 'kind = "RigidBar"', 'name = "rod"']
    line_of(page, "viscous").click()
    wait_until(page, f"{DRAWING}.querySelector('g.joint').classList.contains('chosen')")
    assert chosen(page) == ["pin"]
    page.keyboard.press("PageDown")  # to the end of the text
    wait_until(page, f"{DRAWING}.querySelectorAll('.chosen').length === 0")
    page.locator("g.channel").focus()
    page.keyboard.press("Enter")
    wait_until(page, f"{CURSOR} === '[data]'")


def test_what_the_import_of_a_robot_left_out_stands_above_the_text(root, visit):
    folder = root / "studies" / "arm"
    text = (begin("robot", folder).parent / "robot.urdf").read_text()
    (folder / "robot.urdf").write_text(text.replace('type="revolute"', 'type="floating"', 1))
    (folder / "arm.toml").write_text(
        '[model]\nspace = true\nrobot = { file = "robot.urdf" }\n[solver]\nstep = "1 ms"\n[simulate]\nend = 0.1\n'
    )
    page = visit("arm")
    item = page.get_by_role("listitem").filter(has_text="is floating, which is not supported")
    item.locator("[aria-label=warning]").wait_for(timeout=60_000)


def test_a_mistake_is_marked_in_the_text_and_in_the_drawing(visit):
    page = visit("identify")
    write(page, "b =", 'b = "rod.strat"')
    wait_until(page, "document.querySelector('.cm-line.wrong')?.innerText === 'b = \"rod.strat\"'")
    wait_until(page, f"{DRAWING}.querySelector('g.joint').classList.contains('wrong')")
    assert "The drawing shows the last valid text." in page.inner_text("body")
    page.keyboard.press("Control+z")
    wait_until(page, f"{DRAWING}.querySelectorAll('.wrong').length === 0")


def test_structures_and_mechanisms_in_space_are_drawn(chromium, visit):
    page = visit("response")
    assert {role: parts(page, role) for role in ("body", "spring", "contact", "force")} == {
        "body": ["m"],
        "spring": ["m – ground"],
        "contact": ["slider"],
        "force": ["m"],
    }
    page.locator("g.contact").click(force=True)  # beside its thin lines
    wait_until(page, f"{CURSOR} === '[[model.contact]]'")
    assert chromium.complaints == []


def test_a_mechanism_in_space_is_turned_and_its_parts_are_chosen(chromium, visit):
    page = visit("spatial")
    for name in ("body plate", "joint wire1", "joint wire2", "joint wire3", "load air", "gravity gravity"):
        wait_until(page, f"document.querySelector('.model-space button[aria-label=\"{name}\"]')")
    page.locator(".model-space button", has_text=re.compile("^wire2$")).focus()
    page.keyboard.press("Enter")
    wait_until(page, f"{CURSOR} === '[[model.joint]]'")
    line_of(page, 'name = "wire3"').click()
    wait_until(page, "document.querySelector('.model-space button.chosen')?.innerText === 'wire3'")
    page.locator(".model-space canvas").click(position={"x": 3, "y": 3})  # beside all parts
    wait_until(page, "!document.querySelector('.model-space button.chosen')")
    where = "[...document.querySelectorAll('.model-space span')].map((one) => one.getBoundingClientRect().x | 0).join()"
    before = page.evaluate(where)
    page.locator(".model-space").focus()
    page.keyboard.press("ArrowLeft")
    wait_until(page, f"{where} !== '{before}'")
    assert [one for one in chromium.complaints if "GPU stall" not in one] == []


def test_the_drawing_is_enlarged_and_fits_again(visit):
    page = visit("identify")
    view = f"{DRAWING}.firstElementChild.getAttribute('viewBox')"
    whole = page.evaluate(view)
    page.locator("[aria-label='Enlarge the drawing']").click()
    wait_until(page, f"{view} !== '{whole}'")
    page.locator("[aria-label='Show all of the drawing']").click()
    wait_until(page, f"{view} === '{whole}'")


def test_a_part_that_is_not_drawn_is_a_link_to_its_table(visit):
    page = visit("response")
    line_of(page, "[[model.force]]").click()
    page.keyboard.press("Home")
    page.keyboard.insert_text('[[model.force]]\ndof = "m"\namplitude = "2 N"\nharmonic = 3\n\n')
    link = page.get_by_role("button", name="force m (2)")
    link.focus()
    page.keyboard.press("Enter")
    wait_until(page, f"{CURSOR} === '[[model.force]]'")
    wait_until(page, "document.querySelector('.model-part').getAttribute('aria-pressed') === 'true'")
    line_of(page, "[[model.contact]]").click()
    wait_until(page, "document.querySelector('.model-part').getAttribute('aria-pressed') === 'false'")
    assert chosen(page) == ["slider"]
