"""The view of a model: in three dimensions where it is in space and the browser can, else the drawing."""

from collections.abc import Sequence

from nicegui import ui

from dalembert.studio.model.drawing import Choose, ModelDrawing, ModelSpace, ModelView
from dalembert.studio.model.picture import Picture


class Viewer(ui.element):
    """Both elements that show a model, one of which is visible.

    Parameters
    ----------
    on_choose : function
        Called with the part that was chosen.
    """

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
        for one in (self._drawing, self._space):
            one.set_visibility(one is self._view)

    def _stay_flat(self) -> None:
        self._is_unable = True
        self._place()
