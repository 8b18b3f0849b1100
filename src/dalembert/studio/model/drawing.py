"""The elements that show a model, and whose parts can be chosen: a drawing, and a view in three dimensions."""

from collections.abc import Callable, Sequence
from typing import Any

import nicegui.elements.scene  # noqa: F401  its library draws in three dimensions
from nicegui import events
from nicegui.element import Element

Choose = Callable[[str | None], object]
"""Called with the part that was chosen, ``"body rod"``, or with None for a click beside all of them."""


class ModelView(Element):
    """What both elements share.

    Parameters
    ----------
    on_choose : function
    """

    def __init__(self, on_choose: Choose) -> None:
        super().__init__()
        self._props.update({"chosen": [], "wrong": []})

        def chosen(event: events.GenericEventArguments) -> None:
            on_choose(event.args if isinstance(event.args, str) else None)

        self.on("choose", chosen)

    def mark(self, chosen: Sequence[str], wrong: Sequence[str]) -> None:
        """Highlight parts that are selected, and those with mistakes."""
        self._props["chosen"], self._props["wrong"] = list(chosen), list(wrong)

    def fit(self) -> None:
        """Show all of the model."""
        self.run_method("fit")

    def scale(self, factor: float) -> None:
        """Show it larger for a factor below 1."""
        self.run_method("scale", factor)


class ModelDrawing(ModelView, component="drawing.js"):
    """A drawing as SVG."""

    def draw(self, svg: str) -> None:
        """Show a drawing."""
        self._props["svg"] = svg


class ModelSpace(ModelView, component="space.js"):
    """A view in three dimensions, which the pointer turns.

    Parameters
    ----------
    on_choose : function
    on_unable : function
        Called if the browser cannot draw in three dimensions.
    """

    def __init__(self, on_choose: Choose, on_unable: Callable[[], object]) -> None:
        super().__init__(on_choose)
        self.on("unable", on_unable, args=[])

    def draw(self, scene: dict[str, Any]) -> None:
        """Show a scene, as :mod:`dalembert.studio.model.scene` makes it."""
        self._props["scene"] = scene
