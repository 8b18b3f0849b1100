"""The figure of a data file, and the model to pick a channel from."""

from collections.abc import Callable, Iterable, Sequence
from functools import partial

import plotly.graph_objects as go
from nicegui import ui

from dalembert.report.charts.drawing import colour_of, draw, stacked
from dalembert.report.look import plain, themed
from dalembert.studio.data.examined import Curve, Examined
from dalembert.studio.editor.draft import Draft
from dalembert.studio.model.picture import model_picture
from dalembert.studio.model.viewer import Viewer
from dalembert.studio.page_services import PageServices
from dalembert.studio.runs.figures import on_any_page
from dalembert.studio.worker import WorkerError
from dalembert.tables import labelled

MOST = 12
"""Columns that are drawn; those that are used come first."""
HEIGHT, AXES = 110, 70
"""Pixels of each column, and of what is around them."""
FEW = 200
"""Points up to which each is drawn as a circle."""


def drawn_columns(examined: Examined) -> Sequence[Curve]:
    """The columns that are drawn: no times, and those that are used first."""
    used = tuple(examined.choices.channels.values())
    curves = [curve for curve in examined.curves if curve.key != examined.choices.time]
    return sorted(curves, key=lambda curve: curve.key not in used)[:MOST]


def columns_figure(examined: Examined) -> go.Figure:
    """Return the figure of the columns; outliers of those that are used are marked."""
    curves = drawn_columns(examined)
    figure = stacked(*[1.0] * max(1, len(curves)), spacing=0.25 / max(1, len(curves)))
    for row, curve in enumerate(curves, 1):
        mode = "lines+markers" if len(curve.values) <= FEW else "lines"
        draw(figure, curve.along, curve.values, plain(str(curve.key)), colour_of(0), 1.5, row=row, mode=mode)
        figure.update_traces(selector={"mode": "lines+markers"}, marker_size=4)
        if curve.far.size:
            style = {"symbol": "circle-open", "size": 11, "color": colour_of(1), "line_width": 2}
            figure.add_scatter(
                x=curve.far[0], y=curve.far[1], mode="markers", marker=style, row=row, col=1, name="outliers"
            )
    for row, curve in enumerate(curves, 1):
        title = labelled(plain(str(curve.key)), "" if curve.unit.source == "file" else curve.unit.name)
        place = {"xref": "x domain", "yref": "y domain", "x": 0.0, "y": 1.0, "xanchor": "left", "yanchor": "bottom"}
        figure.add_annotation(text=title, showarrow=False, row=row, col=1, **place)
    themed(figure, "", height=HEIGHT * max(1, len(curves)) + AXES, showlegend=False, hovermode="x")
    numbered = examined.choices.time is None and examined.choices.rate is None
    along = "row" if numbered else labelled("time", "s")
    figure.update_xaxes(title={"text": along, "font_size": 13}, row=max(1, len(curves)), col=1)
    return on_any_page(figure)


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
    """A dialog with the drawing, which the keyboard reaches too, and the channels of the part that was chosen."""

    def __init__(self, draft: Draft, services: PageServices) -> None:
        self._draft, self._services = draft, services
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
            picture = await self._services.worker.ask(
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
        channels = channels_of_part(part, self._channels)
        self._view.mark([part], [])
        self._offers.clear()
        self._says.set_text(
            f"Channels of {part}:" if channels else f"There is no channel of {part}. Click another part."
        )
        with self._offers:
            for channel in channels:
                ui.button(channel, on_click=partial(self._taken, channel)).props("outline no-caps dense").classes(
                    "px-2"
                )

    def _taken(self, channel: str) -> None:
        self._dialog.close()
        self._take(channel)
