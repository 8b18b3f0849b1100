"""The player of motions on a page."""

from typing import Any

from nicegui import ui

from dalembert.report.player import BROWSER, LOOK


class Player(ui.element, component="player.js", esm={"dalembert-player": str(BROWSER)}):
    """Plays films. A newer film continues where the older one was; it plays to its end after each change. ``label`` is
    for screen readers. The player emits ``shown`` when it appears on the page, also again, and ``hidden`` when it
    disappears.
    """

    def __init__(self, label: str) -> None:
        super().__init__()
        self._props.update({"label": label, "look": LOOK})
        self.number = 0

    def show(self, film: dict[str, Any], **times: float) -> None:
        """Show a newer film. ``times`` say when it was requested and computed, for a benchmark in the browser."""
        self.number += 1
        self._props["film"] = {**film, "facts": {"number": self.number, **times}}
        self.update()
