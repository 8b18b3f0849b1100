"""All pages of a studio, in the states that a user sees them in, and a workspace that has something for each."""

import subprocess
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

from playwright.sync_api import Page

from browser.running_studio import COMMAND
from browser.visitor import wait_until
from dalembert.study.template import begin

SLOW = """
import time
import numpy as np
from dalembert.forward import PythonModel

TIMES = np.linspace(0.0, 2.0, 41)

def model(parameters):
    return PythonModel(response, parameters, ["x"], TIMES)

def response(size, rate):
    time.sleep(0.2)
    return size * np.exp(-rate * TIMES)
"""
LIVE = """
[parameters]
size = { lower = 0.1, upper = 9.0 }
rate = { lower = 0.1, upper = 9.0 }
[model]
forward = "slow.py:model"
[data]
file = "decay.csv"
time = "t"
columns = { x = "x" }
[identify]
starts = 5000
"""
TEXT = "(document.body?.innerText ?? '')"
DRAWN = "document.querySelector('.model-drawing [data-part], .model-space button')"
CURVES = "document.querySelector('.js-plotly-plot .trace')"


@dataclass(frozen=True)
class Shown:
    """A page in a state.

    Parameters
    ----------
    name, path : str
    ready : str
        Script that is true once it is shown.
    act : callable, optional
        Does what leads to the state.
    """

    name: str
    path: str
    ready: str = "true"
    act: Callable[[Page], object] | None = None

    def show(self, page: Page) -> None:
        """Bring the page, which is open at the path, to the state."""
        if self.act is not None:
            self.act(page)
        wait_until(page, f"Boolean({self.ready})")


def _tab(title: str, ready: str) -> Callable[[Page], None]:
    def open_tab(page: Page) -> None:
        page.get_by_role("tab", name=title).click()
        wait_until(page, f"Boolean({ready})")

    return open_tab


def _then(*steps: Callable[[Page], object]) -> Callable[[Page], None]:
    def act(page: Page) -> None:
        for step in steps:
            step(page)

    return act


def _press(name: str) -> Callable[[Page], None]:
    """Press a button."""
    return lambda page: page.get_by_role("button", name=name, exact=True).first.press("Enter")


def _select_run(page: Page) -> None:
    page.locator(".ag-row", has_text="first").locator("input[type=checkbox]").click()
    wait_until(page, "!document.querySelector('main button, [role=main] button')?.disabled")


def _complete(page: Page) -> None:
    """Open the list of completions at the end of the text."""
    page.locator(".cm-content").click()
    page.keyboard.press("Control+End")
    page.keyboard.type("\n[[model.lo")
    wait_until(page, "Boolean(document.querySelector('.cm-tooltip-autocomplete li'))")


def _choose_line(start: str) -> Callable[[Page], None]:
    return lambda page: page.locator(".cm-line", has_text=start).first.click()


def _further(page: Page) -> None:
    """Show all keys of a form."""
    page.get_by_text("Further keys").click()


def _options(label: str) -> Callable[[Page], None]:
    """Open a menu of entries."""
    return lambda page: page.get_by_label(label, exact=True).first.click()


MENU = "document.querySelector('.q-menu')?.checkVisibility({ opacityProperty: true })"
DIALOG = "document.querySelector('[role=dialog] .q-card')?.checkVisibility({ opacityProperty: true })"
SLIDERS = f"({CURVES} && document.querySelector('.parameter-row'))"
COLUMNS = f"({CURVES} && document.querySelector('[aria-label^=\"Use of column\"]'))"
FORM = "document.querySelector('[role=tabpanel] [role=heading]')"
PLANAR, SPATIAL, VIBRATION = (f"/study/{name}/{name}" for name in ("identify", "spatial", "response"))
NO_DRAWING = f"{TEXT}.includes('The drawing appears when they are corrected.')"
NO_SLIDERS = f"{TEXT}.includes('The study has no parameters.')"
VALID = f"{TEXT}.includes('Valid.')"
PAGES = (
    Shown("runs", "/", "document.querySelector('.ag-row')"),
    Shown("run-selected", "/", "document.querySelector('.ag-row')", _select_run),
    Shown("run-renamed", "/", DIALOG, _then(_select_run, _press("Rename"))),
    Shown("studies", "/studies", "document.querySelectorAll('img').length > 6"),
    Shown("new", "/new", "document.querySelectorAll('img').length > 4"),
    Shown("planar-model", PLANAR, f"{VALID} && {DRAWN}"),
    Shown("planar-part", PLANAR, f"{VALID} && {DRAWN}", _choose_line("viscous")),
    Shown("planar-forms", PLANAR, VALID, _tab("Forms", "document.querySelector('[aria-label=\"Add a body\"]')")),
    Shown("planar-form", PLANAR, FORM, _then(_tab("Forms", VALID), _choose_line("viscous"), _further)),
    Shown("planar-addition", PLANAR, MENU, _then(_tab("Forms", VALID), _press("Add a force"))),
    Shown("planar-name", PLANAR, DIALOG, _then(_tab("Forms", VALID), _press("Add a parameter"))),
    Shown("planar-sliders", PLANAR, "document.querySelector('.effect')", _tab("Sliders", SLIDERS)),
    Shown("planar-use", PLANAR, MENU, _then(_tab("Sliders", SLIDERS), _press("Use drag"))),
    Shown("planar-data", PLANAR, COLUMNS, _tab("Data", COLUMNS)),
    Shown("planar-column", PLANAR, MENU, _then(_tab("Data", COLUMNS), _options("Use of column x"))),
    Shown("planar-completions", PLANAR, act=_complete),
    Shown("spatial-model", SPATIAL, "document.querySelectorAll('.model-space button').length > 4"),
    Shown("spatial-forms", SPATIAL, FORM, _then(_tab("Forms", VALID), _choose_line("kind"))),
    Shown("spatial-sliders", SPATIAL, SLIDERS, _tab("Sliders", "document.querySelector('.player, .parameter-row')")),
    Shown("spatial-data", SPATIAL, VALID, _tab("Data", VALID)),
    Shown("vibration-model", VIBRATION, DRAWN),
    Shown("vibration-forms", VIBRATION, FORM, _then(_tab("Forms", VALID), _choose_line("mass"))),
    Shown("vibration-sliders", VIBRATION, f"{CURVES} && {NO_SLIDERS}", _tab("Sliders", VALID)),
    Shown("vibration-data", VIBRATION, VALID, _tab("Data", VALID)),
    Shown("mistakes", "/study/wrong/wrong", f"document.querySelector('.cm-line.wrong') && {NO_DRAWING}"),
    Shown(
        "mistake-form",
        "/study/wrong/wrong",
        "document.querySelector('.q-field--error')",
        _then(_tab("Forms", "document.querySelector('.cm-line.wrong')"), _choose_line("kilo")),
    ),
    Shown("model-file", "/study/shared/shared/model", f"{VALID} && {DRAWN}"),
    Shown("model-file-forms", "/study/shared/shared/model", FORM, _then(_tab("Forms", VALID), _choose_line("mass"))),
    Shown("live", "/run/live", CURVES),
    Shown("finished", "/run/first", "document.querySelector('iframe')"),
    Shown("failed", "/run/failed", f"{TEXT}.includes('failed')"),
    Shown("compare", "/compare?run=first&run=second", "document.querySelector('iframe')"),
    Shown("continue", "/continue/first", f"{TEXT}.includes('start = 0.19')"),
    Shown("no-study", "/study/none/none", "document.querySelector('[role=alert]')"),
    Shown("no-run", "/continue/none", "document.querySelector('[role=alert]')"),
    Shown("no-choice", "/compare", "document.querySelector('[role=alert]')"),
    Shown("report", "/files/first/report.html", "document.documentElement.dataset.ready === 'yes'"),
    Shown("comparison", "/comparison?run=first&run=second", "document.documentElement.dataset.ready === 'yes'"),
)
"""Every page, with its panels, forms, menus and dialogs."""


@contextmanager
def filled(root: Path) -> Iterator[Path]:
    """A workspace with studies of three kinds, one with mistakes, and runs: two finished ones, a failed and a live one."""
    for name in ("identify", "spatial", "response", "wrong"):
        begin(name if name != "wrong" else "motion", root / "studies" / name)
    _with_model_file(root)
    wrong = root / "studies" / "wrong" / "wrong.toml"
    wrong.write_text(wrong.read_text().replace("kg", "kilo", 1))
    study, runs = root / "studies" / "identify" / "identify.toml", root / "runs"
    for name in ("first", "second"):
        subprocess.run([COMMAND, "run", study, "--out", runs / name], check=True, capture_output=True)
    subprocess.run([COMMAND, "run", _failing(root), "--out", runs / "failed"], check=False, capture_output=True)
    with subprocess.Popen(
        [COMMAND, "run", _slow(root, SLOW), "--out", runs / "live"],
        stdout=subprocess.DEVNULL,
        stderr=subprocess.DEVNULL,
    ) as live:
        yield root
        live.terminate()


def _slow(root: Path, module: str, name: str = "slow") -> Path:
    """A study whose simulations take their time."""
    folder = root / "studies" / name
    folder.mkdir()
    (folder / "slow.py").write_text(module)
    rows = (f"{0.05 * k:.2f},{3 * 0.7 ** (0.05 * k) + 0.01 * (-1) ** k:.4f}" for k in range(41))
    (folder / "decay.csv").write_text("\n".join(["t,x", *rows]))
    (folder / "study.toml").write_text(LIVE)
    return folder / "study.toml"


def _with_model_file(root: Path) -> None:
    """A study whose model is in a file of its own."""
    study = begin("motion", root / "studies" / "shared")
    head, _, rest = study.read_text().partition("[constants]")
    model, _, task = f"[constants]{rest}".partition("[solver]")
    study.with_name("pendulum.toml").write_text(model)
    study.write_text(f'{head}[model]\nfile = "pendulum.toml"\n\n[solver]{task}')


def _failing(root: Path) -> Path:
    """A study whose model raises an error."""
    return _slow(root, SLOW.replace("time.sleep(0.2)", "raise ValueError('no such thing')"), "failing")
