"""A text that is not saved: leaving its page asks first, and it outlives the connection, the page and the studio."""

from pathlib import Path

import pytest
from playwright.sync_api import Dialog, Page

from browser.running_studio import start_studio
from browser.visitor import wait_until
from dalembert.study.template import begin

pytestmark = pytest.mark.slow
TEXT = "(document.body?.innerText ?? '')"
BACK = "The unsaved text of this tab is back."


class Studio:
    """A studio that can be killed and started again at the same address."""

    def __init__(self, root: Path) -> None:
        self.root = root
        self.process, self.address = start_studio(root)

    def kill(self) -> None:
        self.process.kill()
        self.process.communicate()

    def start(self) -> None:
        self.process, _ = start_studio(self.root, self.address.rpartition(":")[2])


@pytest.fixture
def studio(tmp_path):
    begin("motion", tmp_path / "studies" / "mine")
    running = Studio(tmp_path)
    yield running
    running.process.terminate()
    running.process.communicate()


@pytest.fixture
def page(chromium, studio):
    """The page of a study, with a line that is not saved."""
    page = chromium.page()
    page.goto(f"{studio.address}/study/mine/mine")
    wait_until(page, f"{TEXT}.includes('Valid.')")
    add(page, "# not saved")
    wait_until(page, f"{TEXT}.includes('Save •')")
    return page


def add(page: Page, line: str) -> None:
    """Add a line at the start of the text."""
    page.locator(".cm-content").click()
    page.keyboard.press("Control+Home")
    page.keyboard.insert_text(f"{line}\n")


def has(line: str) -> str:
    return f"(document.querySelector('.cm-content')?.innerText ?? '').includes({line!r})"


def test_leaving_asks_first_and_the_text_is_there_on_return(page):
    asked: list[Dialog] = []
    page.once("dialog", lambda dialog: (asked.append(dialog), dialog.dismiss()))
    page.get_by_role("link", name="Runs").click(no_wait_after=True)
    page.wait_for_timeout(500)
    assert [dialog.type for dialog in asked] == ["beforeunload"]
    assert "/study/" in page.url
    assert page.evaluate(has("# not saved"))
    page.once("dialog", lambda dialog: dialog.accept())
    page.get_by_role("link", name="Runs").click()
    wait_until(page, "location.pathname === '/'")
    page.go_back()
    wait_until(page, f"{has('# not saved')} && {TEXT}.includes({BACK!r})")
    page.get_by_label("Undo").click()
    wait_until(page, f"!{has('# not saved')} && !{TEXT}.includes('Save •')")


def test_a_saved_text_is_left_without_a_question(page):
    page.on("dialog", lambda dialog: pytest.fail(dialog.type))
    page.get_by_role("button", name="Save").click()
    wait_until(page, f"{TEXT}.includes('Saved.')")
    page.get_by_role("link", name="Runs").click()
    wait_until(page, "location.pathname === '/'")
    page.go_back()
    wait_until(page, f"{has('# not saved')} && {TEXT}.includes('Valid.')")
    assert BACK not in page.inner_text("body")


def test_a_run_saves_and_is_shown_without_a_question(page, studio):
    page.on("dialog", lambda dialog: pytest.fail(dialog.type))
    page.get_by_role("button", name="Run").click()
    wait_until(page, "location.pathname === '/run/mine'")
    assert (studio.root / "studies" / "mine" / "mine.toml").read_text().startswith("# not saved\n")


def test_a_text_outlives_the_connection(page, studio):
    identity = page.evaluate("window.documentId")
    page.evaluate("window.socket.io.engine.close()")
    add(page, "# typed without a connection")
    wait_until(page, "window.socket.connected")
    page.get_by_role("button", name="Save").click()
    wait_until(page, f"{TEXT}.includes('Saved.')")
    assert page.evaluate("window.documentId") == identity
    text = (studio.root / "studies" / "mine" / "mine.toml").read_text()
    assert text.startswith("# typed without a connection\n# not saved\n")


def test_a_text_outlives_the_studio(page, studio):
    asked: list[Dialog] = []
    page.on("dialog", lambda dialog: (asked.append(dialog), dialog.accept()))
    file = studio.root / "studies" / "mine" / "mine.toml"
    before, identity = file.read_text(), page.evaluate("window.documentId")
    studio.kill()
    wait_until(page, f"{TEXT}.includes('Connection lost.')")
    add(page, "# typed without a studio")
    studio.start()
    wait_until(page, f"window.documentId !== {identity!r} && {TEXT}.includes({BACK!r})")
    assert page.evaluate(has("# typed without a studio"))
    assert page.evaluate(has("# not saved"))
    assert file.read_text() == before
    assert asked == []
    page.get_by_role("button", name="Save").click()
    wait_until(page, f"{TEXT}.includes('Saved.')")
    assert file.read_text() == f"# typed without a studio\n# not saved\n{before}"


def test_a_file_that_was_changed_meanwhile_is_not_overwritten(page, studio, tmp_path_factory):
    file = studio.root / "studies" / "mine" / "mine.toml"
    studio.kill()
    file.write_text(f"# theirs\n{file.read_text()}")
    studio.start()
    wait_until(page, f"{TEXT}.includes('the text here has changes too. Nothing was overwritten.')")
    page.screenshot(path=tmp_path_factory.mktemp("kept") / "changed.png")
    assert page.evaluate(has("# not saved"))
    page.get_by_role("button", name="Save", exact=False).first.click()
    wait_until(page, f"{TEXT}.includes('was not overwritten')")
    assert file.read_text().startswith("# theirs\n")
    page.get_by_role("button", name="Save as a copy").click()
    wait_until(page, f"location.pathname === '/study/mine/mine-2' && {TEXT}.includes('Valid.')")
    assert file.with_name("mine-2.toml").read_text().startswith("# not saved\n")
