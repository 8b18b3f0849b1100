"""A section of a report, and what it is made of."""

from collections import defaultdict
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from html import unescape
from typing import Any, ClassVar, TypeVar

import numpy as np
import plotly.graph_objects as go
from jinja2 import Environment
from markupsafe import Markup
from plotly.io import to_json

from dalembert.forward import Coordinate
from dalembert.report.inline import SAFE
from dalembert.report.player import PAGE_LOOKS
from dalembert.report.player.animation import Animation
from dalembert.tables import Table, labelled

MOST_ROWS = 5000
"""Numbers of a series up to which a page holds them."""

Shown = TypeVar("Shown")


@dataclass(frozen=True)
class Plot:
    """A figure, the name of its place in the page, and a sentence on how to read it."""

    macro: ClassVar[str] = "figure"
    name: str
    figure: go.Figure
    caption: str = ""

    @property
    def title(self) -> str:
        """As a person reads it, so that the page escapes it once and not twice."""
        return unescape(self.figure.layout.title.text or "")  # pyright: ignore[reportAttributeAccessIssue]

    @property
    def height(self) -> int:
        return int(self.figure.layout.height or 420)  # pyright: ignore[reportAttributeAccessIssue]

    @property
    def film(self) -> dict[str, Any] | None:
        """Labels of the frames, seconds and pace of an animation."""
        meta = self.figure.layout.meta  # pyright: ignore[reportAttributeAccessIssue]
        return meta if self.figure.frames else None

    @cached_property
    def json(self) -> Markup:
        """The figure for a script element: without title, template and controls, which the page has itself."""
        bare = self.figure.to_dict()  # a copy as a Figure would check all of it again
        for key in ("template", "title", "updatemenus", "sliders"):
            bare["layout"].pop(key, None)
        return Markup((to_json(bare, validate=False) or "").translate(SAFE))


@dataclass(frozen=True)
class Motion:
    """A mechanism in motion, the name of its place in the page, and a sentence on how to read it."""

    macro: ClassVar[str] = "motion"
    name: str
    figure: Animation
    caption: str = ""

    @property
    def element(self) -> Markup:
        """The picture and the film, in the colours of the page."""
        return self.figure.element(self.name, PAGE_LOOKS)


@dataclass(frozen=True)
class Row:
    """Figures side by side, where the page is wide enough; below each other if not ``side_by_side``."""

    macro: ClassVar[str] = "figures"
    plots: Sequence[Plot]
    side_by_side: bool = True


@dataclass(frozen=True)
class Listed:
    """Sentences as a list."""

    macro: ClassVar[str] = "listed"
    sentences: Sequence[str]


@dataclass(frozen=True)
class Download:
    """A link to a table that is not shown; nothing where there is none."""

    macro: ClassVar[str] = "download_of"
    table: Table | None
    words: str


@dataclass(frozen=True)
class Source:
    """A text as it was written, folded away."""

    macro: ClassVar[str] = "source"
    title: str
    text: str


Block = str | Plot | Motion | Row | Table | Listed | Download | Source
"""What stands in a section; a str is a paragraph, left out if it is empty."""


@dataclass(frozen=True)
class Section:
    """A part of the page: a heading, and what is below it."""

    template: ClassVar[str] = "section.html"
    heading: str
    blocks: Sequence[Block] = ()

    @property
    def anchor(self) -> str:
        """Where in the page the section is."""
        return self.heading.lower().replace(" ", "-")

    @property
    def plots(self) -> list[Plot | Motion]:
        """All figures."""
        rows = [block.plots if isinstance(block, Row) else [block] for block in self.blocks]
        return [plot for row in rows for plot in row if isinstance(plot, Plot | Motion)]

    def html(self, environment: Environment) -> Markup:
        """The section, rendered by its template."""
        return Markup(environment.get_template(self.template).render(section=self))


class ReportSection(Section):
    """A section of a report: sentences, Plotly figures and tables.

    Parameters
    ----------
    heading : str
    sentences : tuple of str
    figures : mapping of str to plotly.graph_objects.Figure
        By their captions. Their titles stand in the figures' layouts.
    tables : tuple of Table

    Examples
    --------
    >>> ReportSection("Weather", ("It rained.",)).anchor
    'weather'
    """

    def __init__(
        self,
        heading: str,
        sentences: Sequence[str] = (),
        figures: Mapping[str, Any] | None = None,
        tables: Sequence[Table] = (),
    ) -> None:
        name = Section(heading).anchor
        drawn = enumerate((figures or {}).items(), start=1)
        plots = [Plot(f"{name}-{number}", figure, caption) for number, (caption, figure) in drawn]
        super().__init__(heading, (*sentences, *plots, *tables))


def by_name(tables: Iterable[Table]) -> dict[str, list[Table]]:
    """Each table by its name, as a list, so that a name without a table stands for none."""
    named: dict[str, list[Table]] = defaultdict(list)
    for table in tables:
        named[table.name].append(table)
    return named


def numbered(name: str, by_experiment: Mapping[str, Shown]) -> Iterator[tuple[str, str, Shown]]:
    """Yield the name of a figure's place, the name of the experiment, and what was given for it.
    >>> list(numbered("mechanism", {"": 3})), list(numbered("mechanism", {"warm": 3}))
    ([('mechanism', '', 3)], [('mechanism-1', 'warm', 3)])
    """
    for number, (experiment, item) in enumerate(by_experiment.items(), start=1):
        yield f"{name}-{number}" if experiment else name, experiment, item


def samples(
    name: str, along: Coordinate, channels: Sequence[str], series: Mapping[str, np.ndarray], words: str
) -> Download:
    """Download of series (samples, channels), each with its word; of nothing where they are too many for a page."""
    if max(values.size for values in series.values()) > MOST_ROWS:
        return Download(None, words)
    columns = {labelled(along.name, along.unit): along.values}
    columns |= {
        f"{channel} {word}".rstrip(): values[:, column]
        for column, channel in enumerate(channels)
        for word, values in series.items()
    }
    return Download(Table.of(name, "", columns), words)
