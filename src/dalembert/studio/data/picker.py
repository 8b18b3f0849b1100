"""Pick the channel of a column in the drawing of the model."""

from collections.abc import Callable, Iterable, Sequence
from functools import partial

from nicegui import ui

from dalembert.studio.editor.draft import Draft
from dalembert.studio.model.picture import model_picture
from dalembert.studio.model.viewer import Viewer
from dalembert.studio.room import Room
from dalembert.studio.worker import WorkerError

HOW = "Click the point, joint or body that was measured."


def channels_of_part(part: str, channels: Iterable[str]) -> list[str]:
    """Return the channels of a part of a drawing; those of one of its points if it is one.

    >>> channels = ["rod.end.x", "rod.end.y", "rod.angle", "rod2.angle", "pin.angle"]
    >>> channels_of_part("body rod", channels), channels_of_part("point rod.end", channels)
    (['rod.end.x', 'rod.end.y', 'rod.angle'], ['rod.end.x', 'rod.end.y'])
    >>> channels_of_part("channel rod.end.x", channels), channels_of_part("joint pin", channels)
    (['rod.end.x', 'rod.end.y'], ['pin.angle'])
    """
    role, _, name = part.partition(" ")
    owner = name.rpartition(".")[0] if role == "channel" else name
    return [channel for channel in channels if channel.startswith(f"{owner}.")]


class ChannelPicker:
    """A dialog with the drawing, which the keyboard reaches too, and the channels of the part that was chosen.

    Parameters
    ----------
    draft : Draft
    room : Room
    """

    def __init__(self, draft: Draft, room: Room) -> None:
        self._draft, self._room = draft, room
        self._channels: Sequence[str] = ()
        self._take: Callable[[str], object] = lambda channel: None
        with ui.dialog() as self._dialog, ui.card().classes("w-[44rem] max-w-full"):
            self._title = ui.label("").classes("font-bold")
            self._says = ui.label(HOW).props("role=status aria-live=polite").classes("text-sm")
            self._offers = ui.row().classes("gap-2 max-h-36 overflow-auto w-full")
            self._offers.props('role=group aria-label="Channels of the part"')
            self._view = Viewer(self._chosen).classes("w-full").style("height: 22rem")
            ui.button("Cancel", on_click=self._dialog.close).props("flat no-caps")

    async def pick(self, column: str, channels: Sequence[str], take: Callable[[str], object]) -> None:
        """Ask for the channel of a column, and call ``take`` with it."""
        self._channels, self._take = channels, take
        self._title.set_text(f"Channel of column {column}")
        self._says.set_text(HOW)
        self._offers.clear()
        self._dialog.open()
        draft = self._draft
        try:
            picture = await self._room.worker.ask(
                "picker", model_picture, draft.path, draft.reading.text, dict(draft.values), None
            )
        except WorkerError as error:
            self._says.set_text(str(error))
            return
        if picture is not None:
            self._view.draw(picture)
            if not picture.svg:
                self._says.set_text(picture.message)

    def _chosen(self, part: str | None) -> None:
        if part is None:
            return
        found = channels_of_part(part, self._channels)
        self._view.mark([part], [])
        self._offers.clear()
        self._says.set_text(f"Channels of {part}:" if found else f"There is no channel of {part}. Click another part.")
        with self._offers:
            for channel in found:
                ui.button(channel, on_click=partial(self._taken, channel)).props("outline no-caps dense").classes(
                    "px-2"
                )

    def _taken(self, channel: str) -> None:
        self._dialog.close()
        self._take(channel)
