"""Forms, completions and explanations beside the text of a study, with the mouse and the keyboard."""

import tomllib

import pytest
from playwright.sync_api import expect

from browser.running_studio import running_studio
from browser.visitor import PATIENCE, wait_until
from dalembert.study.template import begin

pytestmark = pytest.mark.slow
expect.set_options(timeout=PATIENCE)
ALIVE = "document.querySelector('.cm-content') && window.socket?.connected && window.did_handshake"


@pytest.fixture(scope="module")
def root(tmp_path_factory):
    return tmp_path_factory.mktemp("workspace")


@pytest.fixture(scope="module")
def address(root):
    with running_studio(root) as found:
        yield found


@pytest.fixture
def study(chromium, address, root, request):
    """A page with a pendulum, and its file."""
    name = request.node.name.removeprefix("test_")[:40]
    path = begin("motion", root / "studies" / name)
    page = chromium.page(width=1400)
    page.goto(f"{address}/study/{name}/{name}")
    wait_until(page, ALIVE)
    expect(page.get_by_text("Valid.")).to_be_visible()
    page.get_by_role("tab", name="Forms").click()
    yield page, path
    assert chromium.complaints == []


def saved(page, path) -> dict:
    """The study's file after Save."""
    page.get_by_role("button", name="Save").click()
    expect(page.get_by_text("Saved.").first).to_be_visible()
    return tomllib.loads(path.read_text(encoding="utf-8"))


def test_a_spring_and_a_parameter_by_forms(study):
    page, path = study
    before = path.read_text(encoding="utf-8")
    page.get_by_role("button", name="Add a force").click()
    page.locator(".q-menu").get_by_text("Spring", exact=True).click()
    expect(page.get_by_role("heading", name="Load 'load1'")).to_be_visible()
    page.get_by_label("a", exact=True).click()
    page.get_by_role("option", name="rod.end").click()
    page.get_by_label("b", exact=True).fill("ground(0.3, 0)")
    page.keyboard.press("Tab")
    page.get_by_label("stiffness, N/m").fill("2 kg")
    page.keyboard.press("Tab")
    message = page.locator(".q-field__messages", has_text="'2 kg' was given; expected a stiffness such as")
    expect(message).to_be_visible()
    expect(page.locator(".cm-line.wrong")).to_have_text('stiffness = "2 kg"')
    page.get_by_label("stiffness, N/m").fill("k")
    page.keyboard.press("Enter")
    page.get_by_role("button", name="Add a parameter").click()
    page.get_by_role("dialog").get_by_label("Name").fill("k")
    page.keyboard.press("Enter")
    page.get_by_label("upper", exact=True).fill("200 N/m")
    page.keyboard.press("Tab")
    expect(page.get_by_text("Valid.")).to_be_visible()
    document = saved(page, path)
    assert document["model"]["load"] == [
        {"kind": "Spring", "name": "load1", "a": "rod.end", "b": "ground(0.3, 0)", "stiffness": "k"}
    ]
    assert document["parameters"] == {"k": {"lower": 0.0, "upper": "200 N/m"}}
    lines = iter(path.read_text(encoding="utf-8").splitlines())
    assert all(line in lines for line in before.splitlines())  # in their order


def test_the_selected_table_is_edited_and_changes_are_undone(study):
    page, path = study
    page.locator(".cm-line", has_text="viscous =").click()
    expect(page.get_by_role("heading", name="Joint 'pin'")).to_be_visible()
    page.get_by_label("viscous, N*m*s").fill("0.4 N*m*s")
    page.keyboard.press("Tab")
    expect(page.locator(".cm-line", has_text="viscous =")).to_have_text('viscous = "0.4 N*m*s"')
    page.get_by_role("button", name="Undo").click()
    expect(page.get_by_label("viscous, N*m*s")).to_have_value("drag")
    page.get_by_role("button", name="Redo").click()
    expect(page.get_by_label("viscous, N*m*s")).to_have_value("0.4 N*m*s")
    page.get_by_role("button", name="Remove joint 'pin'").click()
    expect(page.locator(".cm-line", has_text="[[model.joint]]")).to_have_count(0)
    expect(page.get_by_text("Undo brings it back.")).to_be_visible()
    assert "met an error" not in page.inner_text("body")
    page.get_by_role("button", name="Undo").click()
    assert saved(page, path)["model"]["joint"][0]["viscous"] == "0.4 N*m*s"


def test_text_is_completed_and_explained(study):
    page, path = study
    page.locator(".cm-content").click()
    page.keyboard.press("Control+End")
    options = page.locator(".cm-tooltip-autocomplete li")

    def choose(typed: str, option: str) -> None:
        page.keyboard.type(typed, delay=20)
        expect(options.first).to_contain_text(option)
        page.wait_for_timeout(100)  # CodeMirror takes no key for 75 ms after the list has opened
        page.keyboard.press("Enter")

    choose("\n[[model.lo", "[[model.load]]")
    choose("\nki", "kind")
    choose('"Forc', "Force")
    page.keyboard.press("End")
    page.keyboard.type('\nname = "push"\nat = ')
    choose('"rod.en', "rod.end")
    page.keyboard.press("End")
    choose("\nfol", "follower")
    choose("tr", "true")
    page.locator(".cm-line", has_text="viscous =").get_by_text("viscous").hover()
    hint = page.locator(".study-hint")
    expect(hint).to_contain_text("viscous in N*m*s")
    expect(hint).to_contain_text("Friction torque per relative angular velocity")
    page.mouse.move(1300, 850)
    expect(hint).to_have_count(0)
    page.locator(".cm-line", has_text="[solver]").click()
    page.keyboard.press("Home")
    page.keyboard.press("ArrowDown")
    page.keyboard.press("F1")
    expect(hint).to_contain_text("step in s, required")
    page.keyboard.press("Escape")
    expect(hint).to_have_count(0)
    expect(page.get_by_text("Valid.")).to_be_visible()
    assert saved(page, path)["model"]["load"] == [{"kind": "Force", "name": "push", "at": "rod.end", "follower": True}]


def test_fast_typing_loses_nothing(study):
    page, path = study
    page.locator(".cm-line", has_text="A pendulum with").click()
    page.keyboard.press("End")
    words = " ".join(f"word{number}" for number in range(60))
    page.keyboard.type(f"\n# {words}", delay=5)
    page.keyboard.press("ArrowUp")
    page.wait_for_timeout(1000)
    saved(page, path)
    assert f"# {words}\n" in path.read_text(encoding="utf-8")
