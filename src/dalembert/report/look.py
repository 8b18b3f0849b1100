"""The look that all figures and the report's page share: colours, fonts, and the same figure in the dark."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from html import escape
from typing import Any

import plotly.graph_objects as go
from plotly.io import from_json

Axis = str | Mapping[str, Any]
"""Title of an axis, or its settings."""
FONT = "system-ui, -apple-system, 'Segoe UI', Roboto, 'Helvetica Neue', Arial, sans-serif"


@dataclass(frozen=True)
class Palette:
    """Colours by their use; those of ``series`` differ for any kind of colour vision (after Okabe and Ito)."""

    ink: str
    muted: str
    grid: str
    surface: str
    page: str
    series: tuple[str, ...]

    @property
    def colours(self) -> tuple[str, ...]:
        return (self.ink, self.muted, self.grid, self.surface, self.page, *self.series)


LIGHT = Palette(
    ink="#1f2733",
    muted="#5d6776",
    grid="#e3e7ec",
    surface="#fffffe",
    page="#f4f6f8",
    series=("#0069ab", "#cc5500", "#00855f", "#b0568f", "#a87400", "#2f93c9", "#7a4fb5"),
)
DARK = Palette(
    ink="#e5eaf0",
    muted="#9aa6b5",
    grid="#323b47",
    surface="#1a2029",
    page="#11161d",
    series=("#5cb3f0", "#ff9452", "#3ccca0", "#e89ccb", "#efc14e", "#9ad6f7", "#bfa0f0"),
)


def exchanged() -> dict[str, str]:
    """Each colour of the light palette with its dark counterpart."""
    return dict(zip(LIGHT.colours, DARK.colours, strict=True))


def dark(figure: go.Figure) -> go.Figure:
    """The same figure for a dark page: each colour of the light palette is exchanged for its counterpart.

    Examples
    --------
    >>> dark(themed(go.Figure())).layout.template.layout.paper_bgcolor == DARK.surface
    True
    """
    text = figure.to_json() or ""
    for light, counterpart in exchanged().items():
        text = text.replace(light, counterpart)
    return go.Figure(from_json(text))


def themed(
    figure: go.Figure, title: str = "", height: int = 420, *, x: Axis = "", y: Axis | Sequence[Axis] = "", **layout: Any
) -> go.Figure:
    """Return the figure in our look, with its title and those of its axes. ``height``: pixels; ``x``, ``y``: title of
    an axis, or its settings. Of rows below each other, ``y`` has one entry each, and ``x`` belongs to the lowest.
    """
    rows = [y] if isinstance(y, str | Mapping) else y
    for row, axis in enumerate(rows, start=1):
        figure.update_yaxes(_settings(axis), row=row if len(rows) > 1 else None)
    figure.update_xaxes(_settings(x), row=len(rows) if len(rows) > 1 else None)
    return figure.update_layout(template=template(), title_text=title, height=height, **layout)


def _settings(axis: Axis) -> dict[str, Any]:
    return {"title": axis or None} if isinstance(axis, str) else dict(axis)


def faint(colour: str, opacity: float = 0.22) -> str:
    """Return a colour of the palette for the inside of a band: what lies under it shines through, in the dark too."""
    return f"{colour}{round(255 * opacity):02x}"


def plain(text: object) -> str:
    """Return a user's text for a label: shown as it stands, where Plotly would read tags in it."""
    return escape(str(text), quote=False)


def template() -> go.layout.Template:
    """Plotly template of the light look."""
    axis = {
        "gridcolor": LIGHT.grid,
        "linecolor": LIGHT.muted,
        "tickcolor": LIGHT.muted,
        "tickfont": {"color": LIGHT.muted},
        "title": {"standoff": 8},
        "ticks": "outside",
        "ticklen": 4,
        "showline": True,
        "zeroline": False,
        "automargin": True,
        "exponentformat": "power",
    }
    return go.layout.Template(
        layout={
            "colorway": LIGHT.series,
            "font": {"family": FONT, "size": 13, "color": LIGHT.ink},
            "title": {"font": {"size": 16}, "x": 0, "xref": "paper", "xanchor": "left"},
            "paper_bgcolor": LIGHT.surface,
            "plot_bgcolor": LIGHT.surface,
            "xaxis": axis,
            "yaxis": axis,
            "legend": {"orientation": "h", "x": 0, "xanchor": "left", "y": 1.02, "yanchor": "bottom"},
            "margin": {"l": 56, "r": 16, "t": 72, "b": 48},
            "hovermode": "closest",
            "modebar": {"bgcolor": LIGHT.surface, "color": LIGHT.muted, "activecolor": LIGHT.series[0]},
            "hoverlabel": {
                "bgcolor": LIGHT.surface,
                "bordercolor": LIGHT.grid,
                "font": {"family": FONT, "color": LIGHT.ink},
            },
        }
    )
