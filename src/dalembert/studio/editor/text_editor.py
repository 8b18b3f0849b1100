"""The editor of a study's text on a page."""

import sys
from collections.abc import Awaitable, Callable, Collection
from dataclasses import asdict
from pathlib import Path

from nicegui import events, ui

from dalembert.studio.editor.completion import completions, explanation
from dalembert.studio.editor.draft import Draft
from dalembert.studio.editor.lines import is_within, line_of, lines_of, place_at, table_of
from dalembert.studio.editor.names import Channels, Names

_NICEGUI = str(Path(str(sys.modules[ui.codemirror.__module__].__file__)).parent)
_MOST = 200
"""Completions that are sent."""


class StudyEditor(ui.codemirror, component="study_editor.js", esm={"dalembert-codemirror": _NICEGUI}):
    """An editor of a study's text. ``names`` returns names that the text lacks, such as channels. ``late`` takes a text
    typed before the browser received the present one; ``kept`` a text that the browser kept when its page was lost, and
    the saved text that it was based on. ``label``: for screen readers; ``tables``: allowed ones, all if empty.
    """

    def __init__(
        self,
        text: str,
        names: Callable[[], Awaitable[Names]],
        late: Callable[[str], object] = lambda text: None,
        kept: Callable[[str, str], object] = lambda text, saved: None,
        label: str = "The study as text",
        tables: Collection[str] = (),
    ) -> None:
        super().__init__(text, language="TOML", theme="vscodeLight", line_wrapping=True)
        self._names, self._late, self._tables = names, late, tables
        self._props["revision"], self._props["label"], self._props["saved"] = 0, label, text
        self.on("question", self._answer)
        self.on("kept", lambda event: kept(event.args["text"], event.args["saved"]))

    def set_saved(self, text: str) -> None:
        """Say what the file holds: the browser keeps another text over a reload, and warns before it is left."""
        if self._props["saved"] != text:
            self._props["saved"] = text

    def _handle_value_change(self, value: str) -> None:
        if self._send_update_on_value_change:
            self._props["revision"] = self._props.get("revision", 0) + 1
        super()._handle_value_change(value)

    def _event_args_to_value(self, e: events.GenericEventArguments) -> str:
        """Return the text that was typed; the present one if the browser had not yet received it."""
        if e.args["revision"] == self._props["revision"]:
            return e.args["text"]
        self._late(e.args["text"])
        return self.value

    async def _answer(self, event: events.GenericEventArguments) -> None:
        """Send completions, or the meaning of a word."""
        position, reply = int(event.args["position"]), None
        if event.args["kind"] == "complete":
            names, text = await self._names(), self.value or ""
            start, options = completions(text, position, names, self._tables)
            reply = {"typed": text[start:position], "options": [asdict(option) for option in options[:_MOST]]}
        elif meaning := explanation(self.value or "", position):
            reply = asdict(meaning)
        self.run_method("answer", event.args["number"], reply)


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
    """An editor that shows a draft: typing changes it, and what changes it elsewhere is shown. ``label`` is for screen
    readers. ``tables`` are those that the file may have; all if empty.
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
        wrong = {min(mistake.line, last) for mistake in self.draft.mistakes}
        chosen = set(lines_of(text, table_of(text, place))) if place else set()
        marks = [{"kind": "line", "line": line, "class": CHOSEN} for line in sorted(chosen - wrong)]
        marks += [{"kind": "line", "line": line, "class": WRONG} for line in sorted(wrong)]
        if marks != self.element.decorations:
            self.element.decorations = marks
