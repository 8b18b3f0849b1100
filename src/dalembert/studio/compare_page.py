"""Two or more runs side by side: states, best values, convergence."""

from urllib.parse import quote

from nicegui import ui

from dalembert.errors import InputError
from dalembert.studio.figures import convergence, plot
from dalembert.studio.frame import badge, frame, report_of
from dalembert.studio.live import Live
from dalembert.studio.workspace import Workspace
from dalembert.study.folder import RunFolder
from dalembert.study.listing import doubts, since

MOST = 8  # runs side by side


def compare_page(workspace: Workspace, names: list[str]) -> None:
    """Runs side by side."""
    with frame("Runs side by side"):
        try:
            folders = [workspace.run(name) for name in dict.fromkeys(names[:MOST])]
        except InputError as error:
            ui.label(str(error)).props("role=alert")
            return
        lives = {folder.path.name: _read(folder) for folder in folders}
        _table(folders, lives)
        curves = {name: live.convergence for name, live in lives.items() if len(live.convergence) > 1}
        if curves:
            plot(convergence(curves)).classes("w-full").props('role=img aria-label="Convergence"')
        with ui.row().classes("w-full gap-4"):
            for folder in (folder for folder in folders if folder.report.is_file()):
                with ui.column().classes("grow basis-80 min-w-0"):
                    ui.label(folder.path.name).classes("font-bold break-all")
                    report_of(folder, "75vh")


def _read(folder: RunFolder) -> Live:
    live = Live(folder.events)
    live.advance()
    return live


def _table(folders: list[RunFolder], lives: dict[str, Live]) -> None:
    """A column a run: state, task, simulations, best fitness, best values."""
    states = [folder.state() for folder in folders]
    values, deviations = ([_best(state, key) for state in states] for key in ("values", "deviations"))
    rows: list[tuple[str, list[str]]] = [
        ("task", [str(state.get("task", "")) for state in states]),
        ("since (UTC)", [since(state) for state in states]),
        ("best fitness", [_number((state.get("best") or {}).get("fitness")) for state in states]),
        ("findings", ["\n".join(doubts(state)) for state in states]),
        ("events", [str(lives[folder.path.name].count) for folder in folders]),
    ]
    names = dict.fromkeys(key for own in values for key in own)
    rows += [
        (name, [_with_deviation(own.get(name), known.get(name)) for own, known in zip(values, deviations, strict=True)])
        for name in names
    ]
    with ui.element("div").classes("w-full overflow-x-auto"), ui.element("table").classes("text-sm"):
        with ui.element("tr"):
            ui.element("td")
            for folder, state in zip(folders, states, strict=True):
                with ui.element("th").classes("text-left p-2").props("scope=col"):
                    ui.link(folder.path.name, f"/run/{quote(folder.path.name)}").classes("break-all mr-2")
                    badge(str(state["state"]))
        for label, cells in rows:
            with ui.element("tr").classes("border-t"):
                with ui.element("th").classes("text-left p-2").props("scope=row"):
                    ui.label(label)
                for text in cells:
                    with ui.element("td").classes("p-2 align-top"):
                        ui.label(text).classes("whitespace-pre-wrap")


def _best(state: dict, key: str) -> dict:
    """Numbers of a run's state by the names of its unknowns; none of a run without them."""
    return dict((state.get("best") or {}).get(key) or {})


def _with_deviation(value: object, deviation: object) -> str:
    """An identified value and its standard deviation, with two digits, if they are known.

    >>> _with_deviation(0.7853981, 1.23e-4), _with_deviation(2.0, None), _with_deviation(None, None)
    ('0.785398 ± 0.00012', '2', '')
    """
    return f"{_number(value)} ± {deviation:.2g}" if isinstance(deviation, (int, float)) else _number(value)


def _number(value: object) -> str:
    return f"{value:.6g}" if isinstance(value, (int, float)) else ""
