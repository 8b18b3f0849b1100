"""The page of a new study, and templates as cards."""

from collections.abc import Callable
from functools import partial
from pathlib import Path
from urllib.parse import quote

from nicegui import events, ui

from dalembert.files import write_text
from dalembert.studio.frame import button, complaints, frame
from dalembert.studio.uploads import upload
from dalembert.studio.workspace import Workspace, as_text
from dalembert.study.template import Template, templates


def template_cards(
    workspace: Workspace, name: Callable[[], str], shown: Callable[[Template], bool] = lambda template: True
) -> None:
    """A card for each template that is ``shown``, with a button that begins a study from it. ``name`` returns the name
    of the study. If it is empty, the study has the name of the template, with a number if that is taken.
    """
    with ui.element("div").classes("grid grid-cols-1 sm:grid-cols-2 lg:grid-cols-3 gap-4 w-full").props("role=list"):
        for template in filter(shown, templates().values()):
            with ui.column().classes("border rounded p-3 gap-2 min-w-0").props("role=listitem"):
                picture = ui.element("img").props(f'src="/picture-of-template/{template.name}" alt="" loading=lazy')
                picture.props("width=360 height=225").classes("w-full h-40 object-contain")
                button(template.title, partial(_begin, workspace, template, name), icon="add").classes("w-full")
                ui.label(template.description).classes("text-sm break-words")


def begin(workspace: Workspace, name: str, text: str, beside: dict[str, str]) -> None:
    """Make a study with the files beside it, and go to its page."""
    with complaints("begin study"):
        study = workspace.create(name, text, partial(_write, beside))
        ui.navigate.to(f"/study/{quote(study)}")


def _write(contents: dict[str, str], folder: Path) -> None:
    for file, content in contents.items():
        write_text(folder / file, content)


def _begin(workspace: Workspace, template: Template, name: Callable[[], str]) -> None:
    begin(workspace, name() or workspace.free(template.name), template.text, template.files)


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
