"""The table of runs: a grid that sorts, filters and searches, and follows the runs' folder."""

from collections.abc import Awaitable, Callable
from typing import Any

from nicegui import ui

from dalembert.studio.runs.run_list import Row

SELECTED, PRESSED, CHANGED = "runs-selected", "runs-pressed", "runs-changed"
FIRST = 30
"""Rows that are sent with the page: more than a window shows. The others follow."""
_LINK = """params => {
    const link = document.createElement('a');
    link.href = '/run/' + encodeURIComponent(params.data.run);
    link.textContent = params.data.run;
    link.tabIndex = -1;
    link.className = 'underline';
    return link;
}"""
_STATE = """params => {
    const colours = { finished: 'positive', running: 'primary' };
    for (const state of ['paused', 'interrupted', 'killed']) colours[state] = 'warning';
    const cell = document.createElement('span'), dot = document.createElement('span');
    dot.className = 'dot inline-block rounded-full mr-2 bg-' + (colours[params.value] ?? 'negative');
    dot.style.cssText = 'width: 9px; height: 9px';
    dot.ariaHidden = true;
    cell.append(dot, params.value);
    return cell;
}"""
_NUMBER = "params => params.value == null ? '' : Number(params.value.toPrecision(4)).toString()"
_TIME = """params => {
    const seconds = params.value;
    if (seconds == null) return '';
    if (seconds < 60) return seconds.toPrecision(seconds < 10 ? 2 : 3).replace(/\\.$/, '') + ' s';
    const minutes = Math.round(seconds / 60);
    return minutes < 60 ? minutes + ' min' : Math.floor(minutes / 60) + ' h ' + minutes % 60 + ' min';
}"""
_DATE = """params => {
    const date = new Date(params.value.replace(' ', 'T') + 'Z'), two = (number) => String(number).padStart(2, '0');
    if (isNaN(date)) return params.value;
    const day = [date.getFullYear(), two(date.getMonth() + 1), two(date.getDate())].join('-');
    return day + ' ' + two(date.getHours()) + ':' + two(date.getMinutes());
}"""
"""The time of the browser; rows have universal time."""
_DATE_HEADER = "() => 'Date (' + Intl.DateTimeFormat().resolvedOptions().timeZone + ')'"
_NUMERIC: dict[str, Any] = {"filter": "agNumberColumnFilter", "type": "rightAligned"}
_EDITABLE: dict[str, Any] = {"editable": True, "cellEditorParams": {"maxLength": 1000}}
_COLUMNS: tuple[dict[str, Any], ...] = (
    {
        "field": "run",
        "width": 210,
        "tooltipField": "run",
        ":cellRenderer": _LINK,
        "editable": True,
        "headerTooltip": "Press F2 to rename",
    },
    {"field": "study", "width": 105, "tooltipField": "study"},
    {"field": "task", "width": 100, "tooltipField": "task"},
    {"field": "state", "width": 126, ":cellRenderer": _STATE},
    {
        "field": "findings",
        "width": 125,
        ":comparator": "(a, b, first, second) => first.data.severity - second.data.severity",
        ":tooltipValueGetter": "params => params.data.doubts.join('\\n')",
    },
    {"field": "values", "flex": 1, "minWidth": 190, "tooltipField": "values"},
    {"field": "misfit", "width": 95, ":valueFormatter": _NUMBER, **_NUMERIC},
    {"field": "duration", "width": 105, ":valueFormatter": _TIME, **_NUMERIC},
    {
        "field": "date",
        ":headerValueGetter": _DATE_HEADER,
        "width": 150,
        "initialSort": "desc",
        "sortingOrder": ["desc", "asc"],
        ":valueFormatter": _DATE,
    },
    {"field": "tags", "width": 85, "headerTooltip": "Press F2 to edit, commas between tags", **_EDITABLE},
    {"field": "note", "width": 130, "tooltipField": "note", "headerTooltip": "Press F2 to edit", **_EDITABLE},
)
_KEYS = """params => !params.editing && (
    ['Delete', 'Backspace'].includes(params.event.key) || params.event.key === 'Enter' && params.column.colId === 'run'
)"""
_SELECTED = f"params => emitEvent('{SELECTED}', params.api.getSelectedRows().map(row => row.run))"
_PRESSED = f"""params => {{
    const editing = params.api.getEditingCells().length || params.event.target.matches('input');
    if (editing || !params.data || !['Enter', 'Delete'].includes(params.event.key)) return;
    if (params.event.key === 'Enter' && params.column.colId !== 'run') return;
    emitEvent('{PRESSED}', {{ key: params.event.key, id: params.data.id }});
}}"""
_CHANGED = f"""params => {{
    const changed = {{ run: params.data.run, field: params.column.colId, value: params.newValue ?? '' }};
    if (changed.field === 'run') {{
        changed.run = params.oldValue;
        params.data.run = params.oldValue;  // until the folder is renamed, which may be refused
        params.api.refreshCells({{ rowNodes: [params.node], columns: ['run'], force: true }});
    }}
    emitEvent('{CHANGED}', changed);
}}"""


class RunGrid:
    """Table of the runs. ``rows``: those of :class:`~dalembert.studio.runs.run_list.RunList`, the newest first. The
    first ones are shown, so that the page is small; :meth:`show` adds the others. ``on_select`` takes the names of the
    selected runs; ``on_key`` takes ``"Enter"`` or ``"Delete"`` and the ``id`` of the focused row, whose run may just
    have been renamed; ``on_change`` takes a run, ``"run"``, ``"tags"`` or ``"note"``, and the text entered there.
    """

    def __init__(
        self,
        rows: list[Row],
        on_select: Callable[[list[str]], object],
        on_key: Callable[[str, str], Awaitable[object]],
        on_change: Callable[[str, str, str], object],
    ) -> None:
        self.shown = rows[:FIRST]
        self.box = ui.element("div").classes("w-full").style(_height(rows))
        with self.box:
            self.grid = ui.aggrid(_options(self.shown), auto_size_columns=False)
        self.grid.classes("w-full h-full").props('aria-label="Runs"')
        ui.on(SELECTED, lambda event: on_select(list(event.args)))
        ui.on(PRESSED, lambda event: on_key(event.args["key"], event.args["id"]))
        ui.on(CHANGED, lambda event: on_change(event.args["run"], event.args["field"], str(event.args["value"])))

    def show(self, rows: list[Row]) -> None:
        """Bring the table to these rows; filters, selection and place stay."""
        before, after = {row["id"]: row for row in self.shown}, {row["id"]: row for row in rows}
        changes = {
            "add": [row for key, row in after.items() if key not in before],
            "update": [row for key, row in after.items() if key in before and row != before[key]],
            "remove": [row for key, row in before.items() if key not in after],
        }
        self.shown = rows
        if any(changes.values()):
            self.grid.run_grid_method("applyTransaction", changes)
            self.box.style(_height(rows))  # a style of the grid would make it anew

    def search(self, text: str) -> None:
        """Show the rows with all words of a text in any column."""
        self.grid.run_grid_method("setGridOption", "quickFilterText", text)


def _options(rows: list[Row]) -> dict[str, Any]:
    return {
        "columnDefs": list(_COLUMNS),
        "defaultColDef": {
            "filter": True,
            "resizable": True,
            "sortingOrder": ["asc", "desc"],
            ":suppressKeyboardEvent": _KEYS,
        },
        "rowData": rows,
        ":getRowId": "params => params.data.id",
        "rowSelection": {"mode": "multiRow", "selectAll": "filtered"},
        "selectionColumnDef": {"width": 46},
        "ensureDomOrder": True,
        "rowBuffer": 2,
        "suppressColumnVirtualisation": True,  # all columns can be reached by keys and read aloud
        ":tabToNextCell": "() => false",  # Tab leaves the table, arrow keys move in it
        ":tabToNextHeader": "() => false",
        "tooltipShowDelay": 300,
        "rowHeight": 36,
        "headerHeight": 40,
        "enableCellTextSelection": True,
        "stopEditingWhenCellsLoseFocus": True,
        ":onCellKeyDown": _PRESSED,
        ":onCellValueChanged": _CHANGED,
        ":onSelectionChanged": _SELECTED,
    }


def _height(rows: list[Row]) -> str:
    """As high as the rows, up to a part of the window."""
    return f"height: clamp(180px, {36 * len(rows) + 60}px, 62vh)"
