"""The head of the text of a study: what is wrong, what was run, and changes on the disk."""

from collections.abc import Callable
from functools import partial

from nicegui import ui

from dalembert.studio.editor.draft import Draft
from dalembert.studio.editor.text_editor import TextEditor
from dalembert.studio.frame import button, complaints, icon_button, tipped
from dalembert.studio.pacing import Latest
from dalembert.studio.runs.findings_list import finding_row

EVERY = 1.0  # s between two looks at the file
SAYS = {
    "changed": "{file} changed on disk, and the text here has changes too. Nothing was overwritten.",
    "gone": "{file} was deleted or moved. Save writes it again.",
}


def disk_notice(draft: Draft, copied: Callable[[], object]) -> None:
    """Build the notice, which is hidden while the file is what was read or saved. A text without unsaved changes
    follows the file; undo brings the earlier text back. ``copied`` saves the text as a copy.
    """
    with ui.row().classes("w-full items-center gap-2 p-2 rounded border disk-notice").props("role=alert") as notice:
        ui.icon("sync_problem", size="sm")
        says = ui.label("").classes("grow basis-60")
        choices = ui.row().classes("gap-2")
        with choices:
            tipped(
                button("Reload", complaints()(draft.reload), icon="refresh"),
                "Take the text of the file. Undo brings back the text that is here.",
            )
            tipped(
                button("Keep mine", complaints()(draft.keep), icon="edit"),
                "Keep the text that is here. The next Save replaces the file.",
            )
            tipped(
                button("Save as a copy", copied, icon="content_copy"),
                "Write the text that is here to a new file in the same folder.",
            )

    def show() -> None:
        if draft.disk == "changed" and draft.is_saved:
            with notice, complaints("follow file"):
                draft.reload()
                ui.notify(
                    f"{draft.path.name} changed on disk: the text shows the new content. Undo brings back the old."
                )
        notice.set_visibility(draft.disk != "same")
        choices.set_visibility(draft.disk == "changed")
        says.set_text(SAYS.get(draft.disk, "").format(file=draft.path.name))

    draft.follow("disk", show)
    show()
    ui.timer(EVERY, draft.check_disk)
    ui.timer(EVERY, draft.check_files)


CHECKING = "Checking …"
SLOW = 1.0
"""Seconds after a change from which a check is announced."""


def text_head(draft: Draft, editor: TextEditor, first: Callable[[], object], copied: Callable[[], object]) -> None:
    """Build the buttons, what the text does, and its mistakes. ``first`` builds what comes before the buttons.
    ``copied`` saves the text as a copy, after a conflict.
    """
    with ui.row().classes("gap-2 items-center"):
        first()
        save = button("Save", complaints("save")(lambda: save_text(draft)), icon="save")
        undo, redo = icon_button("undo", "Undo", draft.undo), icon_button("redo", "Redo", draft.redo)
        verdict = ui.label(CHECKING).props("role=status aria-live=polite")
    disk_notice(draft, copied)  # after the buttons, which come first by keyboard
    does = ui.label("").classes("break-words")
    doubts = ui.column().classes("gap-1 w-full").props("role=list aria-label=Findings")
    wrong = ui.column().classes("gap-1 w-full")
    editor.element.map_key("Mod-s", complaints("save")(lambda: save_text(draft)))

    def show_text() -> None:
        undo.set_enabled(draft.can_undo)
        redo.set_enabled(draft.can_redo)
        save.set_text("Save" if draft.is_saved else "Save •")

    def show_study() -> None:
        count = len(draft.mistakes)
        verdict.set_text(f"{count} error{'s' if count > 1 else ''}:" if count else "Valid.")
        does.set_text(draft.reading.does)
        doubts.clear()
        doubts.set_visibility(bool(draft.reading.findings))
        with doubts:
            for finding in draft.reading.findings:
                finding_row(finding.severity, finding.message, finding.advice)
        wrong.clear()
        with wrong:
            for mistake in draft.mistakes:
                with ui.row().classes("items-start gap-2 flex-nowrap").props("role=alert"):
                    go = ui.button(f"line {mistake.line}", on_click=partial(editor.go, mistake.line), color="negative")
                    go.props("dense no-caps unelevated size=sm").classes("shrink-0")
                    ui.label(mistake.sentence).classes("text-sm break-words")

    async def show_wait() -> None:
        if draft.reading.text != draft.text:
            verdict.set_text(CHECKING)

    draft.follow("text", show_text)
    draft.follow("text", Latest(show_wait, SLOW))
    draft.follow("mistakes", show_study)
    show_text()


def save_text(draft: Draft) -> None:
    """Write the text to its file, and say so."""
    draft.save()
    ui.notify("Saved.", type="positive")
