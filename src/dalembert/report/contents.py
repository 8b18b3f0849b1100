"""Which sections a result calls for."""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any

from dalembert.errors import InputError
from dalembert.report import charts
from dalembert.report.charts.correlation import unknowns
from dalembert.report.charts.methods import reference
from dalembert.report.charts.resonance_peaks import value_text
from dalembert.report.each import each
from dalembert.report.focus import Look, family_dofs
from dalembert.report.needs import (
    BandFitLike,
    ComparisonLike,
    FitLike,
    IdentifiedLike,
    ParameterSetLike,
    PropagationLike,
    SweepLike,
    TrajectoryLike,
)
from dalembert.report.needs_frequency import (
    BackboneLike,
    CurveFamilyLike,
    DeformationLike,
    FrequencyCurveLike,
    ModeShapesLike,
    PeriodicMotionLike,
    ReductionErrorsLike,
    ResonanceTrackLike,
    TimeComparisonLike,
)
from dalembert.report.needs_integrators import WorkPrecisionLike
from dalembert.report.needs_telling import DesignsLike, PredictionLike, ProfilesLike
from dalembert.report.plot import Plot
from dalembert.report.sections import (
    Balance,
    Bounds,
    Comparison,
    Consistent,
    Deformed,
    Designing,
    Diagnostics,
    Estimates,
    Experiments,
    Family,
    ForcedResponse,
    Friction,
    GivenBands,
    Harmonics,
    Integrators,
    Intervals,
    InTime,
    Methods,
    Modes,
    Motion,
    NonlinearMode,
    Period,
    Predicting,
    Profiling,
    Provenance,
    Reduction,
    Search,
    Section,
    Shooting,
    Sweeps,
    Telling,
    Tracks,
    bound_headlines,
    headline,
    motion,
    telling_headlines,
    vibration_headlines,
)
from dalembert.report.sections.family import best_curve

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
    | WorkPrecisionLike
    | FrequencyCurveLike
    | CurveFamilyLike
    | TimeComparisonLike
    | BackboneLike
    | ResonanceTrackLike
    | DeformationLike
    | ModeShapesLike
    | PeriodicMotionLike
    | ReductionErrorsLike
)


def contents(
    result: Result,
    *,
    title: str | None = None,
    trajectory: TrajectoryLike | Mapping[str, TrajectoryLike] | None = None,
    notes: Sequence[str] = (),
    study: str | None = None,
    points: tuple[str, ...] = (),
    truth: Mapping[str, Any] | None = None,
    profiles: ProfilesLike | None = None,
    prediction: PredictionLike | Mapping[str, PredictionLike] | None = None,
    dofs: tuple[str, ...] = (),
    amplitude: str = "peak",
    time_comparison: TimeComparisonLike | None = None,
    backbone: BackboneLike | None = None,
    deformation: DeformationLike | None = None,
    reduction: ReductionErrorsLike | None = None,
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
            moving = each(trajectory)
            checks = [Diagnostics(moving)] if moving else []
            told = [*_telling(result), *_beyond(profiles, each(prediction))]
            after = [*_search(result), *_shooting(result), *told, *checks]
            sections = [*own, *_motion(moving, points, result), *after]
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
            sections = [telling_headlines.of_prediction(result, title, notes), Predicting(each(result))]
        case DesignsLike():
            sections = [telling_headlines.of_designs(result, title, notes), Designing(result)]
        case WorkPrecisionLike():
            sections = [headline.of_work_precision(result, title, notes), Integrators(result)]
        case FrequencyCurveLike():
            look = Look.of(result, dofs, amplitude) if result.converged.any() else None
            own = [vibration_headlines.of_frequency_curve(result, look, title, notes)]
            beside = [InTime(time_comparison, result)] if time_comparison is not None else []
            modes = [NonlinearMode(backbone)] if backbone is not None else []
            reduced = [Reduction(reduction)] if reduction is not None else []
            after = [*_deformed(deformation), *modes, *beside, *reduced, Balance(result)]
            sections = [*own, *_vibrating(look, backbone), *after]
        case DeformationLike():
            sections = [vibration_headlines.of_deformation(result, title, notes), Deformed(result)]
        case PeriodicMotionLike():
            sections = [vibration_headlines.of_period(result, title, notes), Period(result)]
        case ReductionErrorsLike():
            sections = [vibration_headlines.of_reduction(result, title, notes), Reduction(result)]
        case ModeShapesLike():
            sections = [vibration_headlines.of_modes(result, title, notes), Modes(result)]
        case TimeComparisonLike():
            sections = [vibration_headlines.of_time_comparison(result, title, notes), InTime(result)]
        case BackboneLike():
            sections = [vibration_headlines.of_backbone(result, title, notes), NonlinearMode(result)]
        case ResonanceTrackLike():
            sections = [vibration_headlines.of_track(result, title, notes), Tracks(result)]
        case CurveFamilyLike():
            looked = dofs or family_dofs(result, amplitude)
            own = [vibration_headlines.of_family(result, looked, amplitude, title, notes)]
            sections = [*own, *_family(result, looked, amplitude), *_deformed(deformation)]
            sections += [NonlinearMode(backbone)] if backbone is not None else []
            sections += [InTime(time_comparison)] if time_comparison is not None else []
            sections += [Reduction(reduction)] if reduction is not None else []
        case TrajectoryLike():
            moving = each(result)
            shown = [*_motion(moving, points), Diagnostics(moving)]
            sections = [headline.of_trajectory(result, title, notes), *shown]
        case SweepLike():
            sections = [headline.of_sweep(result, title, notes), Sweeps(result)]
        case _:
            raise InputError(
                f"report: a {type(result).__name__} was given; expected a result, such as identify(), simulate() or "
                "propagate() return"
            )
    if findings := tuple(getattr(result, "findings", ())):
        sections[0] = replace(sections[0], findings=findings)
    if held := headline.fixed_facts(result):
        sections[0] = replace(sections[0], facts=[*sections[0].facts, *held])  # type: ignore[attr-defined]
    facts = getattr(result, "provenance", {})
    return [*sections, Provenance(facts, study)] if facts or study else sections


def _vibrating(look: Look | None, backbone: BackboneLike | None) -> list[Section]:
    """The sections on a response over frequency, where any of it was found."""
    if look is None:
        return []
    elements = [Friction(look)] if look.curve.coordinates else []
    return [ForcedResponse(look, backbone), *elements, Harmonics(look)]


def _deformed(deformation: DeformationLike | None) -> list[Section]:
    return [] if deformation is None else [Deformed(deformation)]


def _family(family: CurveFamilyLike, dofs: tuple[str, ...], amplitude: str) -> list[Section]:
    """The sections on curves for several values of a parameter, and on the contacts at the best value."""
    if not dofs:
        return []
    best = best_curve(family, dofs[0], amplitude)
    lead = f"With {family.parameter} = {value_text(family, family.best(dofs[0], amplitude))}, "
    contacts = [Friction(Look.of(best, dofs[:1], amplitude), lead)] if best.coordinates else []
    return [Family(family, dofs, amplitude), *contacts]


def _compared(fit: FitLike) -> Section:
    """The response against the data, or, of several experiments, each against its own."""
    experiments = tuple(getattr(fit, "experiments", ()))
    return Experiments(fit, experiments) if experiments else Comparison(fit)


def _motion(moving: Mapping[str, TrajectoryLike], points: tuple[str, ...], fit: FitLike | None = None) -> list[Section]:
    """The section on the mechanism in motion, beside the measurements of each experiment."""
    data = {} if fit is None else {"": fit.data, **{item.name: item.data for item in getattr(fit, "experiments", ())}}
    drawn = {name: motion.motion(trajectory, points, data.get(name)) for name, trajectory in moving.items()}
    left_out = [] if "" in moving else [name for name in data if name and name not in moving]
    return [Motion(drawn, left_out)] if drawn else []


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


def _beyond(profiles: ProfilesLike | None, predictions: Mapping[str, PredictionLike]) -> list[Section]:
    """The sections on profiles and prediction of a fit, where they were made."""
    first: list[Section] = [] if profiles is None else [Profiling(profiles)]
    return [*first, Predicting(predictions)] if predictions else first
