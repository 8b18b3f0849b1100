"""A study: its text on the left, panels that show it on the right, and the button that runs it."""

from functools import partial
from urllib.parse import quote

from nicegui import ui

from dalembert.errors import InputError
from dalembert.studio.code_text import code_text
from dalembert.studio.editor.cursor import tolerant
from dalembert.studio.editor.draft import Draft
from dalembert.studio.editor.model_kind import model_file
from dalembert.studio.editor.text_editor import TextEditor
from dalembert.studio.frame import button, complaints, frame
from dalembert.studio.jobs import Jobs
from dalembert.studio.layout import splitter, tabs
from dalembert.studio.page_services import PageServices
from dalembert.studio.panels import data, forms, model, sliders
from dalembert.studio.studies.checking import Checking
from dalembert.studio.studies.model_page import model_address
from dalembert.studio.studies.text_head import save_text, text_head
from dalembert.studio.worker import Worker
from dalembert.studio.workspace import Workspace

PANELS = (
    (*model.TAB, model.show),
    (*forms.TAB, forms.show),
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
            code_text(str(error)).props("role=alert")
        return
    services = PageServices(workspace, jobs, Worker())
    services.worker.start()
    ui.context.client.on_delete(services.worker.stop)
    with frame(name.removesuffix("/study"), wide=True):
        head = ui.column().classes("w-full gap-1")
        with splitter("Width of the text") as (left, right):
            with left:
                editor = TextEditor(draft)
            with right:
                tabs([(name, title, icon, partial(show, draft, services)) for name, title, icon, show in PANELS])
        with head:
            _head(draft, services, editor, Checking(draft, services.worker))


def _head(draft: Draft, services: PageServices, editor: TextEditor, checking: Checking) -> None:
    text_head(draft, editor, partial(_run_button, draft, services, checking), complaints()(partial(_copy, draft)))
    way = ui.link("", model_address(draft.name)).classes("break-all")

    def show_way() -> None:
        file = model_file(tolerant(draft.saved))
        way.set_text(f"Open the model file {file}")
        way.set_visibility(bool(file))

    draft.follow("text", show_way)
    show_way()


def _run_button(draft: Draft, services: PageServices, checking: Checking) -> None:
    """Build the button that runs the study, while it has no mistakes."""
    start = button("Run", lambda: _start(draft, services, checking), icon="play_arrow")
    draft.follow("mistakes", lambda: start.set_enabled(draft.study is not None))


def _copy(draft: Draft) -> None:
    """Write the text to a new file and go to its page; the page that is left has the text of its file."""
    copy = draft.save_copy()
    draft.reload()
    ui.navigate.to(f"/study/{quote(copy.parent.name)}/{quote(copy.stem)}")


async def _start(draft: Draft, services: PageServices, checking: Checking) -> None:
    """Save, run in a separate process, and go to the run's page."""
    if draft.reading.text != draft.text:
        await checking.check()
    with complaints("save"):
        save_text(draft)
        if draft.study is not None:
            name = draft.study.name if draft.path.stem != "study" else draft.path.parent.name
            folder = services.workspace.new_run(name)
            folder.parent.mkdir(exist_ok=True)
            services.jobs.start(draft.path, folder)
            ui.navigate.to(f"/run/{quote(folder.name)}")
