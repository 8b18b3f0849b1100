"""The notice on a study's page that its file was changed by somebody else, and what can be done then."""

from collections.abc import Callable

from nicegui import ui

from dalembert.studio.editor.draft import Draft
from dalembert.studio.frame import button, complaints, tipped

EVERY = 1.0  # s between two looks at the file
SAYS = {
    "changed": "{file} changed on disk, and the text here has changes too. Nothing was overwritten.",
    "gone": "{file} was deleted or moved. Save writes it again.",
}


def disk_notice(draft: Draft, copied: Callable[[], object]) -> None:
    """Build the notice, which is hidden while the file is what was read or saved.

    A text without unsaved changes follows the file; undo brings the earlier text back.

    Parameters
    ----------
    draft : Draft
    copied : callable
        Saves the text as a copy.
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
