"""Forms of tables of a study, and their fields."""

from collections.abc import Callable, Collection, Sequence
from functools import partial

from nicegui import events, ui

from dalembert.studio.editor.additions import Addition, added, additions
from dalembert.studio.editor.cursor import tolerant
from dalembert.studio.editor.draft import Draft
from dalembert.studio.editor.editing import without
from dalembert.studio.editor.fields import shown
from dalembert.studio.editor.form import Form, FormRow, form_at, with_row
from dalembert.studio.editor.names import Channels, Names, names_in
from dalembert.studio.frame import button, complaints, icon_button, tipped
from dalembert.studio.page_services import PageServices


class FormField:
    """A key with its label, unit, default and mistakes. ``names`` are what the study offers for the value. ``commit``
    takes the row and the text that is written for it. ``explain`` takes the row when the element gets the focus.
    ``enter`` opens the form of the value where it is or may be a table.
    """

    def __init__(
        self,
        row: FormRow,
        names: Sequence[str],
        commit: Callable[[FormRow, str], object],
        explain: Callable[[FormRow], object],
        enter: Callable[[], object] | None = None,
    ) -> None:
        self.row, self._commit = row, commit
        field, self._typed, self._shown = row.field, "", ""
        self._takes_any = field.shape != "choice"
        if field.shape == "switch":
            self.element: ui.input | ui.select = ui.select(["true", "false"], clearable=True)
        elif field.choices or names:
            mode = "add-unique" if self._takes_any else None
            options = list(dict.fromkeys((*field.choices, *names)))
            self.element = ui.select(options, with_input=True, new_value_mode=mode, clearable=not field.required)
        else:
            self.element = ui.input()
        self.element.props(f'outlined dense stack-label label="{field.key}{_unit(field.unit)}" hide-bottom-space')
        default = "" if field.default is None else f"default {shown(field.default)}"
        self.element.props["placeholder"] = "required" if field.required else default
        self.element.props["aria-description"] = field.meaning
        self.element.classes("w-full")
        if enter is not None:
            with self.element.add_slot("append"):
                button = ui.button(icon="tune", on_click=enter).props(
                    f'flat round dense size=sm aria-label="Edit {field.key} as a table"'
                )
                tipped(button, "Edit as a table")
        self.element.on("focus", lambda: explain(self.row))
        self.show(row)
        if isinstance(self.element, ui.select):
            self.element.on_value_change(self._changed)
            self.element.on("input-value", self._type)
            self.element.on("blur", self._keep)
        else:
            self.element.on("blur", self._changed)
            self.element.on("keydown.enter", self._changed)

    def show(self, row: FormRow) -> None:
        """Show a value, and what is wrong with it."""
        self.row = row
        text = row.text if row.field.shape != "switch" or row.value is None else str(row.value).lower()
        if isinstance(self.element, ui.select) and text and text not in self.element.options:
            self.element.set_options([*self.element.options, text])
        if text != self._shown and (self.element.value or "") != text:  # or the user is typing
            self.element.set_value(text or None if isinstance(self.element, ui.select) else text)
        self._shown = text
        self.element.props["error"] = bool(row.mistakes)
        self.element.props["error-message"] = " ".join(row.mistakes)

    def _type(self, event: events.GenericEventArguments) -> None:
        self._typed = str(event.args or "")

    def _keep(self) -> None:
        """Keep what was typed in a list of names, and not confirmed by Enter."""
        typed, self._typed = self._typed, ""
        if typed and self._takes_any:
            self._commit(self.row, typed)

    def _changed(self) -> None:
        self._typed = ""
        written = str(self.element.value or "")
        if written != self.row.text:
            self._commit(self.row, written)


def _unit(unit: str | None) -> str:
    return f", {unit}" if unit else ""


TAB = "forms", "Forms", "edit_note"
"""Name, title and icon of the panel."""
HINT = "Click a table in the text or a part in the drawing to edit it here, or add one."


def show(draft: Draft, services: PageServices) -> None:
    """Build the panel."""
    show_tables(draft)


def show_tables(draft: Draft, tables: Collection[str] = ()) -> None:
    """Build the panel of a file that may have these tables, or all of a study if there are none."""
    bar, body = ui.row().classes("gap-1 items-center"), ui.column().classes("w-full gap-2 pt-2")
    Additions(draft, bar, Editor(draft, body).focus, tables)


class Additions:
    """A menu for each kind of table that can be added to a draft."""

    def __init__(self, draft: Draft, bar: ui.row, then: Callable[[], object], tables: Collection[str] = ()) -> None:
        self.draft, self.bar, self.then, self.tables = draft, bar, then, tables
        self.shown: tuple[Addition, ...] = ()
        self.channels = Channels(draft)
        draft.follow("text", self.update)
        self.update()

    def update(self) -> None:
        """Show what can be added to the text."""
        offered = additions(self.draft.text, self.tables)
        if offered == self.shown:
            return
        self.shown = offered
        self.bar.clear()
        with self.bar:
            for addition in offered:
                self._button(addition)
            for sentence in dict.fromkeys(addition.elsewhere for addition in offered if addition.elsewhere):
                ui.label(sentence).classes("text-sm break-words")

    def _button(self, addition: Addition) -> None:
        button = ui.button(addition.label, icon="add", color=None).props(
            "outline dense no-caps size=sm padding='4px 8px'"
        )
        button.props["aria-label"] = _add(addition)
        if addition.elsewhere:
            button.disable()
            return
        if not addition.kinds:
            button.on_click(partial(self._ask, addition))
            return
        with button, ui.menu().props("max-height=60vh"):
            for kind, meaning in addition.kinds.items():
                with (
                    ui.menu_item(on_click=partial(self._add, addition, kind)).props("role=menuitem"),
                    ui.column().classes("gap-0 max-w-sm py-1"),
                ):
                    ui.label(kind).classes("font-medium")
                    ui.label(meaning).classes("text-xs opacity-80 whitespace-normal")

    async def _ask(self, addition: Addition) -> None:
        """Ask for the name of a parameter, or for a channel."""
        known = self.channels.known["channel"] if addition.names == "channel" else ()
        with ui.dialog() as dialog, ui.card().classes("w-80"):
            ui.label(_add(addition)).classes("text-lg font-bold")
            if known:
                name = (
                    ui.select(list(known), label="Channel", with_input=True).classes("w-full").props("outlined dense")
                )
            else:
                name = ui.input("Name").classes("w-full").props("autofocus outlined dense")
                name.on("keydown.enter", lambda: dialog.submit(name.value))
            with ui.row().classes("w-full justify-end"):
                ui.button("Cancel", on_click=lambda: dialog.submit(None)).props("flat no-caps")
                button("Add", lambda: dialog.submit(name.value), icon="add")
        answer = await dialog
        if answer:
            self._add(addition, str(answer).strip())

    def _add(self, addition: Addition, what: str) -> None:
        with complaints("add part"):
            text, place = added(self.draft.text, addition, what)
            self.draft.set_text(text)
            self.draft.select(place)
            self.then()


class Editor:
    """The form of the selected table."""

    def __init__(self, draft: Draft, body: ui.column) -> None:
        self.draft, self.body = draft, body
        self.inner: tuple[str, ...] = ()
        self.shown: object = None
        self.names: Names = {}
        self.fields: dict[str, FormField] = {}
        self.channels = Channels(draft)
        draft.follow("text", self.update)
        draft.follow("study", self.update)
        draft.follow("selection", self._selected)
        self.update()

    def update(self) -> None:
        """Show the values of the text; the form is made anew only if its keys are others."""
        form = form_at(self.draft.text, self.draft.selection, self.draft.mistakes, inner=self.inner)
        shown = None if form is None else (form.place, form.keys, form.meaning)
        if shown != self.shown or form is None:
            self.shown = shown
            self._build(form)
        if form is not None:
            for row in form.rows:
                self.fields[row.field.key].show(row)
            self.heading.set_text(form.title[0].upper() + form.title[1:])
            self.wrong.set_text("\n".join(form.mistakes))
            self.wrong.set_visibility(bool(form.mistakes))

    def focus(self) -> None:
        """Move the focus to the first key that is missing."""
        missing = [field for field in self.fields.values() if field.row.field.required and field.row.value is None]
        for field in missing[:1]:
            field.element.run_method("focus")

    def _selected(self) -> None:
        self.inner = ()
        self.update()

    def _build(self, form: Form | None) -> None:
        self.fields.clear()
        self.body.clear()
        with self.body:
            if form is None:
                ui.label(HINT).classes("opacity-80")
                return
            with ui.row().classes("w-full items-center gap-2 no-wrap"):
                if self.inner:
                    icon_button("arrow_back", "Back", self._back)
                self.heading = ui.label().classes("text-lg font-bold break-words").props("role=heading aria-level=2")
                ui.space()
                icon_button("delete", f"Remove {form.title}", self._remove)
            if form.meaning:
                ui.label(form.meaning).classes("text-sm")
            self.wrong = ui.label().classes("text-sm text-negative whitespace-pre-wrap").props("role=alert")
            self.names = names_in(tolerant(self.draft.text)) | dict(self.channels.known)
            usual = [row for row in form.rows if row.is_usual]
            unusual = [row for row in form.rows if not row.is_usual]
            self._grid(form, usual)
            if unusual:
                with ui.expansion(f"Further keys ({len(unusual)})", value=not usual).props("dense").classes("w-full"):
                    self._grid(form, unusual)
            self.help = ui.label().classes("text-sm opacity-90 break-words").props("aria-live=polite")

    def _grid(self, form: Form, rows: list[FormRow]) -> None:
        with ui.element("div").classes("grid grid-cols-1 sm:grid-cols-2 gap-x-3 gap-y-3 w-full py-1"):
            for row in rows:
                enter = partial(self._enter, row.field.key) if row.field.shape == "table" or row.is_table else None
                known = self.names.get(row.field.names, ())
                self.fields[row.field.key] = FormField(row, known, partial(self._commit, form), self._explain, enter)

    def _commit(self, form: Form, row: FormRow, written: str) -> None:
        with complaints(("set", row.field.key)):
            self.draft.set_text(with_row(self.draft.text, form.place, row.field, written))

    def _explain(self, row: FormRow) -> None:
        self.help.set_text(": ".join(filter(None, (row.field.key, row.field.meaning))))

    def _enter(self, key: str) -> None:
        self.inner = (*self.inner, key)
        self.update()

    def _back(self) -> None:
        self.inner = self.inner[:-1]
        self.update()

    def _remove(self) -> None:
        form = form_at(self.draft.text, self.draft.selection, inner=self.inner)
        if form is None:
            return
        with complaints("remove part"):
            self.draft.set_text(without(self.draft.text, form.place))
            self.inner = self.inner[:-1]
            if not self.inner:
                self.draft.select(None)
        with self.body:  # the button that was pressed is gone
            ui.notify(f"Removed {form.title}. Undo brings it back.", type="info")


def _add(addition: Addition) -> str:
    """Return the label of a button.
    >>> _add(Addition("Input", ("inputs",))), _add(Addition("Body", ()))
    ('Add an input', 'Add a body')
    """
    name = addition.label.lower()
    return f"Add {'an' if name[0] in 'aeiou' else 'a'} {name}"
