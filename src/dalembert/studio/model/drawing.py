"""The element that shows an SVG drawing whose parts can be chosen."""

from collections.abc import Callable, Sequence

from nicegui import events
from nicegui.element import Element


class ModelDrawing(Element, component="drawing.js"):
    """A drawing; pointer and keys choose its parts, named by role and name: ``"body rod"``.

    Parameters
    ----------
    on_choose : function
        Called with the part that was chosen, or with None for a click beside all of them.
    """

    def __init__(self, on_choose: Callable[[str | None], object]) -> None:
        super().__init__()
        self._props.update({"svg": "", "chosen": [], "wrong": []})

        def chosen(event: events.GenericEventArguments) -> None:
            on_choose(event.args if isinstance(event.args, str) else None)

        self.on("choose", chosen)

    def draw(self, svg: str) -> None:
        """Show a drawing."""
        self._props["svg"] = svg

    def mark(self, chosen: Sequence[str], wrong: Sequence[str]) -> None:
        """Highlight parts that are selected, and those with mistakes."""
        self._props["chosen"], self._props["wrong"] = list(chosen), list(wrong)

    def fit(self) -> None:
        """Show all of the drawing."""
        self.run_method("fit")

    def scale(self, factor: float) -> None:
        """Show a part of the drawing: larger for a factor below 1."""
        self.run_method("scale", factor)
