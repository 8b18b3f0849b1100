"""The studio in a real browser: with the mouse, by keyboard, on a phone, and against what should not get in."""

import json
import os
import re
import subprocess
import sys
import urllib.error
import urllib.request
from pathlib import Path

import pytest

from dalembert.study.template import begin

pytestmark = pytest.mark.slow
COMMAND = Path(sys.executable).with_name("dalembert")
TEXT = "(document.body?.innerText ?? '')"


@pytest.fixture(scope="module")
def root(tmp_path_factory):
    return tmp_path_factory.mktemp("workspace")


@pytest.fixture(scope="module")
def address(root):
    """Where the studio answers."""
    command = [COMMAND, "studio", root, "--port", "0", "--no-browser"]
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as studio:
        found = re.search(r"http://\S+", studio.stdout.readline())
        yield found[0].rstrip("/")
        studio.terminate()


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
        tab = chromium.tab(**device)
        tab.send("Page.navigate", url=address + path)
        tab.until("document.querySelector('[role=main]') && window.socket?.connected && window.did_handshake")
        return tab

    return visit


def button(text):
    return f"[...document.querySelectorAll('button')].find((one) => one.innerText.includes({json.dumps(text)}))"


def link(text):
    return f"[...document.querySelectorAll('a')].find((one) => one.innerText === {json.dumps(text)})"


def begun(tab, name, template):
    """A study from a template, once it is found in order."""
    tab.until(f"Boolean({button(template)})")
    tab.click("document.querySelector('input[placeholder]')")
    tab.write(name)
    tab.click(button(template))
    tab.until("location.pathname.startsWith('/study/')")
    tab.until(f"{TEXT}.includes('In order.')")


def external(tab, address):
    return [request for request in tab.requests if not request.startswith((address, address.replace("http", "ws")))]


def test_from_nothing_to_an_identified_parameter(visit, address, root):
    tab = visit("/new")
    begun(tab, "drag", "Parameters from a measured motion")
    tab.until("document.querySelectorAll('.js-plotly-plot .trace').length === 2")
    tab.click(button("Run"))
    tab.until("location.pathname === '/run/drag'")
    tab.until(f"{TEXT}.includes('finished') && Boolean(document.querySelector('iframe'))")
    assert json.loads((root / "runs" / "drag" / "state.json").read_text())["best"]["values"]["drag"] == pytest.approx(
        0.2, abs=1e-3
    )
    tab.click(link("Runs"))
    tab.until(f"location.pathname === '/' && {TEXT}.includes('drag = 0.199')")
    assert external(tab, address) == []
    assert tab.complaints == []


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
    tab = visit("/study/long/study")
    tab.until(f"{TEXT}.includes('In order.')")
    tab.click(button("Run"))
    tab.until(f"location.pathname === '/run/long' && /rate = .* of 5000/.test({TEXT})")
    tab.click(button("Stop"))
    tab.until(f"{TEXT}.includes('interrupted')")
    (root / "runs" / "go").touch()  # a run that is resumed has its copy of the file in runs/long/inputs
    tab.click(button("Resume"))
    tab.until(f"{TEXT}.includes('finished') && Boolean(document.querySelector('iframe'))")


def test_mistakes_stand_at_their_lines(visit):
    tab = visit("/new")
    begun(tab, "wrong", "A motion of a mechanism")
    tab.click("[...document.querySelectorAll('.cm-line')].find((one) => one.innerText.startsWith('mass'))")
    tab.press("End")
    tab.write("x")
    tab.until(f"{TEXT}.includes('1 to put right')")
    tab.until("document.querySelector('.cm-line.wrong')?.innerText.startsWith('mass')")
    assert tab.run(f"{button('Run')}.disabled")
    tab.until("[...document.querySelectorAll('[role=alert]')].some((one) => one.innerText.includes('line '))")


def test_measured_data_are_taken_and_drawn_before_anything_runs(visit, root, tmp_path):
    tab = visit("/new")
    begun(tab, "data", "Parameters from a measured motion")
    (tmp_path / "mine.csv").write_text((root / "studies" / "data" / "motion.csv").read_text())
    tab.upload("input[type=file]", tmp_path / "mine.csv")
    tab.until(f"{TEXT}.includes('mine.csv lies beside the study now')")
    assert (root / "studies" / "data" / "mine.csv").is_file()
    (tmp_path / "evil.py").write_text("")
    tab.upload("input[type=file]", tmp_path / "evil.py")
    (tmp_path / "late.csv").write_text((tmp_path / "mine.csv").read_text())
    tab.upload("input[type=file]", tmp_path / "late.csv")
    tab.until(f"{TEXT}.includes('late.csv lies beside the study now')")
    assert not (root / "studies" / "data" / "evil.py").exists()


def test_a_study_file_that_is_no_text_is_refused(visit, tmp_path, root):
    tab = visit("/new")
    tab.click("document.querySelector('input[placeholder]')")
    tab.write("latin")
    (tmp_path / "latin.toml").write_bytes(b"a = '\xff'")
    tab.upload("input[type=file]", tmp_path / "latin.toml")
    tab.until(f"{TEXT}.includes('the file is not UTF-8 text')")
    assert not (root / "studies" / "latin").exists()


def test_a_name_with_a_script_is_refused_and_one_that_is_there_is_shown_as_text(visit, root):
    tab = visit("/new")
    tab.until(f"Boolean({button('A motion')})")
    tab.click("document.querySelector('input[placeholder]')")
    tab.write("<img src=x onerror=document.title='run'>")
    tab.click(button("A motion"))
    tab.until(f"{TEXT}.includes('cannot be a name here')")
    nasty = root / "runs" / "<img src=x onerror=document.title='run'>"
    nasty.mkdir(parents=True)
    state = {"state": "failed", "task": "<b>bold</b>", "since": "2000-01-01T00:00:00+00:00"}
    (nasty / "state.json").write_text(json.dumps(state))
    tab = visit("/")
    tab.until(f"{TEXT}.includes('onerror') && {TEXT}.includes('<b>bold</b>')")
    assert tab.run("document.title") == "Runs · dalembert"
    assert tab.run("document.images.length") == 0


def test_findings_are_in_the_list_and_beside_each_other(visit, known, root):
    state = json.loads((root / "runs" / "first" / "state.json").read_text())
    finding = {"code": "correlated-residuals", "severity": "warning", "message": "The residuals <b>are</b> correlated."}
    note = {"code": "few-samples", "severity": "note", "message": "There are few samples."}
    state["best"]["deviations"]["drag"] = None
    doubtful = root / "runs" / "doubtful"
    doubtful.mkdir()
    (doubtful / "state.json").write_text(json.dumps({**state, "findings": [finding, note]}))
    tab = visit("/")
    tab.until(f"{TEXT}.includes('The residuals <b>are</b> correlated.') && {TEXT}.includes('1 warning')")
    assert not tab.run(f"{TEXT}.includes('few samples')")
    tab = visit("/compare?run=first&run=doubtful")
    tab.until("document.querySelectorAll('tr').length > 3")
    rows = tab.run("[...document.querySelectorAll('tr')].map((row) => row.innerText.split(/\\s*\\t\\s*/))")
    (drag,) = [row for row in rows if row[0].strip() == "drag"]
    assert re.fullmatch(r"[\d.]+ ± [\d.e-]+", drag[1].strip()), drag
    assert re.fullmatch(r"[\d.]+", drag[2].strip()), drag
    (findings,) = [row for row in rows if row[0].strip() == "findings"]
    assert findings[-1].strip() == finding["message"]  # that of the other run is empty


def test_two_runs_side_by_side(visit, known, address):
    tab = visit("/")
    for name in ("first", "second"):
        tab.click(f"document.querySelector('[aria-label=\"Choose {name}\"]')")
    tab.click(button("Compare"))
    tab.until("location.pathname === '/compare' && document.querySelectorAll('iframe').length === 2")
    rows = tab.run("[...document.querySelectorAll('tr')].map((row) => row.innerText.split(/\\s*\\t\\s*/))")
    (drag,) = [row for row in rows if row[0].strip() == "drag"]
    assert drag[1] == drag[2]
    assert external(tab, address) == []


@pytest.mark.parametrize(
    ("path", "shown"),
    [
        ("/", f"{TEXT}.includes('Compare chosen runs')"),
        ("/new", "document.querySelector('input[type=file]')"),
        (
            "/study/known/known",
            "document.querySelectorAll('.cm-line').length && document.querySelector('.js-plotly-plot .trace')",
        ),
        ("/run/first", "document.querySelector('iframe')"),
        (
            "/compare?run=first&run=second",
            "document.querySelectorAll('iframe').length === 2 && document.querySelector('.js-plotly-plot .trace')",
        ),
    ],
)
@pytest.mark.parametrize("scheme", ["light", "dark"])
def test_pages_fit_a_phone_in_light_and_dark(visit, known, path, shown, scheme):
    tab = visit(path, width=390, height=844, touch=True, scheme=scheme)
    tab.until(f"Boolean({shown})")
    assert tab.run("document.documentElement.scrollWidth") <= 390
    ground = tab.run("getComputedStyle(document.body).backgroundColor")
    assert (ground == "rgb(255, 255, 255)" or ground == "rgba(0, 0, 0, 0)") == (scheme == "light")


def test_the_keyboard_reaches_everything(visit, known):
    tab = visit("/")
    tab.until(f"{TEXT}.includes('Compare chosen runs')")
    tab.move_focus()
    assert tab.run("document.activeElement.innerText") == "Skip to the content"
    for wanted in ("New study", "Choose first", "first", "Compare chosen runs"):
        press_tab_to(tab, wanted)
    tab.run(f"{link('New study')}.focus()")
    tab.press("Enter")
    tab.until("location.pathname === '/new'")


def press_tab_to(tab, text):
    """Press Tab until the focus comes to what has a text or a label."""
    for _ in range(60):
        tab.move_focus()
        if text in tab.run("document.activeElement.innerText || document.activeElement.ariaLabel || ''"):
            return
    raise AssertionError(f"Tab never came to {text}")


def test_ten_thousand_events_do_not_slow_it(visit, root):
    folder = root / "runs" / "events"
    folder.mkdir(parents=True)
    (folder / "state.json").write_text(json.dumps({"state": "failed", "task": "identify", "message": "stopped"}))
    event = {"event": "iteration", "start": 0, "values": [1.0], "samples": 9}
    lines = [json.dumps(event | {"n": n, "simulations": n, "best": 1 / (n + 1)}) for n in range(10_000)]
    (folder / "events.jsonl").write_text("\n".join(lines) + "\n")
    tab = visit("/run/events")
    tab.until(f"{TEXT}.includes('9999 simulations') && Boolean(document.querySelector('.js-plotly-plot .trace'))")
    assert tab.run("document.querySelectorAll('*').length") < 3000


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
