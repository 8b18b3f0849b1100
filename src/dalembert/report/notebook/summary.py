"""What a notebook shows of a result or a model, as HTML."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from functools import singledispatch
from html import escape
from typing import Any

from dalembert.multibody import Trajectory
from dalembert.multibody.model.system import BaseSystem
from dalembert.report.charts.motion.diagnostics import energies
from dalembert.report.contents import contents
from dalembert.report.headline import headline_of
from dalembert.report.look import FONT
from dalembert.report.notebook.figure import figure_svg
from dalembert.report.options import ReportOptions
from dalembert.report.pictures import picture
from dalembert.report.player.animation import Animation
from dalembert.structure import Structure
from dalembert.vibration import VibrationSystem

CELL = "padding:0.1rem 0.9rem 0.1rem 0;text-align:left;border:none;font-variant-numeric:tabular-nums"
BADGES = {"good": "#00704f", "doubtful": "#8a5a00", "bad": "#b3261e", "": "#5d6776"}
"""Colours of verdicts behind white text."""


@dataclass(frozen=True)
class Summary:
    """What a notebook shows.

    Parameters
    ----------
    title : str
    verdict, badge : str
        A word, and how it is meant: ``"good"``, ``"doubtful"`` or ``"bad"``.
    sentences : sequence of str
    facts : mapping of str to str
    pictures : sequence of str
        SVG, beside each other where there is room.
    """

    title: str
    verdict: str = ""
    badge: str = ""
    sentences: Sequence[str] = ()
    facts: Mapping[str, str] = field(default_factory=dict)
    pictures: Sequence[str] = ()

    def html(self) -> str:
        """Return the summary as one HTML element, in the colours of the notebook."""
        colour = f"background:{BADGES[self.badge]};color:#fff;border-radius:0.25rem;padding:0 0.4rem"
        verdict = f' <span style="{colour}">{escape(self.verdict)}</span>' if self.verdict else ""
        sentences = "".join(
            f'<p style="margin:0.3rem 0;max-width:60rem">{escape(sentence)}</p>'
            for sentence in self.sentences
            if sentence
        )
        rows = "".join(
            f'<tr style="background:none"><th scope="row" style="{CELL};font-weight:normal">{escape(name)}</th>'
            f'<td style="{CELL}">{escape(text)}</td></tr>'
            for name, text in self.facts.items()
        )
        table = f'<table style="border-collapse:collapse;margin:0.3rem 0">{rows}</table>' if rows else ""
        figures = "".join(f'<div style="max-width:100%">{picture}</div>' for picture in self.pictures)
        beside = f'<div style="display:flex;flex-wrap:wrap;gap:1rem;align-items:flex-start">{figures}</div>'
        head = f"<div><strong>{escape(self.title)}</strong>{verdict}</div>"
        content = f"{head}{sentences}{table}{beside if figures else ''}"
        return f'<div style="font-family:{escape(FONT)};line-height:1.45">{content}</div>'


NOT_FIRST = ("parameters",)
"""Figures that say what the key values say already."""
MOST_FINDINGS = 3


@singledispatch
def shown_in_notebook(result: Any) -> Summary | None:
    """Return what a notebook shows; None for the plain text. Register a function for a type of your own.

    Parameters
    ----------
    result : result or model
        Of a result that has sections in reports: its verdict, key values, and first figure.

    Raises
    ------
    InputError
        For a type that no sections are registered for.
    """
    headline, *sections = contents(result, ReportOptions())
    drawn = (plot.figure for section in sections for plot in section.plots if plot.name not in NOT_FIRST)
    figure = next(filter(None, map(_svg, drawn)), None)
    findings = [
        str(finding) for finding in headline.findings if finding.doubtful and str(finding) not in headline.status
    ]
    return Summary(
        title=headline.title,
        verdict=headline.verdict,
        badge=headline.badge,
        sentences=[headline.status, *headline.doubts, *findings[:MOST_FINDINGS]],
        facts=headline.facts,
        pictures=[figure] if figure else [],
    )


def html_of(value: object) -> str | None:
    """Return the HTML that a notebook shows; None for the plain text."""
    summary = shown_in_notebook(value)
    return None if summary is None else summary.html()


@shown_in_notebook.register
def _(result: Trajectory) -> Summary:
    headline = headline_of(result)
    pictures = [Animation.of(result.drawing()).svg, _svg(energies(result))]
    return Summary(headline.title, headline.verdict, headline.badge, [headline.status], headline.facts, pictures)


@shown_in_notebook.register
def _(model: BaseSystem) -> Summary | None:
    drawing = picture(model)
    kinds = {"bodies": model.bodies, "joints": model.joints, "loads and sensors": model.loads}
    facts = {name: ", ".join(_named(own)) for name, own in kinds.items() if own}
    return None if drawing is None else Summary("Mechanism", facts=facts, pictures=[drawing])


@shown_in_notebook.register
def _(model: VibrationSystem) -> Summary:
    facts = {
        "degrees of freedom": str(model.structure.size),
        "forces": ", ".join(dict.fromkeys(dof for force in model.forces for dof in force.dofs)),
        "contacts and springs": ", ".join(_named(model.elements)),
    }
    drawing = picture(model)
    return Summary(
        "Structure with forces and contacts" if model.elements else "Structure",
        facts={name: text for name, text in facts.items() if text},
        pictures=[drawing] if drawing else [],
    )


@shown_in_notebook.register
def _(model: Structure) -> Summary | None:
    return shown_in_notebook(VibrationSystem(model))


def _named(parts: Any, most: int = 8) -> list[str]:
    """Names of parts with their kinds, the first few."""
    names = [f"{part.name} ({type(part).__name__})" for part in parts]
    return names if len(names) <= most else [*names[:most], f"and {len(names) - most} more"]


def _svg(figure: Any) -> str | None:
    """A figure as SVG; None for one that is not made of lines and points in the plane."""
    return figure.svg if isinstance(figure, Animation) else figure_svg(figure)
