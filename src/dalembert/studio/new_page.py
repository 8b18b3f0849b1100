"""The page to begin a study: from a template, or from a file."""

from functools import partial
from pathlib import Path
from urllib.parse import quote

from nicegui import events, ui

from dalembert.studio.frame import button, complaints, frame
from dalembert.studio.uploads import upload
from dalembert.studio.workspace import Workspace, as_text
from dalembert.study.template import templates


def new_page(workspace: Workspace) -> None:
    """Begin a study: from a template, or from a file."""
    with frame("New study"):
        name = ui.input("Name (optional)", placeholder="my-pendulum")
        name.classes("w-full max-w-md").props("outlined")

        def create(text: str, beside: dict[str, str], otherwise: str) -> None:
            with complaints():
                study = workspace.create(name.value or workspace.free(otherwise), text)
                for file, content in beside.items():
                    workspace.put(study, file, content.encode())
                ui.navigate.to(f"/study/{quote(study)}")

        ui.label("Start from a template").classes("text-xl font-bold").props("role=heading aria-level=2")
        with ui.element("div").classes("grid grid-cols-1 sm:grid-cols-2 gap-3 w-full"):
            for one in templates().values():
                with ui.column().classes("border rounded p-3 gap-2"):
                    button(one.title, partial(create, one.text, one.beside, one.name), icon="description")
                    ui.label(one.description).classes("text-sm")
        ui.label("Open a study file").classes("text-xl font-bold").props("role=heading aria-level=2")

        async def uploaded(event: events.UploadEventArguments) -> None:
            with complaints():
                create(as_text(await event.file.read(), event.file.name), {}, Path(event.file.name).stem)

        upload("Choose a study file (.toml)", ".toml", uploaded)
