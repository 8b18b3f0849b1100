"""The table of runs: sorted, filtered, searched, renamed, deleted, restored, repeated and continued."""

import json
import shutil
import tomllib
from collections.abc import Callable

import pytest
from playwright.sync_api import Page

from browser.running_studio import opener, running_studio
from browser.visitor import wait_until
from dalembert.study import load, run_study
from dalembert.study.template import begin

pytestmark = pytest.mark.slow
STATE = {
    "state": "finished",
    "since": "2026-01-02T03:04:05+00:00",
    "message": "Converged.",
    "best": {"misfit": 0.5, "values": {"drag": 0.2}, "deviations": {"drag": 0.01}},
    "findings": [],
    "study": "swing",
    "title": "A swing",
    "task": "identify",
    "seconds": 7.5,
}
NAMES = "[...document.querySelectorAll('.ag-cell[col-id=run] a')].map((one) => one.innerText).join()"
TEXT = "(document.body?.innerText ?? '')"


@pytest.fixture(scope="module")
def kept(tmp_path_factory):
    """A folder with a finished run."""
    root = tmp_path_factory.mktemp("kept")
    run_study(load(begin("identify", root / "studies" / "pendulum")), root / "runs" / "pendulum")
    return root


@pytest.fixture(scope="module")
def workspace(tmp_path_factory):
    """A folder, and the address of a studio that works in it."""
    root = tmp_path_factory.mktemp("work")
    with running_studio(root) as address:
        yield root, address


@pytest.fixture
def root(workspace, kept):
    """The studio's folder with a finished run and two made-up ones."""
    folder = workspace[0]
    for name in ("runs", "studies"):
        shutil.rmtree(folder / name, ignore_errors=True)
        shutil.copytree(kept / name, folder / name)
    inputs = folder / "runs" / "pendulum" / "inputs.json"
    inputs.write_text(inputs.read_text().replace(str(kept), str(folder)))
    finding = {"code": "correlated-residuals", "severity": "warning", "message": "The residuals <b>are</b> correlated."}
    made = {"doubtful": {"findings": [finding]}, "stopped": {"state": "interrupted", "best": {}, "seconds": 0.01}}
    for name, differs in made.items():
        (folder / "runs" / name).mkdir()
        (folder / "runs" / name / "state.json").write_text(json.dumps(STATE | differs))
    return folder


@pytest.fixture
def visit(chromium, workspace):
    return opener(chromium, workspace[1])


@pytest.fixture
def page(root, visit):
    page = visit("/")
    wait_until(page, f"{NAMES}.split(',').length === 3")
    return page


def wait_for_files(page: Page, written: Callable[[], bool]) -> None:
    """Wait until files are as the page, which shows what is entered at once."""
    for _ in range(200):
        if written():
            return
        page.wait_for_timeout(50)


def choose(page: Page, name: str) -> None:
    """Select the row of a run."""
    page.locator(".ag-row", has_text=name).locator("input[type=checkbox]").first.click()


def focus(page: Page, name: str) -> None:
    """Focus the name of a run, beside its link."""
    page.locator(f".ag-cell[col-id=run]:has-text('{name}')").click(position={"x": 140, "y": 8})


def test_runs_are_sorted_and_searched_and_filtered(page):
    page.get_by_role("columnheader", name="Duration").click()
    wait_until(page, f"{NAMES}.startsWith('stopped,')")
    page.get_by_role("columnheader", name="Findings").click()
    page.get_by_role("columnheader", name="Findings").click()
    wait_until(page, f"{NAMES}.startsWith('doubtful,')")
    page.get_by_label("Search runs").fill("swing interrupted")
    wait_until(page, f"{NAMES} === 'stopped'")
    page.get_by_label("Search runs").fill("")
    wait_until(page, f"{NAMES}.split(',').length === 3")
    page.locator(".ag-header-cell[col-id=task] .ag-header-cell-filter-button").click()
    page.get_by_label("Filter Value").first.fill("nothing")
    wait_until(page, f"{NAMES} === ''")


def test_a_run_is_described_renamed_deleted_and_restored_by_keyboard(page, root):
    choose(page, "doubtful")
    wait_until(page, f"{TEXT}.includes('The residuals <b>are</b> correlated.')")
    choose(page, "doubtful")
    focus(page, "doubtful")
    page.keyboard.press("F2")
    page.keyboard.press("Control+a")
    page.keyboard.type("worn bearing")
    page.keyboard.press("Enter")
    wait_until(page, f"{NAMES}.includes('worn bearing')")
    wait_for_files(page, lambda: not (root / "runs" / "doubtful").exists())
    assert sorted(path.name for path in (root / "runs").iterdir()) == ["pendulum", "stopped", "worn bearing"]
    page.keyboard.press("Delete")
    wait_until(page, f"!{NAMES}.includes('worn bearing') && {TEXT}.includes('worn bearing is deleted.')")
    assert not (root / "runs" / "worn bearing").exists()
    page.get_by_role("button", name="Undo").press("Enter")
    wait_until(page, f"{NAMES}.includes('worn bearing')")
    assert (root / "runs" / "worn bearing" / "state.json").is_file()
    focus(page, "pendulum")
    page.keyboard.press("Enter")
    wait_until(page, "location.pathname === '/run/pendulum'")


def test_notes_and_tags_are_kept_beside_the_run(page, root):
    for field, text in (("note", "after the oil change"), ("tags", "rig 2, cold")):
        cell = page.locator(f".ag-row:has-text('stopped') .ag-cell[col-id={field}]")
        cell.scroll_into_view_if_needed()
        cell.dblclick()
        page.keyboard.type(text)
        page.keyboard.press("Enter")
        wait_until(page, f"{TEXT}.includes('{text}')")
    note = root / "runs" / "stopped" / "note.json"
    wait_for_files(page, lambda: "cold" in note.read_text())
    assert json.loads(note.read_text()) == {"note": "after the oil change", "tags": ["rig 2", "cold"]}


def test_deleted_runs_are_in_the_trash(page, root):
    choose(page, "stopped")
    choose(page, "doubtful")
    page.get_by_role("button", name="Delete").click()
    wait_until(page, f"{NAMES} === 'pendulum' && {TEXT}.includes('2 runs are deleted.')")
    page.get_by_role("button", name="Trash (2)").click()
    page.get_by_role("button", name="Restore stopped").click()
    wait_until(page, f"{NAMES}.includes('stopped')")
    page.get_by_role("button", name="Trash (1)").click()
    page.get_by_role("button", name="Remove all for good").click()
    wait_until(page, f"{TEXT}.includes('1 run removed.')")
    assert list((root / "runs" / ".trash").iterdir()) == []


def test_a_run_is_repeated(page, root):
    choose(page, "pendulum")
    page.get_by_role("button", name="Run again").click()
    wait_until(page, f"location.pathname === '/run/pendulum-2' && {TEXT}.includes('finished')")
    best = [
        json.loads((root / "runs" / name / "state.json").read_text())["best"] for name in ("pendulum", "pendulum-2")
    ]
    assert best[0] == best[1]


def test_the_page_of_a_run_leads_on(page, root):
    page.get_by_role("link", name="pendulum", exact=True).click()
    page.get_by_role("button", name="Run again").click()
    wait_until(page, f"location.pathname === '/run/pendulum-2' && {TEXT}.includes('finished')")
    page.get_by_role("button", name="Continue as a new study").click()
    wait_until(page, f"location.pathname === '/continue/pendulum-2' && {TEXT}.includes('start = 0.19')")
    page.go_back()
    page.get_by_role("button", name="Open the study").click()
    wait_until(page, f"location.pathname === '/study/pendulum/pendulum' && {TEXT}.includes('Valid.')")


def test_a_run_is_continued_from_its_values(page, root):
    choose(page, "pendulum")
    page.get_by_role("button", name="Continue as a new study").click()
    wait_until(page, f"location.pathname === '/continue/pendulum' && {TEXT}.includes('start = 0.19')")
    page.get_by_label("Name of the new study").fill("from there")
    page.get_by_role("button", name="Create the study").click()
    wait_until(page, "decodeURIComponent(location.pathname) === '/study/from there/study'")
    folder = root / "studies" / "from there"
    assert sorted(path.name for path in folder.iterdir() if path.suffix != ".json") == ["motion.csv", "study.toml"]
    given = tomllib.loads((folder / "study.toml").read_text())["parameters"]
    assert given["drag"]["start"] == pytest.approx(0.2, abs=1e-3)
    assert given["angle"]["start"].endswith(" deg")


def test_many_values_of_a_run_are_a_table(root, visit):
    state = json.loads((root / "runs" / "pendulum" / "state.json").read_text())
    state["best"] = {"misfit": 0.5, "values": {f"k{number}": float(number) for number in range(1, 17)}}
    (root / "runs" / "pendulum" / "state.json").write_text(json.dumps(state))
    page = visit("/run/pendulum")
    wait_until(page, f"{TEXT}.includes('misfit 0.5')")
    assert page.locator("dl[aria-label=Values] dt").all_inner_texts() == [f"k{number}" for number in range(1, 17)]


def test_dates_are_in_the_time_zone_of_the_browser(root, workspace, chromium):
    context = chromium.browser.new_context(timezone_id="Asia/Tokyo", viewport={"width": 1600, "height": 800})
    page = context.new_page()
    page.goto(workspace[1])
    wait_until(page, f"{TEXT}.includes('Date (Asia/Tokyo)') && {TEXT}.includes('2026-01-02 12:04')")
    context.close()


def test_a_name_that_is_refused_changes_nothing(page, root):
    choose(page, "pendulum")
    page.get_by_role("button", name="Rename").click()
    name = page.get_by_label("New name")
    name.fill("../up")
    page.keyboard.press("Enter")
    wait_until(page, f"{TEXT}.includes('cannot be a name here')")
    assert (root / "runs" / "pendulum").is_dir()
    assert name.input_value() == "../up"
    assert page.locator(".q-dialog [role=alert]").is_visible()
    name.fill("up")
    page.keyboard.press("Enter")
    wait_until(page, f"{NAMES}.includes('up') && !document.querySelector('.q-dialog')")
    assert (root / "runs" / "up").is_dir()


@pytest.mark.parametrize("scheme", ["light", "dark"])
def test_a_message_goes_when_the_action_succeeds(root, visit, scheme):
    page = visit("/", scheme=scheme)
    wait_until(page, f"{NAMES}.split(',').length === 3")
    for name, is_taken in (("pendulum", True), ("pendulum 2", False)):
        focus(page, "doubtful")
        page.keyboard.press("F2")
        page.keyboard.press("Control+a")
        page.keyboard.type(name)
        page.keyboard.press("Enter")
        wait_until(page, f"{TEXT}.includes('choose another name') === {str(is_taken).lower()}")
        if is_taken:
            close = page.locator(".q-notification").get_by_role("button", name="Close")
            assert close.evaluate("one => getComputedStyle(one).color") == "rgb(255, 255, 255)"
            ground = page.locator(".q-notification").evaluate("one => getComputedStyle(one).backgroundColor")
            assert ground == "rgb(193, 0, 21)"
    wait_until(page, f"{NAMES}.includes('pendulum 2')")
