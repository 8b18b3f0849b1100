"""The studio in a real browser: with the mouse, by keyboard, on a phone, and against what should not get in."""

import json
import os
import re
import subprocess
import urllib.error
import urllib.request

import pytest
from playwright.sync_api import Locator, Page

from browser.running_studio import COMMAND, running_studio
from browser.visitor import move_focus, wait_until
from dalembert.study.template import begin

pytestmark = pytest.mark.slow
TEXT = "(document.body?.innerText ?? '')"


@pytest.fixture(scope="module")
def root(tmp_path_factory):
    return tmp_path_factory.mktemp("workspace")


@pytest.fixture(scope="module")
def address(root):
    with running_studio(root) as found:
        yield found


@pytest.fixture(scope="module")
def known(root):
    """Runs "first" and "second" of a study "known"."""
    study = begin("identify", root / "studies" / "known")
    for name in ("first", "second"):
        subprocess.run([COMMAND, "run", study, "--out", root / "runs" / name], check=True)


@pytest.fixture
def visit(chromium, address):
    """Open a page of the studio, until it is alive."""

    def visit(path, **device):
        page = chromium.page(**device)
        page.goto(address + path)
        wait_until(page, "document.querySelector('[role=main]') && window.socket?.connected && window.did_handshake")
        return page

    return visit


def button(page: Page, text: str) -> Locator:
    return page.locator("button", has_text=re.compile(re.escape(text))).first


def link(page: Page, text: str) -> Locator:
    return page.locator("a", has_text=re.compile(f"^{re.escape(text)}$")).first


def tab(page: Page, text: str) -> Locator:
    return page.locator("[role=tab]", has_text=text)


def name_of_study(page: Page) -> Locator:
    return page.locator("input[placeholder]").first


def new_study(page: Page, name: str, template: str) -> None:
    """Make a study from a template, and wait until it is checked."""
    name_of_study(page).fill(name)
    button(page, template).click()
    wait_until(page, "location.pathname.startsWith('/study/')")
    wait_until(page, f"{TEXT}.includes('Valid.')")


def external(chromium, address):
    return [
        request for request in chromium.requests if not request.startswith((address, address.replace("http", "ws")))
    ]


def test_from_nothing_to_an_identified_parameter(chromium, visit, address, root):
    page = visit("/new")
    new_study(page, "drag", "Parameters from a measured motion")
    tab(page, "Data").click()
    wait_until(page, "document.querySelectorAll('.js-plotly-plot .trace').length === 2")
    button(page, "Run").click()
    wait_until(page, "location.pathname === '/run/drag'")
    wait_until(page, f"{TEXT}.includes('finished') && Boolean(document.querySelector('iframe'))")
    assert json.loads((root / "runs" / "drag" / "state.json").read_text())["best"]["values"]["drag"] == pytest.approx(
        0.2, abs=1e-3
    )
    link(page, "Runs").click()
    wait_until(page, f"location.pathname === '/' && {TEXT}.includes('drag = 0.199')")
    assert external(chromium, address) == []
    assert chromium.complaints == []


LONG = """
from pathlib import Path
import time
import numpy as np
from dalembert.forward import PythonModel

def slow(parameters):
    return PythonModel(response, parameters, ["x"], np.linspace(0, 1, 3))

def response(rate):
    if not (Path(__file__).parents[2] / "go").exists():
        time.sleep(0.05)
    return np.exp(-rate * np.linspace(0, 1, 3))
"""
SWEEP = """
[parameters]
rate = { lower = 0.5, upper = 2.0 }
[model]
forward = "slow.py:slow"
[sweep]
at = 0.5
channels = ["x"]
sensitivities = false
over = { rate = { count = 5000 } }
"""


def test_a_run_is_watched_stopped_and_resumed(visit, root):
    folder = root / "studies" / "long"
    folder.mkdir(parents=True)
    (folder / "slow.py").write_text(LONG)
    (folder / "study.toml").write_text(SWEEP)
    page = visit("/study/long/study")
    wait_until(page, f"{TEXT}.includes('Valid.')")
    button(page, "Run").click()
    wait_until(page, f"location.pathname === '/run/long' && /rate = .* of 5000/.test({TEXT})")
    button(page, "Stop").click()
    wait_until(page, f"{TEXT}.includes('interrupted')")
    (root / "runs" / "go").touch()  # a run that is resumed has its copy of the file in runs/long/inputs
    button(page, "Resume").click()
    wait_until(page, f"{TEXT}.includes('finished') && Boolean(document.querySelector('iframe'))")


def test_mistakes_stand_at_their_lines(visit):
    page = visit("/new")
    new_study(page, "wrong", "A motion of a mechanism")
    page.locator(".cm-line", has_text=re.compile("^mass")).first.click()
    page.keyboard.press("End")
    page.keyboard.insert_text("x")
    wait_until(page, f"{TEXT}.includes('1 error')")
    wait_until(page, "document.querySelector('.cm-line.wrong')?.innerText.startsWith('mass')")
    assert button(page, "Run").is_disabled()
    wait_until(page, "[...document.querySelectorAll('[role=alert]')].some((one) => one.innerText.includes('line '))")


def test_measured_data_are_taken_and_drawn_before_anything_runs(visit, root, tmp_path):
    page = visit("/new")
    new_study(page, "data", "Parameters from a measured motion")
    tab(page, "Data").click()
    (tmp_path / "mine.csv").write_text((root / "studies" / "data" / "motion.csv").read_text())
    page.locator("input[type=file]").first.set_input_files(tmp_path / "mine.csv")
    wait_until(page, f"{TEXT}.includes('mine.csv lies beside the study now')")
    assert (root / "studies" / "data" / "mine.csv").is_file()
    (tmp_path / "evil.py").write_text("")
    page.locator("input[type=file]").first.set_input_files(tmp_path / "evil.py")
    (tmp_path / "late.csv").write_text((tmp_path / "mine.csv").read_text())
    page.locator("input[type=file]").first.set_input_files(tmp_path / "late.csv")
    wait_until(page, f"{TEXT}.includes('late.csv lies beside the study now')")
    assert not (root / "studies" / "data" / "evil.py").exists()


def test_a_study_file_that_is_no_text_is_refused(visit, tmp_path, root):
    page = visit("/new")
    name_of_study(page).fill("latin")
    (tmp_path / "latin.toml").write_bytes(b"a = '\xff'")
    page.locator("input[type=file]").first.set_input_files(tmp_path / "latin.toml")
    wait_until(page, f"{TEXT}.includes('the file is not UTF-8 text')")
    assert not (root / "studies" / "latin").exists()


def test_a_name_with_a_script_is_refused_and_one_that_is_there_is_shown_as_text(visit, root):
    page = visit("/new")
    name_of_study(page).fill("<img src=x onerror=document.title='run'>")
    button(page, "A motion").click()
    wait_until(page, f"{TEXT}.includes('cannot be a name here')")
    nasty = root / "runs" / "<img src=x onerror=document.title='run'>"
    nasty.mkdir(parents=True)
    state = {"state": "failed", "task": "<b>bold</b>", "since": "2000-01-01T00:00:00+00:00"}
    (nasty / "state.json").write_text(json.dumps(state))
    page = visit("/")
    wait_until(page, f"{TEXT}.includes('onerror') && {TEXT}.includes('<b>bold</b>')")
    assert page.evaluate("document.title") == "Runs · dalembert"
    assert page.evaluate("document.images.length") == 0


def test_findings_are_in_the_list_and_beside_each_other(visit, known, root):
    state = json.loads((root / "runs" / "first" / "state.json").read_text())
    finding = {"code": "correlated-residuals", "severity": "warning", "message": "The residuals <b>are</b> correlated."}
    note = {"code": "few-samples", "severity": "note", "message": "There are few samples."}
    state["best"]["deviations"]["drag"] = None
    doubtful = root / "runs" / "doubtful"
    doubtful.mkdir()
    (doubtful / "state.json").write_text(json.dumps({**state, "findings": [finding, note]}))
    page = visit("/")
    wait_until(page, f"{TEXT}.includes('1 warning, 1 note')")
    page = visit("/compare?run=first&run=doubtful")
    rows = compared(page)
    assert re.fullmatch(r"[\d.]+", rows["drag (N*m*s)"][0]), rows
    assert re.fullmatch(r"[\d.]+", rows["drag (N*m*s)"][1]), rows
    assert rows["findings"][1] == "1 warning, 1 note"


def compared(page: Page) -> dict[str, list[str]]:
    """Cells of the table of a comparison by the names of its rows, once it is drawn."""
    wait_until(page, "window.frames.length === 1")
    inside = page.frames[1]
    wait_until(inside, "document.documentElement?.dataset.ready === 'yes'")
    script = "[...document.querySelectorAll('tr')].map((row) => [...row.children].map((one) => one.innerText))"
    rows = inside.evaluate(script)
    return {name.strip(): [cell.strip() for cell in cells] for name, *cells in rows}


def test_two_runs_side_by_side(chromium, visit, known, address):
    page = visit("/")
    for name in ("first", "second"):
        row = page.locator(".ag-row", has=page.get_by_role("link", name=name, exact=True))
        row.locator("input[type=checkbox]").click()
    button(page, "Compare").click()
    wait_until(page, "location.pathname === '/compare' && document.querySelectorAll('iframe').length === 1")
    drag = compared(page)["drag (N*m*s)"]
    assert drag[0] == drag[1]
    assert page.frames[1].evaluate("document.querySelectorAll('.js-plotly-plot .trace').length") >= 3
    assert external(chromium, address) == []


@pytest.mark.parametrize(
    ("path", "shown"),
    [
        ("/", "document.querySelector('.ag-row')"),
        ("/new", "document.querySelector('input[type=file]')"),
        (
            "/study/known/known",
            "document.querySelectorAll('.cm-line').length && document.querySelector('.model-drawing svg')",
        ),
        ("/run/first", "document.querySelector('iframe')"),
        (
            "/compare?run=first&run=second",
            "document.querySelectorAll('iframe').length === 1",
        ),
    ],
)
@pytest.mark.parametrize("scheme", ["light", "dark"])
def test_pages_fit_a_phone_in_light_and_dark(visit, known, path, shown, scheme):
    page = visit(path, width=390, height=844, touch=True, scheme=scheme)
    wait_until(page, f"Boolean({shown})")
    assert page.evaluate("document.documentElement.scrollWidth") <= 390
    ground = page.evaluate("getComputedStyle(document.body).backgroundColor")
    assert (ground == "rgb(255, 255, 255)" or ground == "rgba(0, 0, 0, 0)") == (scheme == "light")


def test_the_keyboard_reaches_everything(visit, known):
    page = visit("/")
    wait_until(page, "document.querySelector('.ag-row')")
    move_focus(page)
    assert page.evaluate("document.activeElement.innerText") == "Skip to the content"
    for wanted in ("New study", "Search runs"):
        press_tab_to(page, wanted)
    link(page, "New study").focus()
    page.keyboard.press("Enter")
    wait_until(page, "location.pathname === '/new'")


def press_tab_to(page: Page, text: str) -> None:
    """Press Tab until the focus comes to what has a text or a label."""
    for _ in range(60):
        move_focus(page)
        if text in page.evaluate("document.activeElement.innerText || document.activeElement.ariaLabel || ''"):
            return
    raise AssertionError(f"Tab does not reach {text}")


def test_ten_thousand_events_do_not_slow_it(visit, root):
    folder = root / "runs" / "events"
    folder.mkdir(parents=True)
    (folder / "state.json").write_text(json.dumps({"state": "failed", "task": "identify", "message": "stopped"}))
    event = {"event": "iteration", "start": 0, "values": [1.0], "samples": 9}
    lines = [json.dumps(event | {"n": n, "simulations": n, "best": 1 / (n + 1)}) for n in range(10_000)]
    (folder / "events.jsonl").write_text("\n".join(lines) + "\n")
    page = visit("/run/events")
    wait_until(
        page, f"{TEXT}.includes('9999 simulations') && Boolean(document.querySelector('.js-plotly-plot .trace'))"
    )
    assert page.evaluate("document.querySelectorAll('*').length") < 3000


def test_a_stage_with_fewer_points_than_the_last_one_is_drawn(visit, root):
    folder = root / "runs" / "stages"
    folder.mkdir(parents=True)
    (folder / "state.json").write_text(json.dumps({"state": "failed", "task": "identify", "message": "stopped"}))

    def steps(*numbers: int, samples: int) -> str:
        event = {"event": "iteration", "start": 0, "values": [1.0], "samples": samples}
        return "".join(json.dumps(event | {"simulations": n, "best": 100.0 - n}) + "\n" for n in numbers)

    (folder / "events.jsonl").write_text(steps(*range(50), samples=9))
    page = visit("/run/stages")
    drawn = "document.querySelector('.js-plotly-plot')?._fullData?.[0]?.x"
    wait_until(page, f"{drawn}?.length === 50")
    for numbers in ((50,), (51, 52)):
        with (folder / "events.jsonl").open("a") as file:
            file.write(steps(*numbers, samples=18))
        wait_until(page, f"{drawn}?.at(-1) === {numbers[-1]}")
    assert page.evaluate(f"[...{drawn}]") == [50, 51, 52]


def test_figures_of_hidden_tabs_are_no_error_and_fit_their_place(chromium, visit, known):
    page, errors = visit("/study/known/known"), []
    page.on("pageerror", lambda error: errors.append(str(error)))
    width = "document.querySelector('.js-plotly-plot .main-svg')?.getBoundingClientRect().width"
    room = "document.querySelector('.js-plotly-plot')?.getBoundingClientRect().width"
    tab(page, "Data").click()
    wait_until(page, "document.querySelectorAll('.js-plotly-plot .trace').length === 2")
    wait_until(page, f"Math.abs({width} - {room}) < 2")  # a figure is drawn before it has the width of its place
    before = page.evaluate(width)
    for name in ("Model", "Sliders", "Forms"):
        tab(page, name).click()
        page.wait_for_timeout(500)
    page.set_viewport_size({"width": 1100, "height": 800})
    tab(page, "Data").click()
    wait_until(page, f"Math.abs({width} - {room}) < 2 && {width} < {before}")
    page.set_viewport_size({"width": 1300, "height": 800})
    wait_until(page, f"Math.abs({width} - {room}) < 2 && {width} > {before}")
    assert errors == []
    assert chromium.complaints == []


def fetched(url, **headers):
    """Status of an answer."""
    try:
        with urllib.request.urlopen(urllib.request.Request(url, headers=headers)) as answer:
            return answer.status
    except urllib.error.HTTPError as error:
        return error.code


def test_only_files_of_runs_are_given_away(address, known, root):
    (root / "runs" / "first" / "secret.txt").write_text("x")
    assert fetched(f"{address}/files/first/report.html") == 200
    for path in (
        "first/secret.txt",
        "first/../../x",
        "..%2f..%2fetc/passwd",
        "%2e%2e/state.json",
        "nothing/report.html",
    ):
        assert fetched(f"{address}/files/{path}") == 404, path
    assert fetched(f"{address}/run/..%2f..%2fetc") == 404
    assert fetched(address, Host="evil.example") == 403
    assert fetched(address, Origin="https://evil.example") == 403


def test_beyond_this_machine_it_asks_for_a_token(known, root):
    command = [COMMAND, "studio", root, "--host", "0.0.0.0", "--port", "0", "--no-browser"]
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True, env=os.environ) as studio:
        given = re.search(r"http://\S+", studio.stdout.readline())[0]
        base, _, token = given.partition("/?token=")
        try:
            assert len(token) >= 16
            assert fetched(base) == 401
            assert fetched(f"{base}/files/first/result.nc") == 401
            jar = urllib.request.build_opener(urllib.request.HTTPCookieProcessor())
            assert jar.open(given).status == 200
            assert jar.open(f"{base}/new").status == 200
        finally:
            studio.terminate()
