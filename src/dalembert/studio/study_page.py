"""A study: its text with what is wrong at the lines, its data drawn, and the button that runs it."""

import re
import tempfile
from collections.abc import Awaitable, Callable
from functools import partial
from pathlib import Path
from urllib.parse import quote

from nicegui import events, run, ui

from dalembert.errors import DalembertError, InputError
from dalembert.report.charts.identification.measured import measured
from dalembert.studio.figures import on_any_page, plot
from dalembert.studio.frame import button, complaints, frame
from dalembert.studio.jobs import Jobs
from dalembert.studio.lines import line_of
from dalembert.studio.workspace import MOST_BYTES, Workspace, as_text
from dalembert.study import load, plan
from dalembert.study.loader import StudyError
from dalembert.study.study import Study
from dalembert.study.template import templates

AFTER = 0.4  # s after the last key until the text is read
WRONG = "wrong"  # the class of lines with mistakes; frame.LOOKS
DATA = ".csv,.txt,.dat,.parquet,.mat,.uff,.unv,.nc,.npz"


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

        _upload("Choose a study file (.toml)", ".toml", uploaded)


def study_page(workspace: Workspace, jobs: Jobs, name: str) -> None:
    """Edit, check and run a study."""
    try:
        path = workspace.study(name)
    except InputError as error:
        with frame("No such study"):
            ui.label(str(error))
        return
    with frame(name):
        with ui.row().classes("gap-2 items-center"):
            start = button("Run", complaints()(lambda: _start(workspace, jobs, path, editor.value)), icon="play_arrow")
            button("Save", complaints()(lambda: _save(workspace, path, editor.value)), icon="save")
            verdict = ui.label("").props("role=status aria-live=polite")
        does = ui.label("").classes("break-words")
        wrong = ui.column().classes("gap-1 w-full")
        text = path.read_text(encoding="utf-8")
        editor = ui.codemirror(text, language="TOML", theme="vscodeLight", line_wrapping=True)
        editor.classes("w-full border rounded").props("aria-label='The study as text'").style("height: 60vh")
        drawn = ui.column().classes("w-full")

        async def adapt() -> None:
            if await ui.run_javascript("matchMedia('(prefers-color-scheme: dark)').matches"):
                editor.set_theme("vscodeDark")

        ui.timer(0.0, adapt, once=True)

        async def look() -> None:
            text = editor.value
            study, does_what, mistakes = await run.io_bound(_read, path, text) or (None, "", [])
            _tell(editor, wrong, text, mistakes)
            verdict.set_text("Valid." if study else f"{len(mistakes)} error{'s' if len(mistakes) > 1 else ''}:")
            does.set_text(does_what)
            start.set_enabled(study is not None)
            drawn.clear()
            if study is not None and study.file.data is not None:
                with drawn:
                    await _draw(study)

        waiting = ui.timer(AFTER, look, once=True)

        def changed() -> None:
            nonlocal waiting
            waiting.cancel()
            waiting = ui.timer(AFTER, look, once=True)

        editor.on_value_change(changed)

        async def uploaded(event: events.UploadEventArguments) -> None:
            with complaints():
                placed = workspace.put(name, event.file.name, await event.file.read())
                ui.notify(f"{placed.name} lies beside the study now: name it in [data].", type="positive")
                await look()

        _upload("Add measured data", DATA, uploaded)


def _upload(label: str, kinds: str, uploaded: Callable[[events.UploadEventArguments], Awaitable[None]]) -> None:
    """A field that takes files of some kinds."""
    upload = ui.upload(label=label, auto_upload=True, on_upload=uploaded, max_file_size=MOST_BYTES)
    upload.props(f'accept="{kinds}" flat bordered').classes("w-full max-w-md")


def _read(path: Path, text: str) -> tuple[Study | None, str, list[tuple[int, str]]]:
    """The study that a text is and what it does, or its mistakes with the numbers of their lines."""
    with tempfile.TemporaryDirectory() as folder:
        draft = Path(folder) / path.name
        try:
            draft.write_text(text, encoding="utf-8")
            study = load(draft, name=path.stem, folder=path.parent)
            return study, f"It {plan(study)}.", []
        except StudyError as error:
            return None, "", [(line_of(text, place), sentence) for place, sentence in error.mistakes]
        except DalembertError as error:
            sentence = str(error).replace(f"{draft}: ", "").replace(f"{draft}", path.name)
            return None, "", [(_line_in(sentence), sentence)]


def _line_in(sentence: str) -> int:
    """The line that a sentence of the TOML reader names."""
    found = re.search(r"\bline (\d+)", sentence)
    return int(found[1]) if found else 1


def _tell(editor: ui.codemirror, wrong: ui.column, text: str, mistakes: list[tuple[int, str]]) -> None:
    """Mark the lines with mistakes, and list them, each with a button to its line."""
    lines = max(1, len(text.splitlines()))
    editor.decorations = [
        {"kind": "line", "line": line, "class": WRONG} for line in sorted({min(line, lines) for line, _ in mistakes})
    ]
    wrong.clear()
    with wrong:
        for line, sentence in mistakes:
            with ui.row().classes("items-start gap-2 flex-nowrap").props("role=alert"):
                go = ui.button(f"line {line}", on_click=partial(editor.reveal_line, line), color="negative")
                go.props("dense no-caps unelevated size=sm").classes("shrink-0")
                ui.label(sentence).classes("text-sm break-words")


async def _draw(study: Study) -> None:
    """The measured data as the study reads them."""
    try:
        data = await run.io_bound(study.data)
        if data is None:  # the studio is ending
            return
    except DalembertError as error:
        ui.label(str(error)).classes("text-negative").props("role=alert")
        return
    ui.label("Measured data").classes("text-xl font-bold").props("role=heading aria-level=2")
    plot(on_any_page(measured(data))).classes("w-full h-80").props('role=img aria-label="Measured data"')


def _save(workspace: Workspace, path: Path, text: str) -> None:
    workspace.write(path, text)
    ui.notify("Saved.", type="positive")


def _start(workspace: Workspace, jobs: Jobs, path: Path, text: str) -> None:
    """Save, run in a process of its own, and go to the run's page."""
    _save(workspace, path, text)
    folder = workspace.new_run(load(path).name if path.stem != "study" else path.parent.name)
    folder.parent.mkdir(exist_ok=True)
    jobs.start(path, folder)
    ui.navigate.to(f"/run/{quote(folder.name)}")
