"""The studies as cards: the user's own, templates to start from, and examples."""

from urllib.parse import quote

from nicegui import run, ui

from dalembert.studio.frame import badge, button, frame
from dalembert.studio.studies.new_page import template_cards
from dalembert.studio.studies.study_list import Entry, StudyFolder, has_words, study_folders
from dalembert.studio.workspace import Workspace
from dalembert.study.template import Template, templates

SHOWN = 24
"""Cards of a section at first; a button shows more."""
GRID = "grid grid-cols-1 sm:grid-cols-2 lg:grid-cols-3 gap-4 w-full"


def studies_page(workspace: Workspace) -> None:
    """Studies of the workspace, templates and examples."""
    with frame("Studies"):
        with ui.row().classes("w-full items-center gap-4"):
            search = ui.input("Search studies").classes("grow max-w-md").props("outlined dense clearable type=search")
            button("New study", lambda: ui.navigate.to("/new"), icon="add")

        def matches(template: Template) -> bool:
            return has_words((template.name, template.title, template.description), search.value or "")

        @ui.refreshable
        def listed(folders: list[StudyFolder] | None) -> None:
            if folders is None:
                ui.spinner(size="lg").props('aria-label="The studies are read"')
                return
            matching = [folder for folder in folders if folder.matches(search.value or "")]
            of_user = [folder for folder in matching if not folder.example]
            examples = [folder for folder in matching if folder.example]
            heading("Your studies")
            none = "None of these matches the search." if search.value else "None yet. Start from a template."
            _cards(of_user, none)
            if any(map(matches, templates().values())):
                heading("Templates")
                template_cards(workspace, lambda: "", matches)
            if examples:
                heading("Examples")
                ui.label("Studies with known results, which tests check.").classes("text-sm")
                _cards(examples, "")

        async def look() -> None:
            listed.refresh(await run.io_bound(study_folders, workspace) or [])

        listed(None)
        search.on_value_change(lambda: listed.refresh())  # noqa: PLW0108  the event is no list of folders
        ui.timer(0.0, look, once=True)


def heading(text: str) -> None:
    """The heading of a part of the page."""
    ui.label(text).classes("text-xl font-bold mt-2").props("role=heading aria-level=2")


def picture(address: str) -> None:
    """The picture at an address of the studio, which is loaded when it is first seen."""
    shown = ui.element("img").props(f'src="{address}" alt="" loading=lazy width=360 height=225')
    shown.classes("w-full h-40 object-contain")


def _cards(folders: list[StudyFolder], none: str) -> None:
    if not folders:
        ui.label(none)
        return
    grid, waiting = ui.element("div").classes(GRID).props("role=list"), list(folders)

    def add() -> None:
        with grid:
            for folder in waiting[:SHOWN]:
                _card(folder)
        del waiting[:SHOWN]
        more.set_text(f"Show {min(SHOWN, len(waiting))} of {len(waiting)} more")
        more.set_visibility(bool(waiting))

    more = button("", add, icon="expand_more")
    add()


def _card(folder: StudyFolder) -> None:
    """Picture, title, description and states of a folder with studies."""
    first, *more = folder.entries
    with ui.column().classes("border rounded p-3 gap-2 min-w-0").props("role=listitem"):
        with ui.link(target=f"/study/{quote(first.name)}").classes("w-full font-bold break-words"):
            picture(f"/picture/{quote(first.name)}")
            ui.label(folder.title)
        if folder.title != folder.name:
            ui.label(folder.name).classes("text-xs opacity-80 break-all")
        ui.label(folder.description).classes("text-sm break-words line-clamp-4")
        ui.space()
        if not more:
            _state(first)
            return
        _entry(first)
        with ui.element("details").classes("w-full text-sm"):
            with ui.element("summary").classes("cursor-pointer"):
                ui.label(f"{len(more)} more {'study' if len(more) == 1 else 'studies'}").classes("inline")
            for entry in more:
                _entry(entry)


def _entry(entry: Entry) -> None:
    """One study of a folder with several."""
    with ui.column().classes("gap-1 w-full border-t py-1"):
        ui.link(entry.heading, f"/study/{quote(entry.name)}").classes("text-sm break-words")
        _state(entry)


def _state(entry: Entry) -> None:
    """The task of a study, and its last run."""
    with ui.row().classes("items-center gap-2 text-xs w-full"):
        ui.label(entry.task.replace("_", " ") or "has errors")
        if entry.last is None:
            ui.label("not run yet").classes("opacity-80")
        else:
            badge(entry.last.state)
            ui.link(f"{entry.last.name}, {entry.last.since} UTC", f"/run/{quote(entry.last.name)}").classes("break-all")
