"""A study: its text on the left, panels that show it on the right, and the button that runs it."""

from functools import partial
from urllib.parse import quote

from nicegui import ui

from dalembert.errors import InputError
from dalembert.studio.editor.disk_notice import disk_notice
from dalembert.studio.editor.draft import Draft
from dalembert.studio.editor.text_editor import TextEditor
from dalembert.studio.frame import button, complaints, frame, icon_button
from dalembert.studio.jobs import Jobs
from dalembert.studio.panels import data, forms, model, sliders
from dalembert.studio.room import Room
from dalembert.studio.splitter import splitter
from dalembert.studio.studies.checking import Checking
from dalembert.studio.worker import Worker
from dalembert.studio.workspace import Workspace

PANELS = (
    ("model", "Model", "precision_manufacturing", model.show),
    ("forms", "Forms", "edit_note", forms.show),
    ("sliders", "Sliders", "tune", sliders.show),
    ("data", "Data", "show_chart", data.show),
)
"""Name, title, icon and function of each panel."""


def study_page(workspace: Workspace, jobs: Jobs, name: str) -> None:
    """Edit, check and run a study."""
    path = None
    try:
        path = workspace.study(name)
        draft = Draft(path)
    except InputError as error:
        with frame("No such study" if path is None else name.removesuffix("/study")):
            ui.label(str(error)).props("role=alert")
        return
    room = Room(workspace, jobs, Worker())
    room.worker.start()
    ui.context.client.on_delete(room.worker.stop)
    with frame(name.removesuffix("/study"), wide=True):
        head = ui.column().classes("w-full gap-1")
        with splitter("Width of the text") as (left, right):
            with left:
                editor = TextEditor(draft)
            with right:
                _panels(draft, room)
        with head:
            _head(draft, room, editor, Checking(draft, room.worker))


def _panels(draft: Draft, room: Room) -> None:
    """Build a tab for each panel."""
    with (
        ui.tabs().props("dense no-caps inline-label align=left outside-arrows mobile-arrows").classes("w-full") as tabs
    ):
        for name, title, icon, _ in PANELS:
            ui.tab(name, title, icon)
    with ui.tab_panels(tabs, value=PANELS[0][0], animated=False).classes("w-full grow bg-transparent"):
        for name, _, _, show in PANELS:
            with ui.tab_panel(name).style("padding: 4px 0"):
                show(draft, room)


def _head(draft: Draft, room: Room, editor: TextEditor, checking: Checking) -> None:
    """Build the buttons, what the study does, and its mistakes."""
    with ui.row().classes("gap-2 items-center"):
        start = button("Run", lambda: _start(draft, room, checking), icon="play_arrow")
        save = button("Save", complaints()(lambda: _save(draft)), icon="save")
        undo, redo = icon_button("undo", "Undo", draft.undo), icon_button("redo", "Redo", draft.redo)
        verdict = ui.label("").props("role=status aria-live=polite")
    disk_notice(draft)  # after the buttons, which come first by keyboard
    does = ui.label("").classes("break-words")
    wrong = ui.column().classes("gap-1 w-full")
    editor.element.map_key("Mod-s", complaints()(lambda: _save(draft)))

    def show_text() -> None:
        undo.set_enabled(draft.can_undo)
        redo.set_enabled(draft.can_redo)
        save.set_text("Save" if draft.is_saved else "Save •")

    def show_study() -> None:
        count = len(draft.mistakes)
        verdict.set_text(f"{count} error{'s' if count > 1 else ''}:" if count else "Valid.")
        does.set_text(draft.reading.does)
        start.set_enabled(draft.study is not None)
        wrong.clear()
        with wrong:
            for mistake in draft.mistakes:
                with ui.row().classes("items-start gap-2 flex-nowrap").props("role=alert"):
                    go = ui.button(f"line {mistake.line}", on_click=partial(editor.go, mistake.line), color="negative")
                    go.props("dense no-caps unelevated size=sm").classes("shrink-0")
                    ui.label(mistake.sentence).classes("text-sm break-words")

    draft.follow("text", show_text)
    draft.follow("mistakes", show_study)
    show_text()


def _save(draft: Draft) -> None:
    draft.save()
    ui.notify("Saved.", type="positive")


async def _start(draft: Draft, room: Room, checking: Checking) -> None:
    """Save, run in a process of its own, and go to the run's page."""
    if draft.reading.text != draft.text:
        await checking.check()
    with complaints():
        _save(draft)
        if draft.study is not None:
            name = draft.study.name if draft.path.stem != "study" else draft.path.parent.name
            folder = room.workspace.new_run(name)
            folder.parent.mkdir(exist_ok=True)
            room.jobs.start(draft.path, folder)
            ui.navigate.to(f"/run/{quote(folder.name)}")
