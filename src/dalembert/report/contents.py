"""Which sections a result calls for."""

from collections.abc import Sequence
from typing import Any

from dalembert.errors import InputError
from dalembert.report import charts
from dalembert.report.needs import FitLike, SweepLike, TrajectoryLike
from dalembert.report.plot import Plot
from dalembert.report.sections import (
    Comparison,
    Diagnostics,
    Estimates,
    Motion,
    Provenance,
    Search,
    Section,
    Sweeps,
    Telling,
    headline,
    motion,
)

Result = FitLike | TrajectoryLike | SweepLike


def contents(
    result: Result,
    *,
    title: str | None = None,
    trajectory: TrajectoryLike | None = None,
    notes: Sequence[str] = (),
    study: str | None = None,
    points: tuple[str, ...] = (),
) -> list[Section]:
    """Sections of a report in reading order; the first is the headline.

    Raises
    ------
    InputError
        For a result that is none of a fit, a trajectory and a sweep.
    """
    if isinstance(result, FitLike):
        own = [headline.of_fit(result, title, notes), Estimates(result), Comparison(result)]
        moving = [] if trajectory is None else _motion(trajectory, points, result)
        searched = [Search(result)] if result.history else []
        checks = [] if trajectory is None else [Diagnostics(trajectory)]
        sections = [*own, *moving, *searched, *_telling(result), *checks]
    elif isinstance(result, TrajectoryLike):
        sections = [headline.of_trajectory(result, title, notes), *_motion(result, points), Diagnostics(result)]
    elif isinstance(result, SweepLike):
        sections = [headline.of_sweep(result, title, notes), Sweeps(result)]
    else:
        raise InputError(
            f"report: a {type(result).__name__} was given; expected a Fit, a Trajectory or a sweep, "
            "such as identify() or simulate() return"
        )
    facts = getattr(result, "provenance", {})
    return [*sections, Provenance(facts, study)] if facts or study else sections


def _motion(trajectory: TrajectoryLike, points: tuple[str, ...], fit: FitLike | None = None) -> list[Section]:
    drawing = trajectory.drawing()
    measured = {} if fit is None else motion.measured(fit.data.channels, fit.data.values)
    known = set(trajectory.channel_names)
    followed = points or tuple(point for point in measured if {f"{point}.x", f"{point}.y"} <= known)
    return [Motion(drawing, motion.paths(trajectory, drawing, followed), measured)]


def _telling(fit: FitLike) -> list[Section]:
    """The section on identifiability, where there is more than one parameter or something to say."""
    ask: Any = getattr(fit, "identifiability", None)
    told = ask() if ask is not None else None
    sentences = tuple(str(told).splitlines()) if told is not None else ()
    spectrum = None
    if told is not None and hasattr(told, "singular_values"):
        figure = charts.singular_values(told.singular_values, told.directions, fit.parameters.names)
        spectrum = Plot("singular-values", figure, "A small value is a combination that the data hardly tell.")
    return [Telling(fit, sentences, spectrum)] if len(fit.parameters) > 1 or sentences else []
