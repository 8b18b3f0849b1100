"""A curve that is followed from point to point, and what is concluded of it."""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import asdict, dataclass, replace
from typing import Any

import numpy as np

from dalembert.errors import SolveError
from dalembert.findings import Finding
from dalembert.forward import Checkpoint
from dalembert.vibration.balance.arc_length import ACROSS_FOLD, JOINED, MANY_ROWS, PathPoint, along
from dalembert.vibration.balance.conclusions import (
    Unconverged,
    free_findings,
    largest,
    unconverged,
    unconverged_findings,
)
from dalembert.vibration.balance.equations import Equations, chosen_solver, equations
from dalembert.vibration.balance.harmonic_balance import HarmonicBalance
from dalembert.vibration.balance.newton import Solution
from dalembert.vibration.balance.truncation import (
    truncation_findings,
)
from dalembert.vibration.interface.condensed_structure import norm
from dalembert.vibration.interface.lowering import lower
from dalembert.vibration.paths.continuation import across, at_frequencies, natural
from dalembert.vibration.paths.curve import FrequencyCurve
from dalembert.vibration.paths.curve_points import observed, response_of, restarted
from dalembert.vibration.paths.motion_findings import open_findings, rotor_findings
from dalembert.vibration.paths.path_end import end_findings
from dalembert.vibration.responses.control import Controlled, HeldAmplitude
from dalembert.vibration.stability.bifurcations import FOLD, fold_findings, judged, rows_findings
from dalembert.vibration.storage import versions
from dalembert.vibration.system.system import VibrationSystem

NATURAL, ARC_LENGTH = "natural", "arc-length"
JOINS = 1e-2
"""Part of a branch's motion that its curve lacks, relative to the largest, below which the branch is the curve."""
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


@dataclass(frozen=True)
class BranchStart:
    """A motion of a branch beside another curve; ``heading``: a direction from there, in scaled unknowns; ``broken``
    (q, coefficients): which coefficients are zero on the other curve.
    """

    start: Solution
    heading: np.ndarray
    broken: np.ndarray


@dataclass(frozen=True)
class PosedCurve:
    """A curve to follow with any number of harmonics. ``omegas``: the values (rad/s), or the two ends of a path;
    ``branch``: where a branch of another curve begins.
    """

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
    branch: BranchStart | None = None

    def solved(self, method: HarmonicBalance) -> HarmonicBalance:
        """Return the method with a way to write the structure."""
        return replace(method, solver=chosen_solver(lower(self.system), method, self.stability))

    def equations(self, method: HarmonicBalance) -> Equations:
        """The equations of the system with the harmonics of a method."""
        highest, control = float(np.max(self.omegas)), self.control
        measured = None if control is None else self.system.structure.dofs.index(control.dof, "HeldAmplitude")
        return equations(
            self.system, method, self.checkpoint, stability=self.stability, highest=highest, measured=measured
        )


@dataclass(frozen=True)
class FollowedCurve:
    """The points of a curve with a number of harmonics. ``arrays``: those that a curve keeps, by name, (points, ...).
    ``unconverged``: causes, of the points that are not converged. ``unjudged``: causes of unknown stability, with the
    frequencies of the points, Hz. ``largest``: the largest motion, None if it is not to be checked.
    ``left_range``: whether the path leaves the range and comes back; ``end_inside``: why it ends inside
    its range, if it does.
    """

    equations: Equations
    dofs: tuple[str, ...]
    arrays: dict[str, np.ndarray]
    markers: tuple[tuple[str, int], ...]
    unconverged: tuple[Unconverged, ...]
    unjudged: tuple[tuple[str, float], ...]
    largest: Solution | None
    left_range: bool = False
    end_inside: str = ""


def follow(
    posed: PosedCurve, problem: Equations, start: CurvePoint | None, stability: bool, check: bool,
    points: Iterator[PathPoint] | None = None,
) -> FollowedCurve:  # fmt: skip
    """Follow the curve with a number of harmonics. ``check``: whether the largest motion is kept; ``points``: in place
    of those of the path that the curve asks for.
    """
    rows = observed(problem.lowered, posed.observe)
    dofs = tuple(problem.lowered.structure.dofs.names[row] for row in rows)
    points = _points(posed, problem, start) if points is None else points
    records, causes, unjudged, done = [], [], [], 0.0
    top: Solution | None = None
    left_range, end_inside = False, ""
    for point in judged(problem, points, located=posed.is_path) if stability else points:
        solution = point.solution
        records.append(_record(problem, point, rows))
        causes.append(unconverged(problem, solution))
        unjudged += [(point.unjudged, problem.hertz(solution.omega))] * bool(point.unjudged)
        top = largest(top, solution) if check else None
        left_range, end_inside = left_range or point.returned, end_inside or point.end
        if posed.on_point is not None:
            # Part of the way between the ends of a path, or of the frequencies.
            part = (solution.omega - posed.omegas[0]) / (posed.omegas[-1] - posed.omegas[0]) if posed.is_path else 0.0
            done = max(done, float(min(part if posed.is_path else len(records) / len(posed.omegas), 1.0)))
            frequency, response = records[-1]["frequencies"], records[-1]["response"]
            posed.on_point(FollowedPoint(frequency, response, dofs, done, problem.method.orders))
    markers = tuple((marker, row) for row, record in enumerate(records) if (marker := record.pop("marker")))
    if not records:
        raise SolveError("no motion was found at any of the frequencies; try others, or more samples")
    arrays = {name: np.array([record[name] for record in records]) for name in records[0]}
    lost = tuple(filter(None, causes))
    return FollowedCurve(problem, dofs, arrays, markers, lost, tuple(unjudged), top, left_range, end_inside)


def until_joined(points: Iterator[PathPoint], broken: np.ndarray) -> Iterator[PathPoint]:
    """Yield points of a branch until it comes to the curve that it left, whose motions have no ``broken`` part. Behind
    this place a branch has the opposite part, or is the curve.
    """
    before: PathPoint | None = None
    last, largest_part = np.zeros(int(broken.sum())), 0.0
    for point in points:
        part = point.solution.unknowns[broken]
        ends = bool(point.solution.converged and (part @ last < 0 or norm(part) < JOINS * largest_part))
        if before is not None:
            yield replace(before, end=JOINED) if ends else before
        if ends:
            return
        before, last, largest_part = point, part, max(largest_part, norm(part))
    if before is not None:
        yield before


def _points(posed: PosedCurve, problem: Equations, start: CurvePoint | None) -> Iterator[PathPoint]:
    if posed.branch is not None:
        begin, heading = posed.branch.start, posed.branch.heading
        path = along(problem, float(posed.omegas[0]), float(posed.omegas[1]), begin, onward=heading)
        return until_joined(path, posed.branch.broken)
    known = None if start is None else restarted(problem, *start, "frequency_response")
    if start is not None and start[0].orders != problem.method.orders and known is not None and not known.converged:
        known = None
    path = problem if posed.control is None else Controlled(problem, posed.control)
    if not posed.is_path:
        return at_frequencies(path, posed.omegas, known)
    follow = across if posed.settings["continuation"] == ARC_LENGTH else natural
    return follow(path, float(posed.omegas[0]), float(posed.omegas[1]), known)


def conclude(posed: PosedCurve, followed: FollowedCurve) -> FrequencyCurve:
    """Return the curve with the findings on its points, its end, its mean, its stability and its harmonics."""
    problem, arrays = followed.equations, followed.arrays
    method, frequencies, converged = problem.method, arrays["frequencies"], arrays["converged"]
    limits = problem.hertz(posed.omegas[0]), problem.hertz(posed.omegas[-1])
    unjudged = {
        cause: [frequency for other, frequency in followed.unjudged if other == cause]
        for cause in (ACROSS_FOLD, MANY_ROWS)
    }
    ended: tuple[Finding, ...] = ()
    if posed.is_path:
        how = followed.end_inside, followed.left_range
        ended = end_findings(frequencies, converged, limits, "frequency", "Hz", *how)
    return FrequencyCurve(
        dofs=followed.dofs,
        coordinates=problem.lowered.row_names[: problem.lowered.seen],
        contacts=problem.lowered.contacts,
        orders=method.orders,
        **{**arrays, "stable": arrays["stable"].astype(np.int8)},
        markers=followed.markers,
        provenance={**versions(), "method": asdict(method), **posed.settings},
        findings=(
            *unconverged_findings(len(frequencies), followed.unconverged),
            *ended,
            *free_findings(problem),
            *open_findings(problem.lowered, arrays["forces"][converged], arrays["states"][converged]),
            *rotor_findings(problem.lowered, float(np.max(posed.omegas))),
            *fold_findings(unjudged[ACROSS_FOLD], frequencies[arrays["fold"]], method.highest),
            *rows_findings(unjudged[MANY_ROWS]),
            *(() if followed.largest is None else truncation_findings(problem, followed.largest)),
        ),
    )


def _record(problem: Equations, point: PathPoint, rows: np.ndarray) -> dict[str, Any]:
    """What a curve keeps of a point, by the names of its arrays: not its matrices, which have some megabytes."""
    solution, lowered = point.solution, problem.lowered
    states = np.zeros((len(lowered.contacts), PHASES), dtype=np.uint8)
    instants = np.arange(PHASES) * solution.samples // PHASES
    for block, block_states in zip(lowered.blocks, solution.evaluation.states, strict=True):
        np.maximum.at(states, block.contacts, block_states[:, instants])
    response, forces = response_of(problem, solution, rows), solution.evaluation.forces[: lowered.seen]
    displacements = problem.balance(solution.samples).displacements(solution.unknowns)[: lowered.seen]
    if not solution.converged:
        response, displacements, forces = (np.full_like(array, np.nan) for array in (response, displacements, forces))
    return {
        "frequencies": problem.hertz(solution.omega),
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
