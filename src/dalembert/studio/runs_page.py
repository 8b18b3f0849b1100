"""The first page: all runs with their states and best values, and the studies that can be run."""

from urllib.parse import quote, urlencode

from nicegui import ui

from dalembert.studio.frame import badge, button, frame
from dalembert.studio.workspace import Workspace
from dalembert.study.listing import rows

EVERY = 2.0  # s between two looks at the folder
SHOWN = 300  # runs on the page, the newest


def runs_page(workspace: Workspace) -> None:
    """Runs and studies of the workspace."""
    chosen: dict[str, bool] = {}
    with frame("Runs"):

        @ui.refreshable
        def listed(found: list[dict[str, str]]) -> None:
            if not found:
                ui.label("No runs yet. Create a study, or open one below, and run it.")
                button("New study", lambda: ui.navigate.to("/new"), icon="add")
            for row in found[:SHOWN]:
                _row(row, chosen)
            if len(found) > SHOWN:
                ui.label(f"{len(found) - SHOWN} older runs are not shown.")
            if len(found) > 1:
                button("Compare chosen runs", lambda: _compare(chosen), icon="compare_arrows")

        seen = _newest(workspace)
        listed(seen)

        def look() -> None:
            nonlocal seen
            found = _newest(workspace)
            if found != seen:
                seen = found
                listed.refresh(found)

        ui.timer(EVERY, look)
        with ui.column().classes("gap-2"):
            ui.label("Studies").classes("text-xl font-bold").props("role=heading aria-level=2")
            names = workspace.studies()
            for name in names:
                ui.link(name, f"/study/{quote(name)}")
            if not names:
                ui.label("None yet. They lie in studies/NAME/ of the folder that the studio was started in.")


def _newest(workspace: Workspace) -> list[dict[str, str]]:
    """Rows of the list of runs, the newest first."""
    return sorted(rows(workspace.runs_folder), key=lambda row: row["since"], reverse=True)


def _row(row: dict[str, str], chosen: dict[str, bool]) -> None:
    name = row["run"]
    with (
        ui.column().classes("w-full gap-1 border rounded p-2").props("role=group"),
        ui.row().classes("w-full items-center gap-x-4 gap-y-1"),
    ):
        box = ui.checkbox(value=chosen.get(name, False)).props(f'aria-label="Choose {_attribute(name)}" dense')
        box.on_value_change(lambda event: chosen.update({name: bool(event.value)}))
        ui.link(name, f"/run/{quote(name)}").classes("font-bold break-all")
        badge(row["state"])
        ui.label(row["task"]).classes("text-sm")
        ui.label(row["best"]).classes("text-sm break-all grow")
        if row["findings"]:
            ui.badge(row["findings"], color="warning", text_color="black")
        ui.label(row["since"]).classes("text-sm opacity-70")
        for message in row["messages"].splitlines():
            ui.label(message).classes("w-full text-sm break-words pl-8")


def _attribute(text: str) -> str:
    """A text inside an attribute in double quotes."""
    return text.replace("\\", "").replace('"', "'")


def _compare(chosen: dict[str, bool]) -> None:
    names = [name for name, wanted in chosen.items() if wanted]
    if len(names) < 2:
        ui.notify("Choose two or more runs to compare.", type="warning")
    else:
        ui.navigate.to(f"/compare?{urlencode({'run': names}, doseq=True)}")
