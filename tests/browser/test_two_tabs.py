"""A study that is open in two tabs, or changed by another program: nothing is overwritten, nothing is lost."""

import re
from pathlib import Path

import pytest
from playwright.sync_api import Page

from browser.running_studio import running_studio
from browser.visitor import wait_until
from dalembert.study.template import begin

pytestmark = pytest.mark.slow
TEXT = "(document.body?.innerText ?? '')"
CHANGED = "changed on disk, and the text here has changes too. Nothing was overwritten."


@pytest.fixture(scope="module")
def root(tmp_path_factory):
    return tmp_path_factory.mktemp("tabs")


@pytest.fixture(scope="module")
def address(root):
    with running_studio(root) as found:
        yield found


@pytest.fixture
def open_study(chromium, address, root):
    """Open a study in as many tabs as asked for; they come with its file."""

    def open_study(name: str, count: int = 1) -> tuple[Path, list[Page]]:
        file = begin("motion", root / "studies" / name)
        tabs = []
        for _ in range(count):
            page = chromium.page()
            page.goto(f"{address}/study/{name}/{name}")
            wait_until(page, f"{TEXT}.includes('Valid.')")
            tabs.append(page)
        return file, tabs

    return open_study


def write_at_start(page: Page, line: str) -> None:
    """Add a line at the start of the text, which is on the screen."""
    page.locator(".cm-content").click()
    page.keyboard.press("Control+Home")
    page.keyboard.insert_text(f"{line}\n")


def save(page: Page) -> None:
    page.locator("button", has_text="Save").first.click()


def click(page: Page, name: str) -> None:
    page.get_by_role("button", name=name).click()


def shown(text: str) -> str:
    return f"document.querySelector('.cm-content').innerText.includes({text!r})"


def test_fifty_edits_in_two_tabs_lose_nothing(chromium, open_study):
    file, tabs = open_study("fifty", 2)
    for number in range(50):
        mine, other = tabs[number % 2], tabs[1 - number % 2]
        write_at_start(mine, f"# edit {number}")
        mine.keyboard.press("Control+s")
        wait_until(other, shown(f"# edit {number}"))
    found = re.findall(r"# edit (\d+)", file.read_text())
    assert found == [str(number) for number in reversed(range(50))]
    assert chromium.complaints == []


def bring_in(page: Page, edit: str, file: Path) -> None:
    """Take the text of others and repeat an edit until it is in the file; it is never lost without a notice."""
    reloaded = False
    for _ in range(600):
        if edit in file.read_text():
            return
        if page.get_by_role("button", name="Reload").is_visible():
            assert page.evaluate(shown(edit))
            click(page, "Reload")
            wait_until(page, f"!{TEXT}.includes({CHANGED!r})")
            reloaded = True
        elif not page.evaluate(shown(edit)):
            assert reloaded or "Undo brings back" in page.inner_text("body")
            write_at_start(page, edit)
            page.keyboard.press("Control+s")
        page.wait_for_timeout(100)
    raise AssertionError(f"{edit} is not in the file")


def test_fifty_edits_at_once_lose_nothing_silently(chromium, open_study):
    file, tabs = open_study("at_once", 2)
    begun = file.read_text()
    for number in range(0, 50, 2):
        edits = [f"# edit {number}", f"# edit {number + 1}"]
        for tab, edit in zip(tabs, edits, strict=True):
            write_at_start(tab, edit)
        for tab in tabs:
            tab.keyboard.press("Control+s")
        for tab, edit in zip(tabs, edits, strict=True):
            bring_in(tab, edit, file)
        text = file.read_text()
        lines = text.removesuffix(begun).splitlines()
        assert text.endswith(begun)
        assert sorted(lines) == sorted(f"# edit {one}" for one in range(number + 2))
        for tab in tabs:
            wait_until(tab, f"{shown(edits[0])} && {shown(edits[1])}")
    assert chromium.complaints == []


def test_edits_at_once_are_kept_by_choice(open_study):
    file, (first, second) = open_study("both", 2)
    write_at_start(first, "# first")
    write_at_start(second, "# second")
    save(first)
    wait_until(second, f"{TEXT}.includes({CHANGED!r})")
    save(second)
    wait_until(second, f"{TEXT}.includes('changed on disk and was not overwritten')")
    assert "# first" in file.read_text()
    assert "# second" not in file.read_text()
    click(second, "Reload")
    wait_until(second, f"{shown('# first')} && !{shown('# second')}")
    second.locator("[aria-label=Undo]").click()
    wait_until(second, shown("# second"))
    write_at_start(first, "# third")
    save(first)
    wait_until(second, f"{TEXT}.includes({CHANGED!r})")
    click(second, "Keep mine")
    wait_until(second, f"!{TEXT}.includes({CHANGED!r})")
    save(second)
    wait_until(second, f"{TEXT}.includes('Saved.')")
    assert "# second" in file.read_text()


def test_a_copy_keeps_both(open_study, root):
    file, (page,) = open_study("copied")
    write_at_start(page, "# mine")
    wait_until(page, f"{TEXT}.includes('Save •')")
    file.write_text(f"# theirs\n{file.read_text()}")
    wait_until(page, f"{TEXT}.includes({CHANGED!r})")
    click(page, "Save as a copy")
    wait_until(page, f"location.pathname === '/study/copied/copied-2' && {TEXT}.includes('Valid.')")
    assert "# mine" in (file.parent / "copied-2.toml").read_text()
    assert file.read_text().startswith("# theirs\n")


def test_a_file_that_is_deleted_can_be_saved_again(open_study):
    file, (page,) = open_study("deleted")
    content = file.read_text()
    file.unlink()
    wait_until(page, f"{TEXT}.includes('was deleted or moved. Save writes it again.')")
    save(page)
    wait_until(page, f"!{TEXT}.includes('was deleted or moved')")
    assert file.read_text() == content
