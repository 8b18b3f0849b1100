"""The model drawn beside its text, at the current values of the parameters."""

import numpy as np
from nicegui import ui

from dalembert.studio.draft import Draft
from dalembert.studio.frame import icon_button
from dalembert.studio.latest import Latest
from dalembert.studio.lines import Place
from dalembert.studio.model.drawing import ModelDrawing
from dalembert.studio.model.parts import parts_at, place_of
from dalembert.studio.model.picture import Picture, model_picture
from dalembert.studio.reading import Mistake
from dalembert.studio.room import Room
from dalembert.studio.worker import WorkerError


def show(draft: Draft, room: Room) -> None:
    """Build the panel."""
    _Panel(draft, room)


class _Panel:
    """The drawing, what to know about it, and buttons to look closer.

    Parameters
    ----------
    draft : Draft
    room : Room
    """

    def __init__(self, draft: Draft, room: Room) -> None:
        self.draft, self.room = draft, room
        self.places: dict[str, Place] = {}
        self.box: np.ndarray | None = None
        self.drawn = False
        with ui.column().classes("w-full h-full gap-1 flex-nowrap"):
            with ui.row().classes("w-full items-center gap-1"):
                self.told = ui.label("").classes("text-sm grow").props("role=status aria-live=polite")
                icon_button("zoom_in", "Enlarge the drawing", lambda: self.drawing.scale(0.8))
                icon_button("zoom_out", "Reduce the drawing", lambda: self.drawing.scale(1.25))
                icon_button("fit_screen", "Show all of the drawing", self._fit)
            self.drawing = ModelDrawing(self._choose).classes("w-full grow min-h-0")
        draw = Latest(self._draw)
        draft.follow("study", draw)
        draft.follow("values", draw)
        draft.follow("selection", self._mark)
        draft.follow("mistakes", self._mark)

    async def _draw(self) -> None:
        """Draw the study; while its text has mistakes, the last drawing stays, with the wrong parts marked."""
        self._mark()
        draft = self.draft
        if draft.study is None:
            self.told.set_text("The text has mistakes. The drawing shows the last valid text." if self.drawn else "")
            return
        if not self.drawn:
            self.told.set_text("Drawing the model …")
        try:
            values = dict(draft.values)
            ask = self.room.worker.ask
            picture = await ask("model", model_picture, draft.path, draft.reading.text, values, self.box)
        except WorkerError as error:
            self.told.set_text(str(error))
            return
        if picture is not None:
            self._show(picture)

    def _show(self, picture: Picture) -> None:
        self.places, self.box, self.drawn = picture.places, picture.box, True
        self.told.set_text(picture.message)
        if picture.svg or not picture.mistake:
            self.drawing.draw(picture.svg)
        if picture.mistake:
            self.draft.find(picture.mistake)
        self._mark()

    def _mark(self) -> None:
        wrong = [part for mistake in self.draft.mistakes for part in self._parts_of(mistake)]
        self.drawing.mark(parts_at(self.places, self.draft.selection), wrong)

    def _parts_of(self, mistake: Mistake) -> list[str]:
        """The parts that a mistake is about, by its place or by the names in its sentence."""
        named = [part for part in self.places if f"'{part.partition(' ')[2]}'" in mistake.sentence]
        return parts_at(self.places, mistake.place) or named

    def _choose(self, part: str | None) -> None:
        self.draft.select(None if part is None else place_of(self.places, part))

    def _fit(self) -> None:
        self.box = None
        self.drawing.fit()
