"""Continue a run as a new study: what changes is shown before the study is made."""

from urllib.parse import quote

import tomlkit
from nicegui import ui

from dalembert.errors import InputError
from dalembert.studio.code_text import code_text
from dalembert.studio.frame import button, complaints, frame
from dalembert.studio.runs.advice import Change, changes_of, start_from_best
from dalembert.studio.runs.differences import differences, show_differences
from dalembert.studio.runs.run_changes import continued, study_text
from dalembert.studio.runs.run_list import study_name
from dalembert.studio.workspace import Workspace
from dalembert.study.run.folder import RunFolder


def continue_page(workspace: Workspace, name: str, code: str = "", number: int = 0) -> None:
    """Show the study that follows from a run, to be confirmed. ``code`` is that of the finding whose advice changes the
    study; empty for none. ``number`` chooses among the changes of that code that
    :func:`~dalembert.studio.runs.advice.changes_of` returns.
    """
    with frame(f"Continue {name}"):
        try:
            folder = workspace.run(name)
            old = study_text(folder).as_string()
            change = _change(folder, code, number)
        except InputError as error:
            code_text(str(error)).props("role=alert")
            return
        _Page(workspace, folder, old, change).build()


def _change(folder: RunFolder, code: str, number: int) -> Change | None:
    if not code:
        return None
    found = [one for one in changes_of(folder.state(), study_text(folder)) if one.code == code]
    if number >= len(found):
        raise InputError(f"the finding {code!r} has no such change; choose one on the page of the run")
    return found[number]


class _Page:
    """The new study: its name, where it starts, and what is changed."""

    def __init__(self, workspace: Workspace, folder: RunFolder, old: str, change: Change | None) -> None:
        self.workspace, self.folder, self.old, self.change = workspace, folder, old, change
        state = folder.state()
        self.best: dict[str, float] = (state.get("best") or {}).get("values") or {}
        self.name = workspace.free(study_name(folder, folder.state()) or folder.path.name)

    def build(self) -> None:
        if self.change is not None:
            code_text(f"{self.change.label}.").classes("text-lg")
        with ui.row().classes("items-center gap-4 w-full"):
            self.box = ui.input("Name of the new study", value=self.name).props("outlined").classes("w-72")
            self.start = ui.checkbox("Start from the identified values", value=self._can_start)
            self.start.set_visibility(self._can_start)
            self.start.on_value_change(self.show)
            button("Create the study", complaints()(self.create), icon="note_add")
            ui.link("Cancel", f"/run/{quote(self.folder.path.name)}")
        ui.label("Changes to the study of the run").classes("text-xl font-bold").props("role=heading aria-level=2")
        self.shown = ui.column().classes("w-full")
        self.show()

    @property
    def _can_start(self) -> bool:
        return start_from_best(tomlkit.parse(self.old), self.best)

    def text(self) -> str:
        """The new study."""
        document = tomlkit.parse(self.old)
        if self.start.value:
            start_from_best(document, self.best)
        if self.change is not None:
            self.change.apply(document)
        return tomlkit.dumps(document)

    def show(self) -> None:
        """Show what the new study changes."""
        self.shown.clear()
        found = differences(self.old, self.text())
        with self.shown:
            if found:
                show_differences(found)
            else:
                ui.label("None: the new study is a copy, with the files that it names.")

    def create(self) -> None:
        study = continued(self.workspace, self.folder, (self.box.value or "").strip(), self.text())
        ui.navigate.to(f"/study/{quote(study)}")
