"""The model drawn beside its text, at the current values of the parameters."""

from dataclasses import replace
from pathlib import Path

from nicegui import ui

from dalembert.studio.editor.cursor import tolerant
from dalembert.studio.editor.draft import Draft
from dalembert.studio.editor.lines import Place
from dalembert.studio.editor.model_kind import model_elsewhere
from dalembert.studio.editor.reading import Mistake, study_of
from dalembert.studio.frame import icon_button
from dalembert.studio.model.parts import parts_at, place_of
from dalembert.studio.model.picture import Picture, Reader, model_picture
from dalembert.studio.model.viewer import Viewer
from dalembert.studio.pacing import Latest
from dalembert.studio.page_services import PageServices
from dalembert.studio.worker import Worker, WorkerError

TAB = "model", "Model", "precision_manufacturing"
"""Name, title and icon of the panel."""
STILL = 0.3
"""Seconds without a change of values after which the model is drawn at them."""
LAST = "The text has mistakes. The drawing shows the last valid text."
NONE = "The text has mistakes. The drawing appears when they are corrected."


def show(draft: Draft, services: PageServices) -> None:
    """Build the panel."""
    ModelPanel(draft, services.worker, draft.path)


class ModelPanel:
    """The drawing, messages about it, and buttons to zoom. ``path`` is that of the study. ``read`` returns the study
    from the text of the draft.
    """

    def __init__(self, draft: Draft, worker: Worker, path: Path, read: Reader = study_of) -> None:
        self.draft, self.worker, self.path, self.read = draft, worker, path, read
        self.picture = Picture()
        self.links: dict[str, ui.button] = {}
        with ui.column().classes("w-full h-full gap-1 flex-nowrap"):
            with ui.row().classes("w-full items-center gap-1 flex-nowrap"):
                self.told = ui.label("Drawing the model …").classes("text-sm grow").props("role=status")
                icon_button("zoom_in", "Enlarge the drawing", lambda: self.view.scale(0.8))
                icon_button("zoom_out", "Reduce the drawing", lambda: self.view.scale(1.25))
                icon_button("fit_screen", "Show all of the drawing", self._fit)
            self.view = Viewer(self._choose).classes("w-full grow min-h-0")
            self.others = ui.row().classes("w-full items-center gap-1").props('role=group aria-label="Not drawn"')
        draft.follow("study", Latest(self._draw))
        draft.follow("values", Latest(self._draw, STILL))  # by sliders, which another panel shows: theirs comes first
        draft.follow("selection", self._mark)
        draft.follow("mistakes", self._mark)

    @property
    def places(self) -> dict[str, Place]:
        return self.picture.places

    async def _draw(self) -> None:
        """Draw the study; while its text has mistakes, the last drawing stays, with the wrong parts marked."""
        draft = self.draft
        self._mark()
        if draft.study is None:
            self.told.set_text(LAST if self.picture.svg else NONE if draft.mistakes else "")
            return
        try:
            request = self.path, draft.reading.text, dict(draft.values), self.picture.box, self.read
            picture = await self.worker.ask("model", model_picture, *request)
        except WorkerError as error:
            self.told.set_text(str(error))
            return
        if picture is not None:
            self._show(picture)

    def _show(self, picture: Picture) -> None:
        self.told.set_text(picture.message)
        if picture.mistake:
            self.draft.find(picture.mistake)
        if picture.svg or not picture.mistake:
            self.picture = picture
            self.view.draw(picture)
            self._list()
        self._mark()

    def _list(self) -> None:
        if list(self.links) == list(self.picture.absent):
            return
        self.others.clear()
        with self.others:
            if self.picture.absent:
                ui.label("Not drawn:").classes("text-sm")
            self.links = {name: self._link(name) for name in self.picture.absent}

    def _link(self, part: str) -> ui.button:
        link = ui.button(part, on_click=lambda: self._choose(part), color=None)
        return link.props('flat dense no-caps padding="0 6px"').classes("model-part underline text-sm")

    def _mark(self) -> None:
        wrong = [part for mistake in self.draft.mistakes for part in self._parts_of(mistake)]
        chosen = parts_at(self.places, self.draft.selection, self.picture.parts)
        self.view.mark(chosen, wrong)
        for part, link in self.links.items():
            link.props(f"aria-pressed={str(part in chosen).lower()}")
            marks = {"chosen": part in chosen, "wrong": part in wrong}
            link.classes(" ".join(mark for mark, has in marks.items() if has), remove="chosen wrong")

    def _parts_of(self, mistake: Mistake) -> list[str]:
        """The parts that a mistake is about, by its place or by the names in its sentence."""
        named = [part for part in self.places if f"'{part.partition(' ')[2]}'" in mistake.sentence]
        return parts_at(self.places, mistake.place) or named

    def _choose(self, part: str | None) -> None:
        place = None if part is None else place_of(self.places, part)
        elsewhere = model_elsewhere(tolerant(self.draft.text)) if place and place[0] == "model" else ""
        self.told.set_text(elsewhere or self.picture.message)
        self.draft.select(place)

    def _fit(self) -> None:
        self.picture = replace(self.picture, box=None)
        self.view.fit()
