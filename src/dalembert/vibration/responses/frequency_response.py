"""The response of a vibrating system over frequency."""

from collections.abc import Callable, Sequence
from dataclasses import asdict, dataclass, replace
from typing import Any

import numpy as np

from dalembert.arguments import takes_checked
from dalembert.errors import InputError, require_known
from dalembert.forward import Checkpoint
from dalembert.threads import one_thread
from dalembert.vibration.balance.arc_length import PathPoint
from dalembert.vibration.balance.conclusions import (
    free_findings,
    largest,
    unconverged,
    unconverged_findings,
)
from dalembert.vibration.balance.equations import Equations, equations
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
from dalembert.vibration.paths.continuation import across, at_frequencies, natural
from dalembert.vibration.paths.curve import FrequencyCurve
from dalembert.vibration.paths.curve_points import observed, response_of, restarted
from dalembert.vibration.paths.path_end import end_findings
from dalembert.vibration.stability.bifurcations import FOLD, fold_findings, judged
from dalembert.vibration.storage import versions
from dalembert.vibration.system.requirements import positive_numbers, require_force, require_viscous
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


@takes_checked("frequencies", "continuation", "observe")
@one_thread()
def frequency_response(
    system: VibrationSystem,
    frequencies: np.ndarray | tuple[float, float],
    method: HarmonicBalance | None = None,
    *,
    continuation: str = NATURAL,
    observe: Sequence[str] | None = None,
    start: tuple[FrequencyCurve, int] | None = None,
    stability: bool = False,
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
        A curve of the same system and the number of one of its points, from which to go on. Its harmonics are among
        those of ``method``.
    stability : bool
        Whether the stability of each point is found too, and the places where it changes: by Hill's method, or with
        friction by the linearised motion over a period (see :func:`floquet_multipliers`). On paths between two
        frequencies these places are points of their own; with given frequencies the first one behind is marked.
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
        share one mass.
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
    method = method or HarmonicBalance()
    ends = isinstance(frequencies, tuple)
    require_force(system.forces, "frequency_response")
    omegas = 2 * np.pi * positive_numbers(frequencies, "frequency_response", "frequencies", "Hz")
    require_known("continuation", continuation, (NATURAL, ARC_LENGTH), "frequency_response")
    if continuation == ARC_LENGTH and not ends:
        raise InputError(
            "frequency_response: a path by arc length finds its own frequencies; give a tuple of two, (begin, end)"
        )
    if stability:
        require_viscous(system.structure, "stability and Floquet multipliers")
    settings = {"continuation": continuation, "frequencies": list(map(float, frequencies)) if ends else "given"}
    asked = _Asked(system, omegas, ends, settings, observe, checkpoint, on_point)
    if not method.automatic:
        return asked.curve(asked.equations(method, stability), start, stability, check)
    method = method.keeping(system.highest_harmonic).at_least(1 if start is None else start[0].orders[-1])
    return _with_enough_harmonics(asked, method, start, stability)


def _with_enough_harmonics(
    asked: "_Asked", method: HarmonicBalance, start: tuple[FrequencyCurve, int] | None, stability: bool
) -> FrequencyCurve:
    """Return the curve with so many harmonics that its truncation errors are small, from few harmonics on."""
    level, begin = method.first(), start
    while True:
        problem = asked.equations(level, stability)
        curve = asked.curve(problem, begin, stability=False, check=False)
        points = hardest(curve.unknowns, curve.converged)
        solutions = [restarted(problem, curve, point, "frequency_response") for point in points]
        found = [one for one in solutions if one.converged]
        better, error = enough_harmonics(ForcedLevel.of(problem, found), found)
        if better.highest == level.highest:
            more = None if curve.converged.all() or level.highest >= RELIABLE else level.next()
            if more is None:
                break
            better = more
        level = better
        begin = (curve, 0) if start is None and curve.converged[0] else start
    if stability:
        curve = asked.curve(problem, begin, stability=True, check=False)
    return replace(curve, findings=(*curve.findings, *choice_findings(level, error)))


@dataclass(frozen=True)
class _Asked:
    """What is asked for besides the method: the system, angular frequencies or the two ends of a path, and so on."""

    system: VibrationSystem
    omegas: np.ndarray
    ends: bool
    settings: dict[str, Any]
    observe: Sequence[str] | None
    checkpoint: Checkpoint | None
    on_point: OnPoint | None

    def equations(self, method: HarmonicBalance, stability: bool) -> Equations:
        """The equations of the system with a number of harmonics."""
        return equations(self.system, method, self.checkpoint, stability=stability)

    def curve(
        self, problem: Equations, start: tuple[FrequencyCurve, int] | None, stability: bool, check: bool
    ) -> FrequencyCurve:
        """Follow the curve with a number of harmonics."""
        omegas, ends, method = self.omegas, self.ends, problem.method
        known = None if start is None else restarted(problem, *start, "frequency_response")
        if start is not None and start[0].orders != method.orders and known is not None and not known.converged:
            known = None
        if ends:
            follow = across if self.settings["continuation"] == ARC_LENGTH else natural
            found = follow(problem, float(omegas[0]), float(omegas[1]), known)
        else:
            found = at_frequencies(problem, omegas, known)
        rows = observed(problem.lowered, self.observe)
        lowered, records, lost, across_fold, done = problem.lowered, [], [], [], 0.0
        top: Solution | None = None
        dofs = tuple(lowered.structure.dofs.names[row] for row in rows)
        for one in judged(problem, found, located=ends) if stability else found:
            records.append(_kept(problem, one, rows))
            lost.append(unconverged(problem, one.solution))
            across_fold += [float(one.solution.omega) / (2 * np.pi)] * one.across_fold
            top = largest(top, one.solution) if check else None
            if self.on_point is not None:
                omega = one.solution.omega
                come = (omega - omegas[0]) / (omegas[1] - omegas[0]) if ends else len(records) / len(omegas)
                done = float(max(done, min(come, 1.0)))
                frequency, response = records[-1]["frequencies"], records[-1]["response"]
                self.on_point(FollowedPoint(frequency, response, dofs, done, method.orders))
        limits = float(omegas[0]) / (2 * np.pi), float(omegas[-1]) / (2 * np.pi)
        markers = [one.pop("marker") for one in records]
        kept = {name: np.array([one[name] for one in records]) for name in records[0]}
        return FrequencyCurve(
            dofs=dofs,
            coordinates=lowered.row_names,
            contacts=lowered.contacts,
            orders=method.orders,
            **{**kept, "stable": kept["stable"].astype(np.int8)},
            markers=tuple((marker, number) for number, marker in enumerate(markers) if marker),
            provenance={**versions(), "method": asdict(method), **self.settings},
            findings=(
                *unconverged_findings(len(records), filter(None, lost)),
                *(end_findings(kept["frequencies"], kept["converged"], limits, "frequency", "Hz") if ends else ()),
                *free_findings(problem),
                *fold_findings(across_fold, kept["frequencies"][kept["fold"]], method.highest),
                *(() if top is None else truncation_findings(problem, top)),
            ),
        )


def _kept(problem: Equations, one: PathPoint, rows: np.ndarray) -> dict[str, Any]:
    """What a curve keeps of a point, by the names of its arrays; the response in some rows of the structure.

    Matrices of some megabytes are not kept.
    """
    solution, lowered = one.solution, problem.lowered
    states = np.zeros((len(lowered.contacts), PHASES), dtype=np.uint8)
    instants = np.arange(PHASES) * solution.samples // PHASES
    for block, own in zip(lowered.blocks, solution.evaluation.states, strict=True):
        np.maximum.at(states, block.contacts, own[:, instants])
    response, forces = response_of(problem, solution)[rows], solution.evaluation.forces
    displacements = problem.balance(solution.samples).displacements(solution.unknowns)
    if not solution.converged:
        response, displacements, forces = (np.full_like(array, np.nan) for array in (response, displacements, forces))
    return {
        "frequencies": solution.omega / (2 * np.pi),
        "unknowns": solution.unknowns,
        "iterations": solution.iterations,
        "residuals": solution.error,
        "converged": solution.converged,
        "fold": one.fold,
        "samples": solution.samples,
        "sampling_errors": solution.sampling_error,
        "stable": one.stable,
        "marker": one.marker or (FOLD if one.fold else ""),
        "response": response,
        "displacements": displacements,
        "forces": forces,
        "states": states,
    }
