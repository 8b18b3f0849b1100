"""Measured data: a file beside the study, how its columns are used, what is doubtful, and a plot of each."""

from dataclasses import replace
from functools import partial

from nicegui import events, run, ui

from dalembert.findings import Finding
from dalembert.studio.code_text import code_text
from dalembert.studio.data.choices import Choices
from dalembert.studio.data.columns import ColumnTable
from dalembert.studio.data.examined import Examined
from dalembert.studio.data.guide import DataGuide
from dalembert.studio.data.picker import ChannelPicker, columns_figure
from dalembert.studio.editor.draft import Draft
from dalembert.studio.frame import button, complaints
from dalembert.studio.pacing import Latest
from dalembert.studio.page_services import PageServices
from dalembert.studio.runs.figures import CONFIG, bare
from dalembert.studio.uploads import upload

KINDS = ".csv,.txt,.dat,.tsv,.asc,.log,.gz,.json,.parquet,.pq,.mat,.uff,.unv,.uf,.bunv,.nc,.nc4,.cdf"
SEPARATORS = {"auto": "detected", ",": "comma", ";": "semicolon", "\t": "tab", " ": "blanks"}
DECIMALS = {"auto": "detected", ".": "point", ",": "comma"}
FIRST, ZERO, AT = "first", "zero", "at"
LOOKS = {"error": ("error", "negative"), "warning": ("warning", "warning"), "note": ("info", "primary")}
"""Icon and colour by severity."""


def show(draft: Draft, services: PageServices) -> None:
    """Build the panel."""
    DataPanel(draft, services)


class DataPanel:
    """The elements of the panel, and how they follow the choices."""

    def __init__(self, draft: Draft, services: PageServices) -> None:
        self.draft, self.services = draft, services
        self.guide = DataGuide(draft, services.worker)
        self._quiet = False
        self._listed: list[tuple[str, str, str]] = []
        self._redraw = Latest(self._look)
        with ui.column().classes("w-full gap-3") as self._all:
            self._build_file()
            self._busy = ui.linear_progress(show_value=False, size="3px").props("indeterminate")
            self._busy.props('aria-label="Reading the file"').set_visibility(False)
            self._error = ui.label("").classes("text-negative").props("role=alert")
            with ui.column().classes("w-full gap-3") as self._chosen:
                self._columns = ColumnTable(self._choose, ChannelPicker(draft, services).pick)
                self._build_options()
                self._problems = ui.column().classes("w-full gap-2").props('role=status aria-label="Problems"')
                self._build_write()
                self._plot = (
                    ui.plotly({"config": CONFIG}).classes("w-full").props('role=img aria-label="Columns of the file"')
                )
        self._chosen.set_visibility(False)
        draft.follow("study", self._follow)
        draft.follow("text", self._show_written)

    def _build_file(self) -> None:
        with ui.row().classes("w-full items-start gap-3"):
            self._file = ui.select([], label="Data file", on_change=self._pick).classes("grow min-w-48")
            self._file.props("outlined dense options-dense")
            self._table = ui.select({}, label="Table", on_change=self._pick_table).classes("min-w-40")
            self._table.props("outlined dense options-dense").set_visibility(False)
            with ui.element("div").classes("grow min-w-48 no-list"):
                upload("Add measured data", KINDS, self._uploaded)

    def _build_options(self) -> None:
        with ui.row().classes("w-full items-center gap-3"):
            self._begin = ui.select({}, label="The motion begins", on_change=self._begins).classes("min-w-56")
            self._at = ui.number("Time in the file (s)", on_change=self._begins).classes("w-36")
            self._rate = ui.number("Sampling rate (Hz)", min=0, on_change=self._sampled).classes("w-44")
            self._separator = ui.select(SEPARATORS, label="Separator", on_change=self._marks).classes("min-w-44")
            self._decimal = ui.select(DECIMALS, label="Decimal mark", on_change=self._marks).classes("min-w-44")
            self._missing = ui.checkbox("Leave missing values out", on_change=self._leave_out)
            for menu in (self._begin, self._at, self._rate, self._separator, self._decimal):
                menu.props("outlined dense options-dense")
        self._layout = ui.label("").classes("text-sm opacity-80")

    def _build_write(self) -> None:
        with ui.row().classes("w-full items-center gap-3"):
            self._write = button("Write into the study", complaints()(self._written), icon="edit_note")
            self._state = ui.label("").classes("text-sm").props("role=status aria-live=polite")

    def _follow(self) -> None:
        """Show what the text of the study says, when its table of data has changed."""
        self._list_files()
        self.guide.follow()
        self._read()

    def _list_files(self) -> None:
        self._quiet = True
        names = list(dict.fromkeys([*self.guide.files, *([self.guide.file] if self.guide.file else [])]))
        self._file.set_options(names, value=self.guide.file or None)
        tables = {str(place): name for place, name in self.guide.tables.items()}
        self._table.set_options(tables, value=str(self.guide.place))
        self._table.set_visibility(len(tables) > 1)
        self._quiet = False

    async def _look(self) -> None:
        """Read the file and show it; then compare it with the model."""
        if self.guide.file:
            self.draft.watched_files.show(self.draft.path.parent / self.guide.file)
        await self.guide.look()
        self._show()
        await self.guide.doubt()
        self._show_problems()

    def _show(self) -> None:
        shown = self.guide.examined
        self._error.set_text(self.guide.error)
        self._error.set_visibility(bool(self.guide.error))
        self._list_files()
        self._chosen.set_visibility(shown is not None)
        if shown is None:
            return
        self._quiet = True
        self._columns.show(shown)
        self._show_options(shown)
        self._quiet = False
        self._show_problems()
        self._show_written()
        self._plot.update_figure(bare(columns_figure(shown)))

    def _show_options(self, shown: Examined) -> None:
        choices = shown.choices
        kind = FIRST if choices.start == FIRST else ZERO if choices.start is None else AT
        begins = {FIRST: f"with the first sample ({shown.begins:.6g} s)", ZERO: "at 0 s of the file", AT: "at a time"}
        self._begin.set_options(begins, value=kind)
        self._at.set_value(choices.begin)
        self._at.set_visibility(kind == AT)
        if choices.rate != self._rate.value:
            self._rate.set_value(choices.rate)
        self._rate.set_visibility(choices.time is None)
        for menu, value, is_text in (
            (self._separator, choices.separator, shown.separator),
            (self._decimal, choices.decimal, shown.decimal),
        ):
            menu.set_value(value)
            menu.set_visibility(bool(is_text))
        self._missing.set_value(choices.missing != "refuse")
        self._missing.set_visibility(any(curve.missing for curve in shown.curves) or choices.missing != "refuse")
        self._layout.set_text(f"{shown.samples} rows. {shown.layout[:1].upper()}{shown.layout[1:]}.")

    def _show_problems(self) -> None:
        """List the problems; a list that has not changed stays, so that a click on one of its buttons is not lost."""
        listed = [(finding.severity, str(finding), self.guide.remedy(finding)) for finding in self.guide.findings]
        if listed == self._listed:
            return
        self._listed = listed
        self._problems.clear()
        with self._problems:
            for finding in self.guide.findings:
                self._problem(finding)

    def _problem(self, finding: Finding) -> None:
        icon, colour = LOOKS[finding.severity]
        with ui.row().classes("w-full items-start gap-2 flex-nowrap"):
            ui.icon(icon, color=colour, size="sm").props(f'role=img aria-hidden=false aria-label="{finding.severity}"')
            code_text(str(finding)).classes("text-sm grow break-words min-w-0")
            if label := self.guide.remedy(finding):
                fix = ui.button(label, on_click=partial(self._fix, finding)).props("no-caps outline dense size=sm")
                fix.classes("shrink-0 px-2")

    def _show_written(self) -> None:
        shown, reading, written = self.guide.examined, self.guide.is_reading, self.guide.is_written
        self._write.set_enabled(shown is not None and bool(shown.table) and not reading and not written)
        lacks = shown.lacks if shown is not None else ""
        state = "The study has these choices." if written else "Not yet in the study."
        self._state.set_text("Reading the file …" if reading else lacks or state)
        self._busy.set_visibility(reading)

    def _choose(self, choices: Choices) -> None:
        self.guide.choices = choices
        if self.guide.examined is not None:  # the menus first, so that none shows what is no longer chosen
            self._columns.show(replace(self.guide.examined, choices=choices))
        self._read()

    def _read(self) -> None:
        self._show_written()
        self._redraw()

    def _change(self, **changed: object) -> None:
        if not self._quiet and self.guide.choices is not None:
            self._choose(replace(self.guide.choices, **changed))

    def _begins(self) -> None:
        start = {FIRST: "first", ZERO: None, AT: self._at.value or 0.0}[self._begin.value]
        self._change(start=start)

    def _sampled(self) -> None:
        self._change(sampling=self._rate.value or None)

    def _marks(self) -> None:
        self._change(separator=self._separator.value, decimal=self._decimal.value)

    def _leave_out(self) -> None:
        words = self.guide.choices.absent if self.guide.choices is not None else []
        self._change(missing=(words or "leave-out") if self._missing.value else "refuse")

    def _pick(self) -> None:
        if not self._quiet and self._file.value and self._file.value != self.guide.file:
            self.guide.choose_file(self._file.value)
            self._read()

    def _pick_table(self) -> None:
        if not self._quiet:
            self.guide.choose_table(next(p for p in self.guide.tables if str(p) == self._table.value))
            self._read()

    def _written(self) -> None:
        self.guide.write()
        self._show_written()

    def _fix(self, finding: Finding) -> None:
        with complaints("correct data"):
            self.guide.apply(finding)
        self._read()

    async def _uploaded(self, event: events.UploadEventArguments) -> None:
        with complaints("place file"):
            placed = await run.io_bound(
                self.services.workspace.put, self.draft.name, event.file.name, await event.file.read()
            )
            if placed is not None:  # or the studio is ending
                ui.notify(f"{placed.name} lies beside the study now.", type="positive")
                self.guide.choose_file(placed.name)
                self._read()
