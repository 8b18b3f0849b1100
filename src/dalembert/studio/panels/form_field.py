"""The element of a form in which a key of a table is edited."""

from collections.abc import Callable, Sequence

from nicegui import events, ui

from dalembert.studio.editor.fields import shown
from dalembert.studio.editor.form import Row
from dalembert.studio.frame import tipped


class FormField:
    """A key with its label, unit, default and mistakes.

    Parameters
    ----------
    row : Row
    names : sequence of str
        What the study offers for the value.
    commit : function
        Takes the key's row and the text that is written for it.
    explain : function
        Takes the row when the element gets the focus.
    enter : function, optional
        Opens the form of the value where it is or may be a table.
    """

    def __init__(
        self,
        row: Row,
        names: Sequence[str],
        commit: Callable[[Row, str], object],
        explain: Callable[[Row], object],
        enter: Callable[[], object] | None = None,
    ) -> None:
        self.row, self._commit = row, commit
        field, self._typed, self._shown = row.field, "", ""
        self._takes_any = field.shape != "choice"
        if field.shape == "switch":
            self.element: ui.input | ui.select = ui.select(["true", "false"], clearable=True)
        elif field.choices or names:
            own = "add-unique" if self._takes_any else None
            options = list(dict.fromkeys((*field.choices, *names)))
            self.element = ui.select(options, with_input=True, new_value_mode=own, clearable=not field.required)
        else:
            self.element = ui.input()
        self.element.props(f'outlined dense stack-label label="{field.key}{_unit(field.unit)}" hide-bottom-space')
        self.element.props["placeholder"] = "required" if field.required else _default(field.default)
        self.element.props["aria-description"] = field.meaning
        self.element.classes("w-full")
        if enter is not None:
            with self.element.add_slot("append"):
                made = ui.button(icon="tune", on_click=enter).props(
                    f'flat round dense size=sm aria-label="Edit {field.key} as a table"'
                )
                tipped(made, "Edit as a table")
        self.element.on("focus", lambda: explain(self.row))
        self.show(row)
        if isinstance(self.element, ui.select):
            self.element.on_value_change(self._changed)
            self.element.on("input-value", self._type)
            self.element.on("blur", self._keep)
        else:
            self.element.on("blur", self._changed)
            self.element.on("keydown.enter", self._changed)

    def show(self, row: Row) -> None:
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


def _default(value: object) -> str:
    return "" if value is None else f"default {shown(value)}"
