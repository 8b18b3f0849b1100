"""What a notebook shows, by type: results as in the first part of their report, models as a drawing."""

from dataclasses import replace
from functools import singledispatch
from typing import Any

import numpy as np
import plotly.graph_objects as go

from dalembert.multibody import Trajectory
from dalembert.multibody.model.system import BaseSystem
from dalembert.report.charts.motion.diagnostics import energies
from dalembert.report.charts.motion.mechanism import mechanism
from dalembert.report.contents import contents
from dalembert.report.headline import headline_of
from dalembert.report.notebook.figure import figure_svg
from dalembert.report.notebook.page import Summary
from dalembert.report.options import ReportOptions
from dalembert.report.pictures import picture
from dalembert.structure import Structure
from dalembert.vibration import VibrationSystem

NOT_FIRST = ("parameters",)
"""Figures that say what the key values say already."""
MOST_FINDINGS = 3
POSES = 7
"""Of a motion that is drawn."""


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
    figure = next(filter(None, map(figure_svg, drawn)), None)
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
    still = picture(result.system) if len(result.system.AXES) == 3 else figure_svg(_motion(result), height=320)
    pictures = [still, figure_svg(energies(result), height=320)]
    shown = [one for one in pictures if one]
    return Summary(headline.title, headline.verdict, headline.badge, [headline.status], headline.facts, shown)


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
        "forces": ", ".join(dict.fromkeys(force.dof for force in model.forces)),
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


def _motion(result: Trajectory) -> go.Figure:
    """The mechanism at its start, with faint poses along its motion."""
    drawing = result.drawing()
    poses = np.unique(np.linspace(0, len(drawing.times) - 1, POSES).round().astype(int))
    lines, joints = ({name: own[poses] for name, own in part.items()} for part in (drawing.lines, drawing.joints))
    return mechanism(replace(drawing, times=drawing.times[poses], lines=lines, joints=joints))
