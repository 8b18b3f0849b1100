"""Which sections a result calls for."""

from collections.abc import Mapping, Sequence
from typing import Any

from dalembert.errors import InputError
from dalembert.report import charts
from dalembert.report.charts.correlation import unknowns
from dalembert.report.charts.methods import reference
from dalembert.report.needs import (
    BandFitLike,
    ComparisonLike,
    FitLike,
    ParameterSetLike,
    PropagationLike,
    SweepLike,
    TrajectoryLike,
)
from dalembert.report.needs_telling import DesignsLike, PredictionLike, ProfilesLike
from dalembert.report.plot import Plot
from dalembert.report.sections import (
    Bounds,
    Comparison,
    Consistent,
    Designing,
    Diagnostics,
    Estimates,
    Experiments,
    GivenBands,
    Intervals,
    Methods,
    Motion,
    Predicting,
    Profiling,
    Provenance,
    Search,
    Section,
    Sweeps,
    Telling,
    bound_headlines,
    headline,
    motion,
    telling_headlines,
)

Result = (
    FitLike
    | TrajectoryLike
    | SweepLike
    | PropagationLike
    | ComparisonLike
    | BandFitLike
    | ParameterSetLike
    | ProfilesLike
    | PredictionLike
    | DesignsLike
)


def contents(
    result: Result,
    *,
    title: str | None = None,
    trajectory: TrajectoryLike | None = None,
    notes: Sequence[str] = (),
    study: str | None = None,
    points: tuple[str, ...] = (),
    truth: Mapping[str, Any] | None = None,
    profiles: ProfilesLike | None = None,
    prediction: PredictionLike | None = None,
) -> list[Section]:
    """Sections of a report in reading order; the first is the headline.

    Raises
    ------
    InputError
        For a result that no report is known for.
    """
    known = truth or {}
    match result:
        case FitLike():
            own = [headline.of_fit(result, title, notes), Estimates(result), _compared(result)]
            moving = [] if trajectory is None else _motion(trajectory, points, result)
            checks = [] if trajectory is None else [Diagnostics(trajectory)]
            sections = [*own, *moving, *_search(result), *_telling(result), *_beyond(profiles, prediction), *checks]
        case BandFitLike():
            own = [bound_headlines.of_band_fit(result, title, notes), Intervals(result, known), GivenBands(result)]
            sections = [*own, *_search(result), *_telling(result)]
        case PropagationLike():
            sections = [bound_headlines.of_propagation(result, title, notes), Bounds(result)]
        case ComparisonLike():
            own = [bound_headlines.of_comparison(result, title, notes), Methods(result)]
            sections = [*own, Bounds(reference(result))]
        case ParameterSetLike():
            sections = [bound_headlines.of_set(result, title, notes), Consistent(result, known)]
        case ProfilesLike():
            sections = [telling_headlines.of_profiles(result, title, notes), Profiling(result)]
        case PredictionLike():
            sections = [telling_headlines.of_prediction(result, title, notes), Predicting(result)]
        case DesignsLike():
            sections = [telling_headlines.of_designs(result, title, notes), Designing(result)]
        case TrajectoryLike():
            sections = [headline.of_trajectory(result, title, notes), *_motion(result, points), Diagnostics(result)]
        case SweepLike():
            sections = [headline.of_sweep(result, title, notes), Sweeps(result)]
        case _:
            raise InputError(
                f"report: a {type(result).__name__} was given; expected a result, such as identify(), simulate() or "
                "propagate() return"
            )
    facts = getattr(result, "provenance", {})
    return [*sections, Provenance(facts, study)] if facts or study else sections


def _compared(fit: FitLike) -> Section:
    """The response against the data, or, of several experiments, each against its own."""
    experiments = tuple(getattr(fit, "experiments", ()))
    return Experiments(fit, experiments) if experiments else Comparison(fit)


def _motion(trajectory: TrajectoryLike, points: tuple[str, ...], fit: FitLike | None = None) -> list[Section]:
    drawing = trajectory.drawing()
    measured = {} if fit is None else motion.measured(fit.data.channels, fit.data.values)
    known = set(trajectory.channel_names)
    followed = points or tuple(point for point in measured if {f"{point}.x", f"{point}.y"} <= known)
    return [Motion(drawing, motion.paths(trajectory, drawing, followed), measured)]


def _search(fit: FitLike | BandFitLike) -> list[Section]:
    return [Search(fit)] if fit.history else []


def _telling(fit: FitLike | BandFitLike) -> list[Section]:
    """The section on identifiability, where there is more than one unknown or something to say."""
    ask: Any = getattr(fit, "identifiability", None)
    told = ask() if ask is not None else None
    sentences = tuple(str(told).splitlines()) if told is not None else ()
    names, spectrum = unknowns(fit), None
    if told is not None and hasattr(told, "singular_values"):
        figure = charts.singular_values(told.singular_values, told.directions, names)
        spectrum = Plot("singular-values", figure, "A small value is a combination that the data hardly tell.")
    return [Telling(fit, sentences, spectrum)] if len(names) > 1 or sentences else []


def _beyond(profiles: ProfilesLike | None, prediction: PredictionLike | None) -> list[Section]:
    """The sections on profiles and prediction of a fit, where they were made."""
    first: list[Section] = [] if profiles is None else [Profiling(profiles)]
    return first if prediction is None else [*first, Predicting(prediction)]
