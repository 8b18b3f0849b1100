"""Any number of runs compared: one page to share, and the values as CSV."""

import tempfile
from pathlib import Path
from urllib.parse import quote, urlencode

from fastapi.responses import HTMLResponse, PlainTextResponse, Response
from nicegui import ui

from dalembert.errors import InputError
from dalembert.studio.code_text import code_text
from dalembert.studio.frame import frame
from dalembert.studio.workspace import Workspace
from dalembert.study.run.folder import RunFolder

ADDRESS = "/comparison"
"""Of the page to share, and with the ending .csv of the values."""


def compare_page(workspace: Workspace, names: list[str]) -> None:
    """Runs compared, and links to keep what is shown."""
    with frame("Runs compared"):
        try:
            folders = _folders(workspace, names)
        except InputError as error:
            code_text(str(error)).props("role=alert")
            return
        query = urlencode({"run": [folder.path.name for folder in folders]}, doseq=True)
        with ui.row().classes("gap-4 items-center"):
            for folder in folders:
                ui.link(folder.path.name, f"/run/{quote(folder.path.name)}").classes("break-all")
        with ui.row().classes("gap-4 items-center"):
            ui.label("Download:")
            ui.link("Page to share (HTML)", f"{ADDRESS}?{query}").props('download="comparison.html"')
            ui.link("Values (CSV)", f"{ADDRESS}.csv?{query}").props('download="comparison.csv"')
        page = ui.element("iframe").props(f'src="{ADDRESS}?{query}" title="Runs compared"')
        page.props('sandbox="allow-scripts allow-downloads allow-popups"')
        page.classes("w-full border rounded").style("height: 85vh")


def comparison_file(workspace: Workspace, names: list[str], *, csv: bool = False) -> Response:
    """Return the comparison as one HTML file, or its values as CSV."""
    from dalembert.report import report
    from dalembert.studio.runs.comparison import RunComparison

    try:
        comparison = RunComparison(_folders(workspace, names))
        if csv:
            return PlainTextResponse(comparison.table.csv, media_type="text/csv")
        with tempfile.TemporaryDirectory() as folder:
            return HTMLResponse(report(comparison, Path(folder) / "comparison.html").read_text(encoding="utf-8"))
    except InputError as error:
        return PlainTextResponse(str(error), status_code=404)


def _folders(workspace: Workspace, names: list[str]) -> list[RunFolder]:
    known = {folder.path.name: folder for folder in workspace.runs()}
    chosen = list(dict.fromkeys(names))
    if not chosen:
        raise InputError("no run is chosen; choose runs on the page Runs")
    return [known.get(name) or workspace.run(name) for name in chosen]
