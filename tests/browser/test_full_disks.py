"""A full disk and a folder that is read-only: the studio says what to do, and the text stays on the page."""

import subprocess
import sys
from pathlib import Path

import pytest
from playwright.sync_api import Page

from browser.running_studio import ended, opener, start_studio
from browser.visitor import wait_until
from dalembert.study.template import begin

pytestmark = [pytest.mark.slow, pytest.mark.skipif(sys.platform != "linux", reason="Linux has small disks and rights.")]
TEXT = "(document.body?.innerText ?? '')"
ROOM = "see that the disk has room and that the folder may be written to, and try again"
SMALL = [
    "unshare",
    "--user",
    "--map-root-user",
    "--mount",
    "sh",
    "-c",
    'mount -t tmpfs -o size=8m none "$0" && exec "$@"',
]
DROP, ANY_FILE = 24, 1
"""PR_CAPBSET_DROP and CAP_DAC_OVERRIDE of Linux."""
BOUND = (
    f"import ctypes, os, sys; ctypes.CDLL(None).prctl({DROP}, {ANY_FILE}, 0, 0, 0); os.execv(sys.argv[1], sys.argv[1:])"
)
"""Binds a process to the rights of folders, though it be root's."""


@pytest.fixture
def small(tmp_path):
    """A studio whose folder is a disk of 8 MB of its own; its address, and its folder as others see it."""
    before = [*SMALL, str(tmp_path)]
    if subprocess.run([*before, "true"], capture_output=True, check=False).returncode:
        pytest.skip("this system does not let a process mount a disk of its own")
    process, address = start_studio(tmp_path, before=before)
    with process, ended(process):
        yield address, Path(f"/proc/{process.pid}/root{tmp_path}")


def fill(root: Path) -> Path:
    """Leave no room on a disk; return the file that takes it."""
    file = root / "filler"
    with file.open("wb", buffering=0) as filler:
        try:
            while True:
                filler.write(b"0" * 4096)
        except OSError:
            return file


def write_at_start(page: Page, line: str) -> None:
    page.locator(".cm-content").click()
    page.keyboard.press("Control+Home")
    page.keyboard.insert_text(f"{line}\n")
    wait_until(page, f"{TEXT}.includes('Save •')")


def click(page: Page, name: str) -> None:
    page.get_by_role("button", name=name).first.click()


def test_a_full_disk_loses_nothing(chromium, small, tmp_path_factory):
    address, root = small
    visit = opener(chromium, address)
    study = begin("motion", root / "studies" / "mine")
    before = study.read_text()
    page = visit("/study/mine/mine")
    wait_until(page, f"{TEXT}.includes('Valid.')")
    filler = fill(root)
    write_at_start(page, "# mine")
    click(page, "Save")
    wait_until(page, f"{TEXT}.includes('mine.toml cannot be written: No space left on device')")
    assert ROOM in page.inner_text("body")
    page.screenshot(path=tmp_path_factory.mktemp("full") / "save.png")
    assert study.read_text() == before
    assert page.evaluate("document.querySelector('.cm-content').innerText.startsWith('# mine')")
    page.evaluate("document.querySelector('.q-notification').dataset.former = ''")
    click(page, "Run")  # saves first: the same sentence in place of the former one
    fresh = "[...document.querySelectorAll('.q-notification:not([data-former])')].map((one) => one.innerText).join()"
    wait_until(page, f"{fresh}.includes('No space left on device')")
    assert page.url.endswith("/study/mine/mine")
    other = visit("/new")
    click(other, "A motion of a mechanism")
    wait_until(other, f"{TEXT}.includes('No space left on device')")
    assert [folder.name for folder in (root / "studies").iterdir()] == ["mine"]
    filler.unlink()
    click(page, "Save")
    wait_until(page, f"{TEXT}.includes('Saved.')")
    assert study.read_text() == f"# mine\n{before}"


def test_a_run_without_room_says_so_and_is_resumed(chromium, small, tmp_path_factory):
    address, root = small
    begin("motion", root / "studies" / "mine")
    (root / "runs").mkdir()
    page = opener(chromium, address)("/study/mine/mine")
    wait_until(page, f"{TEXT}.includes('Valid.')")
    filler = fill(root)
    with filler.open("rb+") as file:
        file.truncate(filler.stat().st_size - 60_000)  # room for what is given, not for the result
    click(page, "Run")
    wait_until(page, f"location.pathname === '/run/mine' && {TEXT}.includes('No space left on device')")
    page.screenshot(path=tmp_path_factory.mktemp("full") / "run.png")
    assert "see that the disk has room" in page.inner_text("body")
    filler.unlink()
    click(page, "Resume")
    wait_until(page, f"{TEXT}.includes('finished')")


def test_a_read_only_folder_loses_nothing(chromium, tmp_path):
    study = begin("motion", tmp_path / "studies" / "mine")
    before = study.read_text()
    for folder in (study.parent, tmp_path / "studies", tmp_path):
        folder.chmod(0o555)
    before_it = [sys.executable, "-c", BOUND]
    tried = [*before_it, sys.executable, "-c", "open('a', 'w')"]
    if subprocess.run(tried, cwd=tmp_path, capture_output=True, check=False).returncode == 0:
        pytest.skip("this system does not let go of root's right to write everywhere")
    process, address = start_studio(tmp_path, before=before_it)
    with process, ended(process):
        visit = opener(chromium, address)
        page = visit("/study/mine/mine")
        wait_until(page, f"{TEXT}.includes('Valid.')")
        click(page, "Run")  # there is nothing to save, and no folder for runs
        wait_until(page, f"{TEXT}.includes('Permission denied')")
        write_at_start(page, "# mine")
        click(page, "Save")
        wait_until(page, f"{TEXT}.includes('mine.toml cannot be written: Permission denied')")
        assert ROOM in page.inner_text("body")
        other = visit("/new")
        click(other, "A motion of a mechanism")
        wait_until(other, f"{TEXT}.includes('Permission denied') && {TEXT}.includes({ROOM!r})")
        study.parent.chmod(0o755)
        click(page, "Save")
        wait_until(page, f"{TEXT}.includes('Saved.')")
    assert study.read_text() == f"# mine\n{before}"
    assert chromium.complaints == []
