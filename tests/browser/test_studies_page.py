"""The studies as cards: pictures, search, the state of the last run, and templates."""

import re
import shutil
import subprocess
from pathlib import Path

import pytest

from browser.running_studio import COMMAND, running_studio
from browser.visitor import wait_until
from dalembert.study.template import begin

pytestmark = pytest.mark.slow
STUDIES = Path(__file__).parents[2] / "studies"
DRAWN = """(images => images.length === 12 && images.every(image => image.complete && image.naturalWidth > 0))(
    [...document.querySelectorAll('img')])"""


@pytest.fixture(scope="module")
def root(tmp_path_factory):
    root = tmp_path_factory.mktemp("workspace")
    study = begin("identify", root / "studies" / "mine")
    subprocess.run([COMMAND, "run", study, "--out", root / "runs" / "first"], check=True)
    for name in ("duffing", "six-joint-robot", "flexible-four-bar"):
        shutil.copytree(STUDIES / name, root / "studies" / name)
    return root


@pytest.fixture(scope="module")
def address(root):
    with running_studio(root) as found:
        yield found


def open_studies(chromium, address, **device):
    page = chromium.page(**device)
    page.goto(f"{address}/studies")
    wait_until(page, "window.socket?.connected && window.did_handshake")
    return page


def test_cards_have_pictures_titles_and_states(chromium, address, tmp_path):
    page = open_studies(chromium, address, height=3000)
    wait_until(page, DRAWN)
    own, templates, examples = (page.get_by_role("list").nth(place) for place in range(3))
    assert own.get_by_role("listitem").count() == 1
    assert templates.get_by_role("listitem").count() == 8
    assert examples.get_by_role("listitem").count() == 3
    assert "finished" in own.inner_text()
    assert "Duffing oscillator: past the folds" in examples.inner_text()
    page.screenshot(path=tmp_path / "studies.png")
    assert chromium.complaints == []


def test_a_search_shows_what_has_its_words(chromium, address):
    page = open_studies(chromium, address)
    page.get_by_label("Search studies").fill("six-joint")
    wait_until(page, "document.querySelectorAll('[role=listitem]').length === 1")
    assert "inertial" in page.get_by_role("listitem").inner_text()


def test_a_search_finds_templates_too(chromium, address):
    page = open_studies(chromium, address)
    page.get_by_label("Search studies").fill("friction frequency")
    wait_until(page, "document.querySelectorAll('[role=listitem]').length === 1")
    assert page.get_by_role("heading", name="Templates").is_visible()
    assert page.get_by_role("button", name="A response over frequency, with friction").is_visible()


def test_a_template_begins_a_study_by_keyboard(chromium, address, root):
    page = open_studies(chromium, address, width=768)
    page.get_by_role("button", name="A response over frequency").focus()
    page.keyboard.press("Enter")
    wait_until(page, "location.pathname === '/study/response/study'")
    assert (root / "studies" / "response" / "study.toml").is_file()


def test_a_card_leads_to_its_study_and_its_run(chromium, address):
    page = open_studies(chromium, address)
    page.get_by_role("link", name="Parameters from a measured motion").click()
    wait_until(page, "location.pathname === '/study/mine/mine'")
    page.go_back()
    page.get_by_role("link", name=re.compile("^first, ")).click()
    wait_until(page, "location.pathname === '/run/first'")


def test_more_studies_are_shown_on_demand(chromium, address, root):
    for number in range(30):
        shutil.copytree(root / "studies" / "mine", root / "studies" / f"copy {number:02d}")
    page = open_studies(chromium, address)
    page.get_by_label("Search studies").fill("copy")
    wait_until(page, "document.querySelectorAll('[role=listitem]').length === 24")
    page.get_by_role("button", name="Show 6 of 6 more").click()
    wait_until(page, "document.querySelectorAll('[role=listitem]').length === 30")
