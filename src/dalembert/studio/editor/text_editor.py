"""The editor of a study's text, with marks at mistakes and at what is selected."""

from collections.abc import Collection

from nicegui import events, ui

from dalembert.studio.editor.draft import Draft
from dalembert.studio.editor.lines import is_within, line_of, lines_of, place_at, table_of
from dalembert.studio.editor.names import Channels
from dalembert.studio.editor.study_editor import StudyEditor

WRONG, CHOSEN = "wrong", "chosen"
"""Classes of lines; ``frame.LOOKS`` colours them."""
PATIENCE = 30.0
"""Seconds in which a busy browser says whether it is dark."""
_LINE = """() => {
    const state = getElement(%d).editor.state;
    emit(state.doc.lineAt(state.selection.main.head).number);
}"""
_DARK = """
    const dark = matchMedia("(prefers-color-scheme: dark)");
    dark.onchange = () => emitEvent("dark", dark.matches);
    return dark.matches;
"""
_MOVE = """
    const view = getElement(%d).editor;
    if (%d <= view.state.doc.lines) view.dispatch({selection: {anchor: view.state.doc.line(%d).to}});
"""


class TextEditor:
    """An editor that shows a draft: typing changes it, and what changes it elsewhere is shown.

    Parameters
    ----------
    draft : Draft
    label : str
        What a screen reader says.
    tables : collection of str
        The tables that the file may have; all if empty.
    """

    def __init__(self, draft: Draft, label: str = "The study as text", tables: Collection[str] = ()) -> None:
        self.draft, self._line = draft, 1
        self.element = StudyEditor(draft.text, Channels(draft), self._recall, self._restore, label, tables)
        self.element.classes("w-full h-full border rounded")
        self.element.on_value_change(self._typed)
        for event in ("keyup", "mouseup"):
            self.element.on(event, self._moved, js_handler=_LINE % self.element.id)
        for key, act in (("Mod-z", draft.undo), ("Mod-Shift-z", draft.redo), ("Mod-y", draft.redo)):
            self.element.map_key(key, act)
        draft.follow("text", self._show)
        draft.follow("mistakes", self._mark)
        draft.follow("selection", self._select)
        ui.timer(0.0, self._adapt, once=True)

    def go(self, line: int) -> None:
        """Move the cursor to the end of a line that is then visible."""
        self._line = line
        self.element.reveal_line(line)
        with self.element:
            ui.run_javascript(_MOVE % (self.element.id, line, line))

    async def _adapt(self) -> None:
        """Take the colours of the system, also when they change."""
        ui.on("dark", lambda event: self._colour(bool(event.args)))
        self._colour(await ui.run_javascript(_DARK, timeout=PATIENCE))

    def _colour(self, dark: bool) -> None:
        self.element.set_theme("vscodeDark" if dark else "vscodeLight")

    def _typed(self) -> None:
        self.draft.set_text(self.element.value or "", typed=True)

    def _recall(self, text: str) -> None:
        """Keep a text that was typed while another change came."""
        self.draft.recall(text)
        ui.notify("The text changed while you typed. Undo brings back what you typed.")

    def _restore(self, text: str, saved: str) -> None:
        self.draft.restore(text, saved)
        ui.notify(
            "The unsaved text of this tab is back. Undo brings back that of the file.", timeout=0, close_button="Close"
        )

    def _show(self) -> None:
        self.element.set_saved(self.draft.saved)
        if self.element.value != self.draft.text:
            self.element.set_value(self.draft.text)

    def _moved(self, event: events.GenericEventArguments) -> None:
        self._line = int(event.args)
        self.draft.select(place_at(self.draft.text, self._line) or None)

    def _select(self) -> None:
        """Mark the table of the selection, and move the cursor there unless it is in it."""
        text, place = self.draft.text, self.draft.selection
        self._mark()
        if place is not None and not is_within(place_at(text, self._line), place):
            self.go(line_of(text, place))

    def _mark(self) -> None:
        text, place = self.draft.text, self.draft.selection
        last = max(1, len(text.splitlines()))
        wrong = {min(one.line, last) for one in self.draft.mistakes}
        chosen = set(lines_of(text, table_of(text, place))) if place else set()
        marks = [{"kind": "line", "line": line, "class": CHOSEN} for line in sorted(chosen - wrong)]
        marks += [{"kind": "line", "line": line, "class": WRONG} for line in sorted(wrong)]
        if marks != self.element.decorations:
            self.element.decorations = marks
