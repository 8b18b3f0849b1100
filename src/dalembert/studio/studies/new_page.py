"""The page to begin a study: from a template, or from a file."""

from pathlib import Path

from nicegui import events, ui

from dalembert.studio.frame import complaints, frame
from dalembert.studio.studies.template_cards import begin, template_cards
from dalembert.studio.uploads import upload
from dalembert.studio.workspace import Workspace, as_text


def new_page(workspace: Workspace) -> None:
    """Begin a study: from a template, or from a file."""
    with frame("New study"):
        name = ui.input("Name (optional)", placeholder="my-pendulum")
        name.classes("w-full max-w-md").props("outlined")

        def chosen() -> str:
            return (name.value or "").strip()

        ui.label("Start from a template").classes("text-xl font-bold").props("role=heading aria-level=2")
        template_cards(workspace, chosen)
        ui.label("Open a study file").classes("text-xl font-bold").props("role=heading aria-level=2")

        async def uploaded(event: events.UploadEventArguments) -> None:
            with complaints("begin study from file"):
                text = as_text(await event.file.read(), event.file.name)
                begin(workspace, chosen() or workspace.free(Path(event.file.name).stem), text, {})

        upload("Choose a study file (.toml)", ".toml", uploaded)
