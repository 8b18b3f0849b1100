"""A figure on its way into a page."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import cached_property
from html import unescape
from typing import Any, ClassVar, TypeVar

import plotly.graph_objects as go
from markupsafe import Markup
from plotly.io import to_json

SAFE = str.maketrans({"<": "\\u003c", ">": "\\u003e", "&": "\\u0026"})
"""Characters that could end a script element, as JSON may write them."""


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
        bare = go.Figure(self.figure)
        bare.layout.template = None  # pyright: ignore[reportAttributeAccessIssue]
        bare.layout.title = None  # pyright: ignore[reportAttributeAccessIssue]
        bare.layout.updatemenus, bare.layout.sliders = (), ()  # pyright: ignore[reportAttributeAccessIssue]
        return Markup((to_json(bare) or "").translate(SAFE))


def numbered(name: str, given: Mapping[str, Shown]) -> Iterator[tuple[str, str, Shown]]:
    """Name of a figure's place, name of the experiment, and what was given for it.

    >>> list(numbered("mechanism", {"": 3})), list(numbered("mechanism", {"warm": 3}))
    ([('mechanism', '', 3)], [('mechanism-1', 'warm', 3)])
    """
    for number, (experiment, one) in enumerate(given.items(), start=1):
        yield f"{name}-{number}" if experiment else name, experiment, one
