"""The drawing of a model on a page: flat or in space, with parts that can be chosen."""

from collections.abc import Callable, Sequence
from typing import Any

from nicegui import events, ui
from nicegui.element import Element

from dalembert.report.player import BROWSER, LOOK
from dalembert.studio.model.picture import Picture

Choose = Callable[[str | None], object]
"""Called with the part that was chosen, ``"body rod"``, or with None for a click beside all of them."""


class ModelView(Element):
    """What both elements share."""

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


class ModelSpace(ModelView, component="space.js", esm={"dalembert-player": str(BROWSER)}):
    """A view in three dimensions, which the pointer turns. ``on_unable`` is called if the browser cannot draw it."""

    def __init__(self, on_choose: Choose, on_unable: Callable[[], object]) -> None:
        super().__init__(on_choose)
        self._props["look"] = LOOK
        self.on("unable", on_unable, args=[])

    def draw(self, scene: dict[str, Any]) -> None:
        """Show a scene, as :func:`~dalembert.report.player.film.encoded` gives it."""
        self._props["scene"] = scene


class Viewer(ui.element):
    """Both views of a model, one of which is visible. ``on_choose`` is called with the chosen part."""

    def __init__(self, on_choose: Choose) -> None:
        super().__init__("div")
        self._in_space, self._is_unable = False, False
        with self:
            self._drawing = ModelDrawing(on_choose).classes("w-full h-full")
            self._space = ModelSpace(on_choose, self._stay_flat).classes("w-full h-full")
        self._place()

    def draw(self, picture: Picture) -> None:
        """Show a picture."""
        self._in_space = picture.scene is not None
        self._drawing.draw(picture.svg)
        if picture.scene is not None:
            self._space.draw(picture.scene)
        self._place()

    def mark(self, chosen: Sequence[str], wrong: Sequence[str]) -> None:
        """Highlight parts that are selected, and those with mistakes."""
        self._view.mark(chosen, wrong)

    def fit(self) -> None:
        """Show all of the model."""
        self._view.fit()

    def scale(self, factor: float) -> None:
        """Show it larger for a factor below 1."""
        self._view.scale(factor)

    @property
    def _view(self) -> ModelView:
        return self._space if self._in_space and not self._is_unable else self._drawing

    def _place(self) -> None:
        for view in (self._drawing, self._space):
            view.set_visibility(view is self._view)

    def _stay_flat(self) -> None:
        self._is_unable = True
        self._place()
