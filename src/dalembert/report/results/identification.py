"""Sections of fits, of intervals and sets identified, and of what is known beyond a fit."""

from typing import Any

from dalembert.report import charts
from dalembert.report.asked import Asked
from dalembert.report.charts.correlation import unknowns
from dalembert.report.needs import BandFitLike, FitLike, IdentifiedLike, ParameterSetLike, TrajectoryLike
from dalembert.report.needs_telling import DesignsLike, PredictionLike, ProfilesLike
from dalembert.report.plot import Plot
from dalembert.report.registry import register_single, sections_of
from dalembert.report.results.moving import motions
from dalembert.report.sections import (
    Comparison,
    Consistent,
    Designing,
    Diagnostics,
    Estimates,
    Experiments,
    GivenBands,
    Intervals,
    Predicting,
    Profiling,
    Search,
    Section,
    Shooting,
    Telling,
    bound_headlines,
    headline,
    telling_headlines,
)


@sections_of(FitLike)
def fit(result: FitLike, asked: Asked) -> list[Section]:
    """Estimates, the response against the data, the motion, the search, and what is known beyond."""
    moving, profiles, predictions = asked.each(TrajectoryLike), asked.one(ProfilesLike), asked.each(PredictionLike)
    return [
        headline.of_fit(result, asked.title, asked.notes),
        Estimates(result),
        _compared(result),
        *motions(moving, asked.points, result),
        *_search(result),
        *_shooting(result),
        *_telling(result),
        *([Profiling(profiles)] if profiles is not None else []),
        *([Predicting(predictions)] if predictions else []),
        *([Diagnostics(moving)] if moving else []),
    ]


@sections_of(BandFitLike)
def band_fit(result: BandFitLike, asked: Asked) -> list[Section]:
    """Intervals, the bands, and the search."""
    own = [Intervals(result, asked.truth), GivenBands(result)]
    return [bound_headlines.of_band_fit(result, asked.title, asked.notes), *own, *_search(result), *_telling(result)]


@sections_of(ParameterSetLike)
def parameter_set(result: ParameterSetLike, asked: Asked) -> list[Section]:
    """The paving of the set."""
    return [bound_headlines.of_set(result, asked.title, asked.notes), Consistent(result, asked.truth)]


register_single(ProfilesLike, telling_headlines.of_profiles, Profiling)


@sections_of(PredictionLike)
def prediction(result: PredictionLike, asked: Asked) -> list[Section]:
    """Bands of a response."""
    return [telling_headlines.of_prediction(result, asked.title, asked.notes), Predicting({"": result})]


register_single(DesignsLike, telling_headlines.of_designs, Designing)


def _compared(fit: FitLike) -> Section:
    """The response against the data, or, of several experiments, each against its own."""
    experiments = tuple(getattr(fit, "experiments", ()))
    return Experiments(fit, experiments) if experiments else Comparison(fit)


def _search(fit: IdentifiedLike) -> list[Section]:
    return [Search(fit)] if fit.history else []


def _shooting(fit: FitLike) -> list[Section]:
    """The section on segments, where the fit is of multiple shooting."""
    nodes = getattr(fit, "nodes", None)
    return [] if nodes is None else [Shooting(fit, nodes)]


def _telling(fit: IdentifiedLike) -> list[Section]:
    """The section on identifiability, where there is more than one unknown or something to say."""
    ask: Any = getattr(fit, "identifiability", None)
    told = ask() if ask is not None else None
    sentences = tuple(str(told).splitlines()) if told is not None else ()
    names, spectrum = unknowns(fit), None
    if told is not None and hasattr(told, "singular_values"):
        figure = charts.singular_values(told.singular_values, told.directions, names)
        spectrum = Plot("singular-values", figure, "A small value is a combination that the data hardly tell.")
    return [Telling(fit, sentences, spectrum)] if len(names) > 1 or sentences else []
