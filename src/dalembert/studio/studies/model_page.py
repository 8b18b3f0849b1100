"""The model of a study in a separate file: its text, drawn and checked as the model of this study."""

from functools import partial
from urllib.parse import quote

from nicegui import ui

from dalembert.errors import InputError
from dalembert.studio.code_text import code_text
from dalembert.studio.editor.draft import Draft
from dalembert.studio.editor.model_reading import model_reading, study_with_model
from dalembert.studio.editor.text_editor import TextEditor
from dalembert.studio.frame import complaints, frame
from dalembert.studio.layout import splitter, tabs
from dalembert.studio.panels import forms, model
from dalembert.studio.studies.checking import Checking
from dalembert.studio.studies.text_head import text_head
from dalembert.studio.worker import Worker
from dalembert.studio.workspace import Workspace
from dalembert.study.schema_file import MODEL_FILE


def model_page(workspace: Workspace, name: str) -> None:
    """Edit, draw and check the model file that a study names."""
    title = name.removesuffix("/study")
    try:
        study, path = workspace.study(name), workspace.model_of(name)
        draft = Draft(path)
    except InputError as error:
        with frame("No such model"):
            code_text(str(error)).props("role=alert")
        return
    worker = Worker()
    worker.start()
    ui.context.client.on_delete(worker.stop)
    with frame(f"{path.name} of {title}", wide=True):
        head = ui.column().classes("w-full gap-1")
        with splitter("Width of the text") as (left, right):
            with left:
                editor = TextEditor(draft, "The model as text", MODEL_FILE)
            with right:
                tabs(
                    [
                        (*model.TAB, partial(model.ModelPanel, draft, worker, study, study_with_model)),
                        (*forms.TAB, partial(forms.show_tables, draft, MODEL_FILE)),
                    ]
                )
        with head:
            text_head(draft, editor, partial(_way_back, name, title), complaints()(partial(_copy, draft, study.name)))
            Checking(draft, worker, model_reading, study)


def model_address(name: str) -> str:
    """Return the address of the page of a study's model."""
    return f"/study/{quote(name)}/model"


def _way_back(name: str, title: str) -> None:
    ui.link(f"Study {title}", f"/study/{quote(name)}").classes("break-all")


def _copy(draft: Draft, study: str) -> None:
    """Write the text to a new file; the page then shows the text of its file."""
    copy = draft.save_copy()
    draft.reload()
    ui.notify(f"Saved as {copy.name}. Write this name at file in {study} to use it.", timeout=0, close_button="Close")
