"""The truncation error: the change of a motion with more harmonics, and the number of harmonics that makes it small."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from typing import Protocol, TypeVar

import numpy as np

from dalembert.findings import Finding
from dalembert.structure.eigenmodes import real_part
from dalembert.vibration.balance.equations import Equations
from dalembert.vibration.balance.harmonic_balance import HarmonicBalance
from dalembert.vibration.balance.newton import Solution
from dalembert.vibration.fourier import Fourier, in_orders
from dalembert.vibration.interface.lowering import ELASTIC
from dalembert.vibration.laws.contacts import PREDICTIONS

_, VELOCITY = PREDICTIONS
SLOW = 2.5
"""Error over the change by twice the harmonics: about 2 where forces jump, so that it falls with 1/harmonics."""
PHASES = 1024
SMALL = 0.1
"""Motion, as part of the largest of a curve, below which errors are parts of this motion, not of the smaller one."""
RELIABLE = 9
"""Harmonics from which on the change by twice as many is enough to judge by; the default number."""
TAILS = 3
"""Motions with the largest last harmonics whose error is estimated beside that of the largest motion."""


@dataclass(frozen=True)
class Truncation:
    """Truncation error of a motion. ``frequency``: Hz; ``error``: as part of the motion; NaN if no motion with more
    harmonics is converged; ``heavy``: whether rigid contacts carry mass, so that the error falls slowly.
    """

    frequency: float
    error: float
    heavy: bool

    @property
    def rank(self) -> float:
        """Size of the error; unknown ones are the largest."""
        return np.inf if np.isnan(self.error) else self.error


def truncation_findings(problem: Equations, solution: Solution) -> Iterator[Finding]:
    """Yield a finding where twice the harmonics change the motion of the retained coordinates at a solution."""
    yield from large_findings(truncation(problem, solution), problem.method)


def large_findings(estimate: Truncation, method: HarmonicBalance, limit: int | None = None) -> Iterator[Finding]:
    """Yield the finding on a truncation error that is not small enough.

    ``limit`` is that of harmonics that were chosen; None if their number was given.
    """
    if estimate.error <= method.truncation:
        return
    harmonics = method.highest
    values = {"frequency": estimate.frequency, "harmonics": harmonics}
    if np.isnan(estimate.error):
        message = (
            f"Whether {harmonics} harmonics resolve the motion at {estimate.frequency:.6g} Hz is not known: with "
            f"{2 * harmonics + 1} harmonics it was not found."
        )
        advice = "Try another number of harmonics, or compare the curve with integration in time."
        yield Finding("unchecked-harmonics", "error" if estimate.heavy else "warning", values, message, advice)
        return
    message = (
        f"{harmonics} harmonics do not resolve the motion at {estimate.frequency:.6g} Hz: its error is about "
        f"{100 * estimate.error:.2g} %, by the change with {2 * harmonics + 1} harmonics."
    )
    advice = 'Use harmonics="auto", which chooses their number by this error.'
    if limit is not None:
        advice = f"The limit is {limit} harmonics: raise most_harmonics, or accept a larger error by truncation."
    if estimate.heavy:
        advice += " The force of a rigid contact with mass jumps, so that the error falls slowly; "
        advice += "an elastic law falls faster."
    else:
        advice += " Compare the curve with integration in time."
    values |= {"error": estimate.error}
    yield Finding("few-harmonics", "error" if estimate.heavy else "warning", values, message, advice)


def choice_findings(method: HarmonicBalance, largest: Truncation | None) -> tuple[Finding, ...]:
    """Return the finding on harmonics that were chosen, with the largest truncation error; none without a motion."""
    if largest is None:
        return ()
    return tuple(large_findings(largest, method, method.most_harmonics)) or (_chosen(method, largest.error),)


def _chosen(method: HarmonicBalance, error: float) -> Finding:
    message = (
        f"{method.highest} harmonics were chosen: the largest of the estimated truncation errors is "
        f"{100 * error:.2g} %, and the limit is {100 * method.truncation:.2g} %."
    )
    values = {"harmonics": method.highest, "error": error, "truncation": method.truncation}
    return Finding("harmonics-chosen", "note", values, message)


def hardest(unknowns: np.ndarray, converged: np.ndarray, small: float = SMALL) -> list[int]:
    """Return numbers of the motions (points, q, coefficients) by which harmonics are chosen. They are the largest, and
    those whose upper half of harmonics is the largest part of the motion, or of ``small`` times the largest motion.
    """
    places = np.flatnonzero(converged)
    if not len(places):
        return []
    sizes = np.linalg.norm(unknowns[places].reshape(len(places), -1), axis=1)
    upper = unknowns.shape[2] // 2
    tails = np.linalg.norm(unknowns[places][:, :, upper:].reshape(len(places), -1), axis=1)
    # Small motions have large relative tails that nobody looks at: they count as parts of a tenth of the largest.
    references = np.maximum(sizes, small * sizes.max())
    parts = tails / np.where(references > 0, references, 1.0)
    order = [int(sizes.argmax()), *np.argsort(-parts, kind="stable")[:TAILS].tolist()]
    return [int(places[number]) for number in dict.fromkeys(order)]


class Motion(Protocol):
    """A motion with a number of harmonics, which may be converged."""

    @property
    def converged(self) -> bool: ...


M = TypeVar("M", bound=Motion)


class HarmonicLevel(Protocol[M]):
    """Equations with a number of harmonics, and the truncation error of their motions."""

    @property
    def method(self) -> HarmonicBalance: ...

    def truncation(self, motion: M, /) -> Truncation:
        """Return the truncation error of a converged motion."""
        ...

    def padded(self, motion: M, method: HarmonicBalance, /) -> "tuple[HarmonicLevel[M], M]":
        """Return the equations with the harmonics of another method, and the motion solved with them."""
        ...


def enough_harmonics(first: HarmonicLevel[M], motions: Sequence[M]) -> tuple[HarmonicBalance, Truncation | None]:
    """Return the method whose truncation errors of some motions are small, up to the limit, and the largest of them.
    The error is None where the harmonics are more than those of the motions: all motions have to be computed with them
    first. If a motion is not found with more harmonics, the method has these: other motions may lead to it.
    """
    method, largest = first.method, None
    for motion in motions:
        # Each motion starts from the number of harmonics that the motions before it needed: the largest number holds
        # for all.
        level, known = (first, motion) if method == first.method else first.padded(motion, method)
        while known.converged:
            estimate = _confirmed(level, known)
            more = None if estimate.error <= method.truncation else method.next()
            if more is None:
                largest = estimate if largest is None or estimate.rank > largest.rank else largest
                break
            method = more
            level, known = level.padded(known, method)
        if not known.converged:
            break
    return method, largest if method == first.method else None


def _confirmed(level: HarmonicLevel[M], motion: M) -> Truncation:
    """Return the truncation error of a motion; with few harmonics, the larger one of this and the next error.

    The first few harmonics may change a motion less than those after them.
    """
    estimate, more = level.truncation(motion), level.method.next()
    # From 9 harmonics on one change is enough. Below, den Hartog's block with a limit of 0.3 of the force changes by
    # 0.14 % from 3 to 7 harmonics and by 0.44 % from 7 to 15.
    if level.method.highest >= RELIABLE or more is None or not estimate.error <= more.truncation:
        return estimate
    finer, known = level.padded(motion, more)
    if not known.converged:
        return replace(estimate, error=np.nan)
    return max(estimate, finer.truncation(known), key=lambda each: each.rank)


@dataclass(frozen=True)
class ForcedLevel:
    """The equations of forced motions with a number of harmonics.

    ``least``: amplitude, m, of which an error is a part at least.
    """

    problem: Equations
    least: float

    @classmethod
    def of(cls, problem: Equations, motions: Sequence[Solution]) -> "ForcedLevel":
        """The level at which errors of small motions are parts of a tenth of the largest one."""
        sizes = [float(_amplitudes(problem.method, motion).max(initial=0.0)) for motion in motions]
        return cls(problem, SMALL * max(sizes, default=0.0))

    @property
    def method(self) -> HarmonicBalance:
        return self.problem.method

    def truncation(self, motion: Solution) -> Truncation:
        """Return the truncation error of a converged motion."""
        return truncation(self.problem, motion, self.least, afresh=False)

    def padded(self, motion: Solution, method: HarmonicBalance) -> "tuple[ForcedLevel, Solution]":
        """Return the equations with the harmonics of another method, and the motion solved with them."""
        problem = self.problem.with_method(method)
        return replace(self, problem=problem), _padded(problem, self.method, motion)


def truncation(problem: Equations, solution: Solution, least: float = 0.0, afresh: bool = True) -> Truncation:
    """Return the truncation error at a solution. ``least``: amplitude, m, of which the error is a part at least;
    ``afresh``: whether the motion with more harmonics is also sought without a start.
    """
    what = "truncation" if afresh else "truncation from here"
    change, size = problem.once(what, solution, lambda: np.array(_change(problem, solution, afresh))).tolist()
    heavy = carries_mass(problem, solution.omega)
    return Truncation(problem.hertz(solution.omega), SLOW * change / (max(size, least) or 1.0), heavy)


def carries_mass(problem: Equations, omega: float) -> bool:
    """Whether rigid contacts carry mass."""
    return any(_heavy(problem, omega))


def _padded(problem: Equations, method: HarmonicBalance, solution: Solution) -> Solution:
    begin = in_orders(solution.unknowns, method.orders, problem.method.orders)
    return problem.solve(begin, solution.omega, max(problem.method.first_samples, solution.samples))


def _amplitudes(method: HarmonicBalance, solution: Solution) -> np.ndarray:
    """Amplitudes of the unknowns, (q,): half of the way from the lowest to the highest position."""
    return np.ptp(Fourier(method.orders, PHASES).synthesis @ solution.unknowns.T, axis=0) / 2


def _change(problem: Equations, solution: Solution, afresh: bool) -> tuple[float, float]:
    """Return the change of the largest amplitude with more harmonics, and this amplitude with them.

    NaN if no finer motion is converged.
    """
    method = problem.method.refined()
    if method is None or not problem.nonlinear:
        return 0.0, 1.0
    # Where contacts carry mass, the displacement kind converges more slowly in H than the velocity kind: 1.6 % against
    # 0.2 % of error at 39 harmonics where a mass sticks for half of the period.
    # The elements with rigid contacts of the velocity kind where these carry mass: it converges faster there.
    heavy = _heavy(problem, solution.omega)
    finer = problem.with_method(method)
    if any(heavy) and not problem.by_receptances:
        blocks = tuple(
            replace(block, kind=VELOCITY) if own and block.memory else block
            for block, own in zip(problem.lowered.blocks, heavy, strict=True)
        )
        finer = Equations(replace(problem.lowered, blocks=blocks), method)
    better = _padded(finer, problem.method, solution)
    if not better.converged and afresh:
        better = finer.first(solution.omega)
    if not better.converged:
        return np.nan, 1.0
    # Of the degree of freedom that moves most: relative errors of small ones say little.
    coarse, other = _amplitudes(problem.method, solution), _amplitudes(method, better)
    most = int(np.argmax(other))
    return float(abs(coarse[most] - other[most])), float(other[most])


def _heavy(problem: Equations, omega: float) -> tuple[bool, ...]:
    """Whether the rigid contacts of each block carry mass.

    They do if the highest harmonic meets more inertia than stiffness, with everything else held.
    """
    lowered = problem.lowered
    if all(block.kind == ELASTIC for block in lowered.blocks):
        return (False,) * len(lowered.blocks)
    structure, matrix = lowered.structure, lowered.matrix.tocsr()
    # m (H ω)² > k: at the highest harmonic the contact sees inertia, so that its force jumps where motion stops and
    # falls with 1/h.
    inertia = real_part(structure.mass).diagonal() * (problem.method.highest * omega) ** 2
    heavy = inertia > real_part(structure.stiffness).diagonal()
    return tuple(
        block.kind != ELASTIC and bool(np.any(heavy[matrix[block.rows.ravel()].indices])) for block in lowered.blocks
    )
