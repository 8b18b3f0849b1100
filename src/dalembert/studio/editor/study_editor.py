"""The editor of TOML with completions, and with the meaning of the word under the pointer or, by F1, at the cursor."""

import sys
from collections.abc import Awaitable, Callable, Collection
from dataclasses import asdict
from pathlib import Path

from nicegui import events, ui

from dalembert.studio.editor.completion import completions, explanation
from dalembert.studio.editor.names import Names

_NICEGUI = str(Path(str(sys.modules[ui.codemirror.__module__].__file__)).parent)
_MOST = 200
"""Completions that are sent."""


class StudyEditor(ui.codemirror, component="study_editor.js", esm={"dalembert-codemirror": _NICEGUI}):
    """An editor of a study's text.

    Parameters
    ----------
    text : str
    names : function
        Coroutine function that returns names that the text does not say, such as channels.
    late : function
        Called with a text that was typed when the browser had not yet received the present one.
    kept : function
        Called with a text that the browser kept when its page was lost, and the saved text that it was based on.
    label : str
        What a screen reader says.
    tables : collection of str
        The tables that the file may have; all if empty.
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
        elif found := explanation(self.value or "", position):
            reply = asdict(found)
        self.run_method("answer", event.args["number"], reply)
