"""Studies, files and runs whose names have blanks, signs and letters of every language: from creation to undo."""

import csv
import io
from urllib.parse import quote

import pytest
from playwright.sync_api import Page

from browser.running_studio import opener, running_studio
from browser.visitor import wait_until

pytestmark = pytest.mark.slow
TEXT = "(document.body?.innerText ?? '')"
NAMES = ["Pendel für 50 % (2)", "单摆 #1", "it's a..b & c=d; \u20ac+1"]
REFUSED = ["..", "a/b", 'say "hi"', "-rf", "摆" * 90]


@pytest.fixture(scope="module")
def root(tmp_path_factory):
    return tmp_path_factory.mktemp("names")


@pytest.fixture(scope="module")
def address(root):
    with running_studio(root) as found:
        yield found


@pytest.fixture
def visit(chromium, address):
    return opener(chromium, address)


def click(page: Page, name: str) -> None:
    page.get_by_role("button", name=name, exact=True).first.click()


def select(page: Page, name: str) -> None:
    row = page.locator(".ag-row", has=page.get_by_role("link", name=name, exact=True))
    row.locator("input[type=checkbox]").click()


@pytest.mark.parametrize("name", NAMES)
def test_a_name_is_good_for_everything(chromium, visit, root, name):
    page = visit("/new")
    page.locator("input[placeholder]").first.fill(name)
    page.get_by_role("button", name="Parameters from a measured motion").click()
    wait_until(
        page, f"decodeURIComponent(location.pathname) === {f'/study/{name}/study'!r} && {TEXT}.includes('Valid.')"
    )
    page.get_by_role("tab", name="Data").click()
    content = (root / "studies" / name / "motion.csv").read_bytes()
    page.get_by_label("Use of column x").wait_for()
    file = {"name": f"{name}.csv", "mimeType": "text/csv", "buffer": content}
    page.locator("input[type=file]").first.set_input_files(files=[file])
    wait_until(page, f"{TEXT}.includes({f'{name}.csv lies beside the study now'!r})")
    wait_until(page, f"{TEXT}.includes('Not yet in the study.')")
    click(page, "Write into the study")
    wait_until(page, f"{TEXT}.includes('The study has these choices.')")
    wait_until(page, f"{TEXT}.includes('Valid.')")
    click(page, "Run")
    wait_until(page, f"decodeURIComponent(location.pathname) === {f'/run/{name}'!r}")
    wait_until(page, f"{TEXT}.includes('finished') && Boolean(document.querySelector('iframe'))")
    with page.expect_download() as download:
        page.get_by_role("link", name="Result (NetCDF)").click()
    assert download.value.suggested_filename.endswith("result.nc")
    assert download.value.path().read_bytes() == (root / "runs" / name / "result.nc").read_bytes()

    page = visit("/studies")
    page.get_by_role("link", name=name).first.wait_for()
    page = visit("/")
    select(page, name)
    click(page, "Rename")
    page.get_by_label("New name").fill(f"{name} new")
    page.keyboard.press("Enter")
    page.get_by_role("link", name=f"{name} new", exact=True).wait_for()
    assert (root / "runs" / f"{name} new" / "result.nc").is_file()
    select_if_needed(page, f"{name} new")
    click(page, "Run again")
    again = name  # as the study, whose first run has another name now
    wait_until(page, f"decodeURIComponent(location.pathname) === {f'/run/{again}'!r} && {TEXT}.includes('finished')")

    page = visit("/")
    select(page, again)
    select(page, f"{name} new")
    click(page, "Compare")
    wait_until(page, "location.pathname === '/compare' && window.frames.length === 1")
    with page.expect_download() as download:
        page.get_by_role("link", name="Values (CSV)").click()
    rows = list(csv.reader(io.StringIO(download.value.path().read_text("utf-8"))))
    assert {again, f"{name} new"} <= {cell for row in rows for cell in row}

    page = visit("/")
    select(page, again)
    click(page, "Delete")
    wait_until(page, f"{TEXT}.includes({f'{again} is deleted.'!r})")
    assert not (root / "runs" / again).exists()
    click(page, "Undo")
    page.get_by_role("link", name=again, exact=True).wait_for()
    assert (root / "runs" / again / "result.nc").is_file()
    page = visit(f"/continue/{quote(again)}")
    page.get_by_label("Name of the new study").fill(f"{name} next")
    click(page, "Create the study")
    wait_until(page, f"decodeURIComponent(location.pathname) === {f'/study/{name} next/study'!r}")
    assert (root / "studies" / f"{name} next" / f"{name}.csv").is_file()
    assert chromium.complaints == []


def select_if_needed(page: Page, name: str) -> None:
    row = page.locator(".ag-row", has=page.get_by_role("link", name=name, exact=True))
    if not row.locator("input[type=checkbox]").is_checked():
        row.locator("input[type=checkbox]").click()


def test_refused_names_get_a_sentence(visit, root):
    page = visit("/new")
    for name in REFUSED:
        page.locator("input[placeholder]").first.fill(name)
        page.get_by_role("button", name="A motion of a mechanism").click()
        shown = page.get_by_role("alert").filter(has_text="cannot be a name here; expected at most 100 characters")
        shown.first.wait_for()
        click(page, "Close")
        wait_until(page, f"!{TEXT}.includes('cannot be a name here')")
    known = {entry.name for entry in (root / "studies").iterdir()} if (root / "studies").is_dir() else set()
    assert known <= {*NAMES, *(f"{name} next" for name in NAMES)}


def test_a_file_that_is_no_data_gets_a_sentence(visit, root):
    page = visit("/new")
    file = {"name": "a.toml.exe", "mimeType": "text/plain", "buffer": b"a = 1"}
    page.locator("input[type=file]").first.set_input_files(files=[file])
    wait_until(
        page, f"{TEXT}.includes('The file was not taken. Choose one of at most 200 MB whose name ends in .toml.')"
    )
