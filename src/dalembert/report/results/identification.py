"""Sections of fits, of intervals and sets identified, and of what is known beyond a fit."""

from dalembert.inverse import BandFit, Designs, Fit, ParameterSet, Prediction, Profiles
from dalembert.multibody import Trajectory
from dalembert.report import charts
from dalembert.report.asked import Asked
from dalembert.report.charts.correlation import unknowns
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


@sections_of(Fit)
def fit(result: Fit, asked: Asked) -> list[Section]:
    """Estimates, the response against the data, the motion, the search, and what is known beyond."""
    moving, profiles, predictions = asked.each(Trajectory), asked.one(Profiles), asked.each(Prediction)
    return [
        headline.of_fit(result, asked.title, asked.notes),
        Estimates(result),
        _compared(result),
        *motions(moving, asked.points, result),
        *_search(result),
        *([] if result.nodes is None else [Shooting(result, result.nodes)]),
        _telling(result),
        *([Profiling(profiles)] if profiles is not None else []),
        *([Predicting(predictions)] if predictions else []),
        *([Diagnostics(moving)] if moving else []),
    ]


@sections_of(BandFit)
def band_fit(result: BandFit, asked: Asked) -> list[Section]:
    """Intervals, the bands, and the search."""
    own = [Intervals(result, asked.truth), GivenBands(result)]
    return [bound_headlines.of_band_fit(result, asked.title, asked.notes), *own, *_search(result), _telling(result)]


@sections_of(ParameterSet)
def parameter_set(result: ParameterSet, asked: Asked) -> list[Section]:
    """The paving of the set."""
    return [bound_headlines.of_set(result, asked.title, asked.notes), Consistent(result, asked.truth)]


register_single(Profiles, telling_headlines.of_profiles, Profiling)


@sections_of(Prediction)
def prediction(result: Prediction, asked: Asked) -> list[Section]:
    """Bands of a response."""
    return [telling_headlines.of_prediction(result, asked.title, asked.notes), Predicting({"": result})]


register_single(Designs, telling_headlines.of_designs, Designing)


def _compared(fit: Fit) -> Section:
    """The response against the data, or, of several experiments, each against its own."""
    return Experiments(fit, fit.experiments) if fit.experiments else Comparison(fit)


def _search(fit: Fit | BandFit) -> list[Section]:
    return [Search(fit)] if fit.history else []


def _telling(fit: Fit | BandFit) -> Section:
    """The section on identifiability."""
    known = fit.identifiability()
    figure = charts.singular_values(known.singular_values, known.directions, unknowns(fit))
    spectrum = Plot("singular-values", figure, "A small value is a combination that the data hardly tell.")
    return Telling(fit, tuple(str(known).splitlines()), spectrum)
