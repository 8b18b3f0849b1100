"""Page of a run: live until it ends, then with its report."""

import asyncio
import json
from collections.abc import Mapping, Sequence
from contextlib import suppress
from pathlib import Path
from urllib.parse import quote

import plotly.graph_objects as go
from nicegui import run, ui

from dalembert.errors import InputError
from dalembert.studio.frame import STATES, badge, button, complaints, frame, report_of
from dalembert.studio.jobs import Jobs, pause, stop
from dalembert.studio.pacing import Throttle
from dalembert.studio.runs.figures import bare, convergence, followed, on_any_page, plot, wandering
from dalembert.studio.runs.findings_list import findings_list
from dalembert.studio.runs.fit_so_far import fit_so_far
from dalembert.studio.runs.live import Live, planned_simulations
from dalembert.studio.runs.run_units import run_units, values_of, values_text
from dalembert.studio.runs.study_runs import run_again, study_of
from dalembert.studio.worker import Kept, Worker, WorkerError
from dalembert.studio.workspace import Workspace
from dalembert.study.run.folder import FINISHED, INPUT, KILLED, RESUMABLE, RUNNING, RunFolder

EVERY = 0.5  # s between two looks at the events
FILES = {"report.html": "Report", "result.nc": "Result (NetCDF)", "study.toml": "Study", "events.jsonl": "Events"}
"""Files of a run that can be downloaded, and what they are called."""
FEW_VALUES = 4
"""Values of a result that are shown in a line; more are shown as a table."""
STARTING, MISSING = "starting", "missing"
SAYS = {
    KILLED: "The process of this run ended in the middle: it was killed, or the machine stopped. What it computed is "
    "kept. Resume continues it.",
    MISSING: "There is no run of this name, or it has not begun. The page Runs lists all.",
}
"""What is said of a state that no process wrote."""


def run_page(workspace: Workspace, jobs: Jobs, watcher: Worker, name: str) -> None:
    """Watch a run, stop or resume it, and read its report."""
    folder = RunFolder(workspace.runs_folder / name)
    with frame(name):
        page = _Page(workspace, folder, jobs, watcher)
        page.build()
        page.look_at_state()
        ui.timer(EVERY, page.look)


class _Page:
    """What changes on the page of a run. ``watcher`` computes the best fit so far."""

    def __init__(self, workspace: Workspace, folder: RunFolder, jobs: Jobs, watcher: Worker) -> None:
        self.workspace, self.folder, self.jobs, self.watcher = workspace, folder, jobs, watcher
        self.drawing, self.computing = Throttle(), Throttle()
        self.live = Live(folder.events)
        self.state, self.complaint, self.shown = "", "", 0
        self.drawn: dict[str, object] = {}
        self.fitted: list[float] = []
        self.fitting: asyncio.Task | None = None
        self.learning: asyncio.Task | None = None

    def build(self) -> None:
        """Make the parts of the page: state, actions, values, what is live, files, findings, report."""
        with ui.row().classes("items-center gap-x-4 gap-y-2"):
            self.badge = badge(STARTING)
            self.told = ui.label("").props("role=status aria-live=polite").classes("break-words")
        self.bar = ui.linear_progress(0, show_value=False).props('aria-label="Progress" indeterminate')
        with ui.row().classes("gap-2"):
            self._build_actions()
        self.message = ui.label("").classes("whitespace-pre-wrap break-words")
        self.values = ui.column().classes("w-full")
        self.live_part = ui.column().classes("w-full gap-4")
        with self.live_part:
            self.choice = ui.select([""], value="", label="Experiment", on_change=self._fit_again)
            self.choice.props("dense outlined").set_visibility(False)
            self.fit, self.curve, self.paths = (ui.column().classes("w-full") for _ in range(3))
            with ui.expansion("Events", icon="list").classes("w-full"):
                self.log = ui.log(max_lines=200).classes("w-full h-64")
        self.files = ui.row().classes("gap-4")
        self.findings = ui.column().classes("w-full gap-2")
        self.report = ui.column().classes("w-full")

    def _build_actions(self) -> None:
        name = self.folder.path.name

        def open_study() -> None:
            ui.navigate.to(f"/study/{quote(study_of(self.workspace, self.folder) or '')}")

        def start_again() -> None:
            ui.navigate.to(f"/run/{quote(run_again(self.workspace, self.jobs, name))}")

        def continue_as_new() -> None:
            ui.navigate.to(f"/continue/{quote(name)}")

        self.pause = button("Pause", complaints()(lambda: pause(self.folder)), icon="pause")
        self.stop = button("Stop", complaints()(lambda: stop(self.folder)), icon="stop", colour="negative")
        self.resume = button("Resume", complaints()(lambda: self.jobs.resume(self.folder.path)), icon="play_arrow")
        self.study = button("Open the study", open_study, icon="edit_note").props("flat")
        self.again = button("Run again", complaints()(start_again), icon="replay").props("flat")
        self.next = button("Continue as a new study", continue_as_new, icon="note_add").props("flat")

    async def look(self) -> None:
        """Bring the page up to what the run's folder says."""
        if self.state != FINISHED and await run.io_bound(self.live.advance):  # then its report says it
            self._show_events()
        self.look_at_state()
        self._draw_curves()
        if self.state == RUNNING:
            self._ask_worker()

    def look_at_state(self) -> None:
        """Show the state of the run, and what depends on it, if it has changed."""
        state, complaint = self._state(), self.jobs.complaint(self.folder.path)
        if (state, complaint) != (self.state, self.complaint):
            self.state, self.complaint = state, complaint
            self._show_state()
        if not self.live.count and state in (RUNNING, STARTING):
            self.message.set_text(self.jobs.said(self.folder.path))
        elif state == RUNNING:
            self.message.set_text("")

    def _state(self) -> str:
        if self.folder.is_run:
            return str(self.folder.state()["state"])
        if self.jobs.complaint(self.folder.path):
            return INPUT
        return STARTING if self.jobs.is_started(self.folder.path) else MISSING

    def _show_state(self) -> None:
        """Show the state itself, what can be done now, and what there is to read."""
        ended = self.state not in (RUNNING, STARTING)
        self._show_actions(ended)
        message = self.folder.state().get("message", "") if self.folder.is_run else ""
        self.message.set_text(str(message or self.complaint or SAYS.get(self.state, "")) if ended else "")
        for part in (self.files, self.report, self.findings, self.values):
            part.clear()
        if ended:
            self._show_files()
            self._show_result()

    def _show_actions(self, ended: bool) -> None:
        state = self.state
        self.badge.set_text(state)
        self.badge.props(f"color={STATES.get(state, 'grey' if state == STARTING else 'negative')}")
        self.bar.set_visibility(not ended)
        for action, offered in (
            (self.stop, state == RUNNING),
            (self.pause, state == RUNNING),
            (self.resume, state in RESUMABLE),
            (self.study, study_of(self.workspace, self.folder) is not None),
            (self.again, ended and self.folder.is_run),
            (self.next, ended and self.folder.is_run),
        ):
            action.set_visibility(offered)

    def _show_files(self) -> None:
        name = self.folder.path.name
        with self.files:
            ui.label("Download:")
            for file, what in FILES.items():
                if (self.folder.path / file).is_file():
                    saved = f"{name}-{file}".replace('"', "")
                    ui.link(what, f"/files/{quote(name)}/{file}").props(f'download="{saved}"')

    def _show_result(self) -> None:
        """Show findings, misfit, values, many of them as a table, and the report."""
        with self.findings:
            if self.folder.is_run:
                findings_list(self.folder)
        if self.state == FINISHED:
            best = self.folder.state().get("best") or {}
            misfit, values = best.get("misfit"), best.get("values") or {}
            units, text = run_units(self.folder, values), "" if misfit is None else f"misfit {misfit:.4g}"
            if len(values) > FEW_VALUES:
                with self.values:
                    _value_table(values_of(best, units))
            else:
                text = ", ".join(filter(None, (text, values_text(best, units))))
            self.told.set_text(text)
        self.live_part.set_visibility(self.state != FINISHED)
        if self.folder.report.is_file():
            with self.report:
                report_of(self.folder, "85vh")

    def _show_events(self) -> None:
        text, done, total = self.live.progress
        self.told.set_text(" · ".join(filter(None, (text, self.live.remaining.sentence()))))
        self.bar.set_value(done / total if total else 0.0)
        self.bar.props("indeterminate" if not total else "", remove="indeterminate" if total else "")
        new = min(self.live.count - self.shown, len(self.live.recent))
        for event in list(self.live.recent)[len(self.live.recent) - new :]:
            self.log.push(json.dumps(event, ensure_ascii=False)[:400])
        self.shown = self.live.count

    def _draw_curves(self) -> None:
        """Draw the curves that have changed, those of a run that has ended at once."""
        if self.state == FINISHED or (self.state == RUNNING and not self.drawing.is_due):
            return
        live = self.live
        with self.drawing.work():
            if live.convergence and self._is_new("convergence", live.convergence):
                curve = convergence({self.folder.path.name: live.convergence})
                _draw(self.curve, "Best value over simulations", curve)
            if live.visited and live.names and self._is_new("visited", live.visited):
                _draw(self.paths, "Parameters over simulations", wandering(live.visited, live.names, live.units))
            if len(live.followed) > 1 and self._is_new("followed", live.followed):
                _draw(self.curve, "The response computed so far", followed(live.followed, live.axes))

    def _is_new(self, what: str, points: Sequence[object]) -> bool:
        """Return True unless these points of a curve are drawn; a new stage may have fewer of them than the last."""
        is_new = self.drawn.get(what) != tuple(points)
        self.drawn[what] = tuple(points)
        return is_new

    def _ask_worker(self) -> None:
        """Start to learn the names of the unknowns once, and to compute each new best fit when that is due."""
        if self.learning is None:
            self.learning = asyncio.create_task(self._learn())
        is_new = self.live.values and self.live.values != self.fitted
        if is_new and self.computing.is_due and (self.fitting is None or self.fitting.done()):
            self.fitted = list(self.live.values)
            self.fitting = asyncio.create_task(self._show_fit(self.fitted))

    async def _learn(self) -> None:
        """Ask another process for the names of the unknowns and the number of simulations, which take imports."""
        name = self.folder.path.name
        with suppress(WorkerError):  # whatever a user's model raises, the run itself says it
            names = await self.watcher.ask(f"names {name}", _names, self.folder) or ()
            self.live.name(names, run_units(self.folder, names))
            self.live.remaining.planned = await self.watcher.ask(f"planned {name}", _planned, self.folder.path)

    def _fit_again(self) -> None:
        """Show the fit to another experiment at the next look."""
        self.fitted = []

    async def _show_fit(self, values: list[float]) -> None:
        """The best fit so far; a run whose model another process cannot make has none."""
        with suppress(WorkerError), self.computing.work():
            subject = f"fit {self.folder.path.name}"
            found = await self.watcher.ask(subject, fit_so_far, self.folder.path, values, self.choice.value)
            if found is None:
                return
            if not self.choice.value:
                self.choice.set_options(list(found.experiments), value=found.experiments[0])
                self.choice.set_visibility(len(found.experiments) > 1)
                self.fitted = values  # which are shown
            _draw(self.fit, "Best fit so far, and the data", on_any_page(go.Figure(found.figure)))


def _draw(place: ui.column, name: str, figure: go.Figure) -> None:
    """Draw a figure in its place, or a newer one in the place of an older."""
    plots = [child for child in place if isinstance(child, ui.plotly)]
    for drawn in plots:
        drawn.update_figure(bare(figure))
    if not plots:
        with place:
            plot(figure).classes("w-full").props(f'role=img aria-label="{name}"')


def _value_table(rows: Mapping[str, str]) -> None:
    """Show values by name in as many columns as the page has room for."""
    with ui.element("dl").classes("w-full columns-[18rem] gap-8").props('aria-label="Values"'):
        for name, value in rows.items():
            with ui.element("div").classes("flex justify-between gap-4 border-t py-1 break-inside-avoid"):
                with ui.element("dt").classes("break-words min-w-0"):
                    ui.label(name)
                with ui.element("dd").classes("text-right"):
                    ui.label(value)


def _names(kept: Kept, folder: RunFolder) -> tuple[str, ...]:
    """Names of the unknowns; none of a run that has not begun."""
    from dalembert.study.run.runner import unknowns

    try:
        return unknowns(folder.kept()) if folder.is_run else ()
    except (InputError, OSError):
        return ()


def _planned(kept: Kept, run: Path) -> int | None:
    return planned_simulations(run)
