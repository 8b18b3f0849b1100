"""The response of a vibrating system over frequency."""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import asdict, dataclass, replace
from typing import Any

import numpy as np

from dalembert.arguments import takes_checked
from dalembert.errors import InputError, require_known
from dalembert.forward import Checkpoint
from dalembert.threads import single_thread
from dalembert.vibration.balance.arc_length import PathPoint
from dalembert.vibration.balance.conclusions import (
    Unconverged,
    free_findings,
    largest,
    unconverged,
    unconverged_findings,
)
from dalembert.vibration.balance.equations import Equations, by_stiffness, chosen_solver, equations
from dalembert.vibration.balance.harmonic_balance import HarmonicBalance
from dalembert.vibration.balance.newton import Solution
from dalembert.vibration.balance.truncation import (
    RELIABLE,
    ForcedLevel,
    choice_findings,
    enough_harmonics,
    hardest,
    truncation_findings,
)
from dalembert.vibration.interface.lowering import lower
from dalembert.vibration.paths.continuation import across, at_frequencies, natural
from dalembert.vibration.paths.curve import FrequencyCurve
from dalembert.vibration.paths.curve_points import observed, response_of, restarted
from dalembert.vibration.paths.motion_findings import open_findings, rotor_findings
from dalembert.vibration.paths.path_end import end_findings, left_findings
from dalembert.vibration.responses.control import Controlled, HeldAmplitude
from dalembert.vibration.stability.bifurcations import FOLD, fold_findings, judged
from dalembert.vibration.storage import versions
from dalembert.vibration.system.requirements import positive_numbers, require_forces, require_viscous
from dalembert.vibration.system.system import VibrationSystem

NATURAL, ARC_LENGTH = "natural", "arc-length"
PHASES = 64
"""Instants of a period at which a curve keeps the contacts' states."""


@dataclass(frozen=True)
class FollowedPoint:
    """A point of a curve that was just followed.

    Parameters
    ----------
    frequency : float
        Hz.
    response : array, shape (dofs, coefficients)
        Of the observed degrees of freedom, m; NaN where the point was not found.
    dofs : tuple of str
    done : float
        Part of the way between the first and the last frequency that the curve has come, at its farthest.
    orders : tuple of int
        Harmonics. If their number is chosen, the curve is followed again with each larger number.
    """

    frequency: float
    response: np.ndarray
    dofs: tuple[str, ...]
    done: float
    orders: tuple[int, ...]


OnPoint = Callable[[FollowedPoint], object]
CurvePoint = tuple[FrequencyCurve, int]
"""A curve and the number of one of its points."""


@takes_checked("frequencies", "continuation", "observe")
@single_thread()
def frequency_response(
    system: VibrationSystem,
    frequencies: np.ndarray | tuple[float, float],
    method: HarmonicBalance | None = None,
    *,
    continuation: str = NATURAL,
    observe: Sequence[str] | None = None,
    start: tuple[FrequencyCurve, int] | None = None,
    stability: bool = False,
    control: HeldAmplitude | None = None,
    check: bool = True,
    checkpoint: Checkpoint | None = None,
    on_point: OnPoint | None = None,
) -> FrequencyCurve:
    """Return the periodic responses over frequency by harmonic balance.

    Parameters
    ----------
    system : VibrationSystem
    frequencies : array, shape (points,), or pair of float
        Hz, positive. A tuple of two: points between them, as dense as the curve needs.
    method : HarmonicBalance, optional
        With ``harmonics="auto"`` the curve is followed with more and more harmonics, until the truncation errors of its
        largest motion and of the three with the largest last harmonics are small. Motions below a tenth of the largest
        count with an error as part of that tenth.
    continuation : {"natural", "arc-length"}
        From a frequency to the next, or along the curve past its folds, which needs (begin, end).
    observe : sequence of str, optional
        Degrees of freedom, nodes or sets of nodes whose motion is kept; all of a small structure, and of a large one
        those with forces and contacts, if not given.
    start : (FrequencyCurve, int), optional
        A curve of the same system and the number of one of its points, from which to continue. Its harmonics are among
        those of ``method``.
    stability : bool
        Whether the stability of each point is found too, and the places where it changes: by Hill's method, or with
        friction by the linearised motion over a period (see :func:`floquet_multipliers`). On paths between two
        frequencies these places are separate points; with given frequencies the first one behind is marked.
    control : HeldAmplitude, optional
        An amplitude that is held by a factor of the varying forces, in the ``load_factors`` of the curve.
    check : bool
        Whether the largest motion is computed again with twice the harmonics. A change is the finding
        ``"few-harmonics"``.
    checkpoint : Checkpoint, optional
        File in which solutions are stored as they are found. A run that was interrupted and is started again with the
        same file reads them, and its results are equal to the bits.
    on_point : callable, optional
        Called with each point, a :class:`FollowedPoint`, as it is found.

    Returns
    -------
    FrequencyCurve
        A point that Newton's method does not find, from the point before, by halves of the step or from the point
        behind, is marked there and the curve continues.

    Raises
    ------
    InputError
        For frequencies that are not positive, unknown degrees of freedom, a start that does not fit, and stability of
        a structure that is too large for dense matrices, has hysteretic damping, or where several degrees of freedom
        share one mass. For a held amplitude together with stability, arc length, a start, receptances or
        ``harmonics="auto"``.
    ModelError
        For rigid contacts that depend on each other, and for mean forces along a motion that nothing holds.

    Examples
    --------
    >>> import numpy as np
    >>> from dalembert.structure import lumped
    >>> from dalembert.vibration import ElasticSlider, FrictionContact, HarmonicForce, VibrationSystem
    >>> system = VibrationSystem(lumped({"m": 1.0}, [("m", None, 1.0, 0.04)]))
    >>> force = system.add(HarmonicForce("m", 1.0))
    >>> law = ElasticSlider(tangential_stiffness=0.8)
    >>> damper = system.add(FrictionContact("damper", "m", friction=0.5, preload=2.0, law=law))
    >>> curve = frequency_response(system, np.array([1.12]) / (2 * np.pi), HarmonicBalance(harmonics=5))
    >>> curve.amplitude("m").round(3).tolist()
    [3.625]
    """
    is_path = isinstance(frequencies, tuple)
    places = positive_numbers(frequencies, "frequency_response", "frequencies", "Hz")
    require_forces(system.forces, places, "frequency_response")
    omegas = 2 * np.pi * places
    require_known("continuation", continuation, (NATURAL, ARC_LENGTH), "frequency_response")
    if continuation == ARC_LENGTH and not is_path:
        raise InputError(
            "frequency_response: a path by arc length finds its own frequencies; give a tuple of two, (begin, end)"
        )
    if stability:
        require_viscous(system.structure, "stability and Floquet multipliers")
    settings = {"continuation": continuation, "frequencies": list(map(float, frequencies)) if is_path else "given"}
    method = method or HarmonicBalance()
    if control is not None:
        _require_control(continuation, start, stability, method)
        settings["control"] = asdict(control)
        method, check = by_stiffness(method, "frequency_response with a held amplitude"), False
    posed = _PosedCurve(system, omegas, is_path, settings, observe, start, stability, checkpoint, on_point, control)
    method = posed.solved(method)
    if method.automatic:
        return _refine(posed, method)
    return _conclude(posed, _follow(posed, posed.equations(method), start, stability, check))


def _require_control(continuation: str, start: CurvePoint | None, stability: bool, method: HarmonicBalance) -> None:
    """Refuse what a held amplitude does not take."""
    refused = {
        "continuation='arc-length'": continuation == ARC_LENGTH,
        "a start": start is not None,
        "stability=True": stability,
        "harmonics='auto'": method.automatic,
    }
    for what, present in refused.items():
        if present:
            raise InputError(f"frequency_response: a held amplitude was asked for with {what}. Leave one of them out")


@dataclass(frozen=True)
class _PosedCurve:
    """A curve to follow with any number of harmonics. ``omegas``: the values (rad/s), or the two ends of a path."""

    system: VibrationSystem
    omegas: np.ndarray
    is_path: bool
    settings: dict[str, Any]
    observe: Sequence[str] | None
    start: CurvePoint | None
    stability: bool
    checkpoint: Checkpoint | None
    on_point: OnPoint | None
    control: HeldAmplitude | None = None

    def solved(self, method: HarmonicBalance) -> HarmonicBalance:
        """Return the method with a way to write the structure."""
        return replace(method, solver=chosen_solver(lower(self.system), method, self.stability))

    def equations(self, method: HarmonicBalance) -> Equations:
        """The equations of the system with the harmonics of a method."""
        highest = float(np.max(self.omegas))
        return equations(self.system, method, self.checkpoint, stability=self.stability, highest=highest)


@dataclass(frozen=True)
class _FollowedCurve:
    """The points of a curve with a number of harmonics. ``arrays``: those that a curve keeps, by name, (points, ...).
    ``unconverged``: causes, of the points that are not converged. ``across_fold``: frequencies, Hz, of the points whose
    stability is unknown because of a fold. ``largest``: the largest motion, None if it is not to be checked.
    ``left_range``: whether the path leaves the range and comes back.
    """

    equations: Equations
    dofs: tuple[str, ...]
    arrays: dict[str, np.ndarray]
    markers: tuple[tuple[str, int], ...]
    unconverged: tuple[Unconverged, ...]
    across_fold: tuple[float, ...]
    largest: Solution | None
    left_range: bool = False


def _follow(
    posed: _PosedCurve, problem: Equations, start: CurvePoint | None, stability: bool, check: bool
) -> _FollowedCurve:
    """Follow the curve with a number of harmonics; ``check``: whether the largest motion is kept."""
    rows = observed(problem.lowered, posed.observe)
    dofs = tuple(problem.lowered.structure.dofs.names[row] for row in rows)
    points = _points(posed, problem, start)
    records, causes, across_fold, done = [], [], [], 0.0
    top: Solution | None = None
    left_range = False
    for point in judged(problem, points, located=posed.is_path) if stability else points:
        solution = point.solution
        records.append(_record(problem, point, rows))
        causes.append(unconverged(problem, solution))
        across_fold += [float(solution.omega) / (2 * np.pi)] * point.across_fold
        top = largest(top, solution) if check else None
        left_range |= point.returned
        if posed.on_point is not None:
            done = max(done, _progress(posed, float(solution.omega), len(records)))
            frequency, response = records[-1]["frequencies"], records[-1]["response"]
            posed.on_point(FollowedPoint(frequency, response, dofs, done, problem.method.orders))
    markers = tuple((marker, row) for row, record in enumerate(records) if (marker := record.pop("marker")))
    arrays = {name: np.array([record[name] for record in records]) for name in records[0]}
    lost = tuple(filter(None, causes))
    return _FollowedCurve(problem, dofs, arrays, markers, lost, tuple(across_fold), top, left_range)


def _points(posed: _PosedCurve, problem: Equations, start: CurvePoint | None) -> Iterator[PathPoint]:
    known = None if start is None else restarted(problem, *start, "frequency_response")
    if start is not None and start[0].orders != problem.method.orders and known is not None and not known.converged:
        known = None
    path = problem if posed.control is None else Controlled(problem, posed.control)
    if not posed.is_path:
        return at_frequencies(path, posed.omegas, known)
    follow = across if posed.settings["continuation"] == ARC_LENGTH else natural
    return follow(path, float(posed.omegas[0]), float(posed.omegas[1]), known)


def _progress(posed: _PosedCurve, omega: float, count: int) -> float:
    """Part of the way between the ends of a path, or of the given frequencies."""
    omegas = posed.omegas
    part = (omega - omegas[0]) / (omegas[1] - omegas[0]) if posed.is_path else count / len(omegas)
    return float(min(part, 1.0))


def _conclude(posed: _PosedCurve, followed: _FollowedCurve) -> FrequencyCurve:
    """Return the curve with the findings on its points, its end, its mean, its stability and its harmonics."""
    problem, arrays = followed.equations, followed.arrays
    method, frequencies, converged = problem.method, arrays["frequencies"], arrays["converged"]
    limits = float(posed.omegas[0]) / (2 * np.pi), float(posed.omegas[-1]) / (2 * np.pi)
    return FrequencyCurve(
        dofs=followed.dofs,
        coordinates=problem.lowered.row_names,
        contacts=problem.lowered.contacts,
        orders=method.orders,
        **{**arrays, "stable": arrays["stable"].astype(np.int8)},
        markers=followed.markers,
        provenance={**versions(), "method": asdict(method), **posed.settings},
        findings=(
            *unconverged_findings(len(frequencies), followed.unconverged),
            *(end_findings(frequencies, arrays["converged"], limits, "frequency", "Hz") if posed.is_path else ()),
            *left_findings(followed.left_range, limits[0], "frequency", "Hz"),
            *free_findings(problem),
            *open_findings(problem.lowered, arrays["forces"][converged], arrays["states"][converged]),
            *rotor_findings(problem.lowered, float(np.max(posed.omegas))),
            *fold_findings(followed.across_fold, frequencies[arrays["fold"]], method.highest),
            *(() if followed.largest is None else truncation_findings(problem, followed.largest)),
        ),
    )


def _refine(posed: _PosedCurve, method: HarmonicBalance) -> FrequencyCurve:
    """Return the curve with enough harmonics for small truncation errors, starting from few."""
    start = posed.start
    level = method.keeping(posed.system.highest_harmonic).at_least(1 if start is None else start[0].orders[-1]).first()
    begin = start
    while True:
        problem = posed.equations(level)
        curve = _conclude(posed, _follow(posed, problem, begin, stability=False, check=False))
        points = hardest(curve.unknowns, curve.converged)
        solutions = [restarted(problem, curve, point, "frequency_response") for point in points]
        motions = [solution for solution in solutions if solution.converged]
        better, error = enough_harmonics(ForcedLevel.of(problem, motions), motions)
        if better.highest == level.highest:
            # With few harmonics a motion that is not converged may be one that more harmonics have.
            more = None if curve.converged.all() or level.highest >= RELIABLE else level.next()
            if more is None:
                break
            better = more
        level = better
        begin = (curve, 0) if start is None and curve.converged[0] else start
    if posed.stability:
        curve = _conclude(posed, _follow(posed, problem, begin, stability=True, check=False))
    return replace(curve, findings=(*curve.findings, *choice_findings(level, error)))


def _record(problem: Equations, point: PathPoint, rows: np.ndarray) -> dict[str, Any]:
    """What a curve keeps of a point, by the names of its arrays: not its matrices, which have some megabytes."""
    solution, lowered = point.solution, problem.lowered
    states = np.zeros((len(lowered.contacts), PHASES), dtype=np.uint8)
    instants = np.arange(PHASES) * solution.samples // PHASES
    for block, block_states in zip(lowered.blocks, solution.evaluation.states, strict=True):
        np.maximum.at(states, block.contacts, block_states[:, instants])
    response, forces = response_of(problem, solution, rows), solution.evaluation.forces
    displacements = problem.balance(solution.samples).displacements(solution.unknowns)
    if not solution.converged:
        response, displacements, forces = (np.full_like(array, np.nan) for array in (response, displacements, forces))
    return {
        "frequencies": solution.omega / (2 * np.pi),
        "unknowns": solution.unknowns,
        "iterations": solution.iterations,
        "residuals": solution.error,
        "converged": solution.converged,
        "fold": point.fold,
        "samples": solution.samples,
        "sampling_errors": solution.sampling_error,
        "stable": point.stable,
        "load_factors": solution.load if solution.converged else np.nan,
        "marker": point.marker or (FOLD if point.fold else ""),
        "response": response,
        "displacements": displacements,
        "forces": forces,
        "states": states,
    }
