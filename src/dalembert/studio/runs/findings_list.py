"""The findings of a run with their advice, and buttons where the advice is a change to the study."""

from collections import Counter
from functools import partial
from urllib.parse import quote, urlencode

from nicegui import ui
from tomlkit import TOMLDocument

from dalembert.errors import InputError
from dalembert.studio.code_text import code_text
from dalembert.studio.runs.advice import Change, changes
from dalembert.studio.runs.run_changes import study_text
from dalembert.study.run.folder import RunFolder

ICONS = {"error": ("error", "negative"), "warning": ("warning", "warning"), "note": ("info", "primary")}
"""Icon and colour of each severity."""


def findings_list(folder: RunFolder) -> None:
    """Show the findings of a run. A button opens the changed study, to be confirmed."""
    state = folder.state()
    findings = state.get("findings") or []
    if not findings:
        return
    try:
        document = study_text(folder)
    except InputError:  # the copy of the study is damaged
        document = TOMLDocument()
    best, counts = (state.get("best") or {}).get("values") or {}, Counter[str]()
    ui.label("Findings").classes("text-xl font-bold").props("role=heading aria-level=2")
    with ui.column().classes("w-full gap-2").props("role=list"):
        for finding in findings:
            code = str(finding.get("code"))
            offered = changes(code, finding["values"], document, best) if "values" in finding else []
            _show(finding, list(enumerate(offered, counts[code])), folder.path.name)
            counts[code] += len(offered)


def finding_row(severity: str, message: str, advice: str) -> ui.column:
    """Show a finding in a row, and return the place below its text."""
    icon, colour = ICONS.get(severity, ICONS["note"])
    with ui.row().classes("w-full items-start gap-3 no-wrap border rounded p-3").props("role=listitem"):
        ui.icon(icon, color=colour, size="sm").props(f'role=img aria-hidden=false aria-label="{severity}"')
        with ui.column().classes("gap-1 grow min-w-0") as column:
            code_text(message).classes("break-words")
            code_text(advice).classes("text-sm opacity-80 break-words")
    return column


def _show(finding: dict, offered: list[tuple[int, Change]], run: str) -> None:
    texts = (str(finding.get(key, "")) for key in ("message", "advice"))
    with finding_row(str(finding.get("severity", "note")), *texts), ui.row().classes("gap-2"):
        for number, change in offered:
            query = urlencode({"code": change.code, "number": number})
            go = partial(ui.navigate.to, f"/continue/{quote(run)}?{query}")
            ui.button(change.label, on_click=go, icon="edit_note").props("outline dense no-caps").classes("px-2")
