"""The first page: all runs in a table, with what can be done to them."""

import asyncio
from collections.abc import Callable
from functools import partial
from urllib.parse import quote, urlencode

from nicegui import run, ui

from dalembert.errors import DalembertError, unchanged
from dalembert.studio.frame import button, complaints, frame
from dalembert.studio.jobs import Jobs
from dalembert.studio.runs.run_changes import Deleted, delete, empty_trash, rename, restore, trashed
from dalembert.studio.runs.run_grid import RunGrid
from dalembert.studio.runs.run_list import Row, RunList
from dalembert.studio.runs.run_note import Note, read_note, tags_of, write_note
from dalembert.studio.runs.study_runs import run_again
from dalembert.studio.workspace import Workspace
from dalembert.study.run.folder import RESUMABLE

EVERY = 2.0  # s between two looks at the folder
PATIENCE = 1.0  # s that the page waits for its rows; later ones are shown when they are read
HINT = "In the table: arrow keys move, Space selects, Enter opens, F2 renames or edits a note, Delete deletes."


async def runs_page(workspace: Workspace, jobs: Jobs, listed: RunList) -> None:
    """Runs of the workspace."""
    with frame("Runs", most="max-w-screen-2xl"):
        reading = asyncio.ensure_future(run.io_bound(listed.rows))
        await asyncio.wait([reading], timeout=PATIENCE)
        page = _Page(workspace, jobs, listed, reading.result() if reading.done() else listed.known or None)
        page.build()
        ui.timer(EVERY, page.look)


class _Page:
    """The table of runs, and the actions on the selected ones."""

    def __init__(self, workspace: Workspace, jobs: Jobs, listed: RunList, rows: list[Row] | None) -> None:
        self.workspace, self.jobs, self.listed, self.rows = workspace, jobs, listed, rows or []
        self.is_read = rows is not None
        self.selected: list[str] = []
        self.deleted: list[Deleted] = []
        self.actions: list[tuple[ui.button, Callable[[list[Row]], bool]]] = []

    def build(self) -> None:
        self.reading = ui.spinner(size="lg").props('aria-label="The runs are read"')
        self.empty = ui.row().classes("items-center")
        with self.empty:
            ui.label("No runs yet. Create a study, or open one under Studies, and run it.")
            button("New study", lambda: ui.navigate.to("/new"), icon="add")
        self.tools = ui.column().classes("w-full gap-2")
        with self.tools:
            self._toolbar()
            self.undo_row = ui.row().classes("items-center gap-2").props("role=status")
            self.grid = RunGrid(self.rows, self.select, self.press, self.change)
            ui.label(HINT).classes("text-xs opacity-70")
            self.about = ui.column().classes("w-full gap-1")
        self._show()

    def _toolbar(self) -> None:
        with ui.row().classes("w-full items-center gap-1"):
            box = ui.input(placeholder="Search", on_change=lambda event: self.grid.search(event.value or ""))
            box.props('dense outlined clearable aria-label="Search runs"').classes("w-56 mr-2")
            with box.add_slot("prepend"):
                ui.icon("search").props("aria-hidden=true")
            self._action("Open", "open_in_new", self.open, lambda rows: len(rows) == 1)
            self._action("Compare", "compare_arrows", self.compare, lambda rows: len(rows) > 1)
            self._action("Rename", "edit", self.ask_name, lambda rows: len(rows) == 1 and not _running(rows))
            self._action("Run again", "replay", self.rerun, bool)
            self._action(
                "Resume", "play_arrow", self.resume, lambda rows: any(row["state"] in RESUMABLE for row in rows)
            )
            self._action("Continue as a new study", "note_add", self.go_on, lambda rows: len(rows) == 1)
            self._action("Delete", "delete", self.delete, lambda rows: bool(rows) and not _running(rows))
            ui.space()
            self.trash = ui.button("Trash", on_click=self.show_trash, icon="restore_from_trash")
            self.trash.props("flat dense no-caps")

    def _action(self, name: str, icon: str, action: Callable[[], object], fits: Callable[[list[Row]], bool]) -> None:
        """A button that is enabled while it fits the selected rows."""
        made = ui.button(name, on_click=complaints()(action), icon=icon).props("flat dense no-caps").classes("px-2")
        self.actions.append((made, fits))

    # what the page shows

    async def look(self) -> None:
        """Bring the table up to what the folder holds."""
        rows = await run.io_bound(self.listed.rows)
        if rows is None:  # the studio is ending
            return
        self.grid.show(rows)
        if rows != self.rows or not self.is_read:
            self.rows, self.is_read = rows, True
            self._show()

    def _show(self) -> None:
        """Show what depends on the rows and on those that are selected."""
        names = {row["run"] for row in self.rows}
        self.selected = [name for name in self.selected if name in names]
        chosen = self._chosen()
        trash = trashed(self.workspace)
        self.reading.set_visibility(not self.is_read)
        self.empty.set_visibility(self.is_read and not self.rows)
        self.tools.set_visibility(bool(self.rows or trash))
        self.trash.set_visibility(bool(trash))
        self.trash.set_text(f"Trash ({len(trash)})")
        for made, fits in self.actions:
            made.set_enabled(fits(chosen))
        self.undo_row.set_visibility(bool(self.deleted))
        self.about.clear()
        if len(chosen) == 1:
            with self.about:
                # The table has no room for how the run ended, and why its result is in doubt.
                for text in filter(None, (chosen[0]["message"], *chosen[0]["doubts"])):
                    ui.label(text).classes("text-sm break-words")

    def _chosen(self) -> list[Row]:
        return [row for row in self.rows if row["run"] in self.selected]

    # what the user does

    def select(self, names: list[str]) -> None:
        self.selected = names
        self._show()

    async def press(self, key: str, number: str) -> None:
        """Do what a key in the row with a number means."""
        await self.look()
        name = next((row["run"] for row in self.rows if row["id"] == number), None)
        if name is None:
            return
        if key == "Enter":
            ui.navigate.to(f"/run/{quote(name)}")
        else:
            with complaints("delete"):
                self._delete(self.selected if name in self.selected else [name])

    async def change(self, name: str, field: str, text: str) -> None:
        """Take what the user entered into a cell."""
        with complaints(("change", field)):
            if field == "run":
                await self.rename(name, text.strip())
                return
            folder = self.workspace.run(name).path
            note = read_note(folder)
            write_note(folder, Note(note.text, tags_of(text)) if field == "tags" else Note(text.strip(), note.tags))
        await self.look()

    def open(self) -> None:
        ui.navigate.to(f"/run/{quote(self.selected[0])}")

    def compare(self) -> None:
        ui.navigate.to(f"/compare?{urlencode({'run': self.selected}, doseq=True)}")

    def go_on(self) -> None:
        ui.navigate.to(f"/continue/{quote(self.selected[0])}")

    def ask_name(self) -> None:
        (name,) = self.selected
        with ui.dialog() as dialog, ui.card().classes("w-96"):
            ui.label(f"Rename {name}").classes("text-lg font-bold break-all").props("role=heading aria-level=2")
            box = ui.input("New name", value=name).classes("w-full").props("autofocus outlined hide-bottom-space")
            box.on_value_change(lambda: setattr(box, "error", None))

            async def done() -> None:
                try:
                    await self.rename(name, (box.value or "").strip())
                except (DalembertError, OSError) as error:  # the dialog stays, with what was typed
                    box.error = unchanged(error)
                else:
                    dialog.close()

            box.on("keydown.enter", done)
            with ui.row().classes("w-full justify-end gap-2"):
                ui.button("Cancel", on_click=dialog.close).props("flat no-caps")
                button("Rename", done, icon="edit")
        dialog.open()

    async def rename(self, old: str, new: str) -> None:
        if new != old:
            rename(self.workspace, old, new)
            self.selected = [new if name == old else name for name in self.selected]
            await self.look()

    async def rerun(self) -> None:
        """Run the studies of the selected runs again."""
        started = [run_again(self.workspace, self.jobs, name) for name in self.selected]
        if len(started) == 1:
            ui.navigate.to(f"/run/{quote(started[0])}")
        else:
            ui.notify(f"{len(started)} runs started.", type="positive")

    def resume(self) -> None:
        for row in filter(lambda row: row["state"] in RESUMABLE, self._chosen()):
            self.jobs.resume(self.workspace.run(row["run"]).path)

    async def delete(self) -> None:
        self._delete(self.selected)
        await self.look()

    def _delete(self, names: list[str]) -> None:
        self.deleted = []
        try:
            for name in list(names):
                self.deleted.append(delete(self.workspace, name))
        finally:
            self._offer_undo()

    def _offer_undo(self) -> None:
        count = len(self.deleted)
        self.undo_row.clear()
        if count:
            with self.undo_row:
                ui.label(f"{self.deleted[0].name} is deleted." if count == 1 else f"{count} runs are deleted.")
                button("Undo", self.undo, icon="undo")
        self.undo_row.set_visibility(bool(count))

    async def undo(self) -> None:
        with complaints("undo"):
            for one in self.deleted:
                restore(self.workspace, one)
        self.deleted = []
        self._offer_undo()
        await self.look()

    def show_trash(self) -> None:
        """List the deleted runs, to restore them or to remove them for good."""
        with ui.dialog() as dialog, ui.card().classes("w-[32rem] max-w-full"):
            ui.label("Deleted runs").classes("text-lg font-bold").props("role=heading aria-level=2")
            with ui.column().classes("w-full gap-1 max-h-96 overflow-y-auto"):
                for one in trashed(self.workspace):
                    with ui.row().classes("w-full items-center no-wrap"):
                        ui.label(one.name).classes("grow break-all")
                        again = ui.button("Restore", on_click=partial(self._restore, one, dialog), icon="undo")
                        again.props(f'flat dense no-caps aria-label="Restore {_attribute(one.name)}"')
            with ui.row().classes("w-full justify-end gap-2"):
                button("Remove all for good", partial(self._empty, dialog), icon="delete_forever", colour="negative")
                ui.button("Close", on_click=dialog.close).props("flat no-caps")
        dialog.open()

    async def _restore(self, one: Deleted, dialog: ui.dialog) -> None:
        dialog.close()
        with complaints("restore"):
            restore(self.workspace, one)
        await self.look()

    async def _empty(self, dialog: ui.dialog) -> None:
        dialog.close()
        with complaints("empty trash"):
            count = empty_trash(self.workspace)
            ui.notify(f"{count} run{'s' * (count > 1)} removed.", type="positive")
        self.deleted = []
        self._offer_undo()
        self._show()


def _running(rows: list[Row]) -> bool:
    return any(row["state"] == "running" for row in rows)


def _attribute(text: str) -> str:
    """A text inside an attribute in double quotes."""
    return text.replace("\\", "").replace('"', "'")
