"""Equations of harmonic balance of a system, solved at any frequency."""

import hashlib
from collections.abc import Callable
from dataclasses import dataclass, field, replace
from functools import cached_property, partial
from typing import Any

import numpy as np

from dalembert.errors import InputError, SolveError
from dalembert.forward import Checkpoint
from dalembert.vibration.balance.balance import Balance
from dalembert.vibration.balance.first_guesses import first_guesses
from dalembert.vibration.balance.harmonic_balance import AUTO, MOST_SAMPLES, RECEPTANCE, STIFFNESS, HarmonicBalance
from dalembert.vibration.balance.newton import AnyBalance, Constraint, Point, Solution, correct, placed
from dalembert.vibration.balance.preparation import prepare_balance
from dalembert.vibration.balance.receptance_balance import ReceptanceBalance
from dalembert.vibration.balance.symmetry import require_symmetry
from dalembert.vibration.fourier import Fourier
from dalembert.vibration.interface.condensation import DENSE, Condensation
from dalembert.vibration.interface.condensed_structure import norm
from dalembert.vibration.interface.contacts_stuck import ContactsStuck, KnownStructures
from dalembert.vibration.interface.loads import Loads
from dalembert.vibration.interface.lowering import ELASTIC, Lowered, lower
from dalembert.vibration.interface.modal_damping import couples
from dalembert.vibration.interface.receptances import ReceptancePoint
from dalembert.vibration.system.system import VibrationSystem


@dataclass(frozen=True)
class Equations:
    """A lowered system and a method. ``lowered``: real; ``checkpoint``: from which solutions are read, and to which new
    ones are added. A path goes from one solution to the next, so it takes the same way again, bit for bit. Where a
    solution is known, its forces and its Jacobian are evaluated once, in place of once an iteration.
    """

    lowered: Lowered
    method: HarmonicBalance
    checkpoint: Checkpoint | None = None
    _balances: dict[int, AnyBalance] = field(default_factory=dict, repr=False, compare=False)
    _stuck: ContactsStuck | None = field(default=None, repr=False, compare=False)

    @property
    def by_receptances(self) -> bool:
        """Whether the structure is written by receptances."""
        return self.method.solver == RECEPTANCE

    def hertz(self, omega: float) -> float:
        """Return the frequency of the excitation, Hz, at an angular frequency of the motion."""
        return float(omega) * self.method.periods / (2 * np.pi)

    def omega(self, hertz: float) -> float:
        """Return the angular frequency of the motion, rad/s, at a frequency of the excitation."""
        return 2 * np.pi * float(hertz) / self.method.periods

    @cached_property
    def condensation(self) -> Condensation:
        """The structure at any frequency, by dynamic stiffnesses."""
        return Condensation(self.lowered, self.method.orders, self._loads)

    @cached_property
    def contacts_stuck(self) -> ContactsStuck:
        """The structure whose contacts stick."""
        return self._stuck or ContactsStuck(self.lowered)

    @cached_property
    def _series(self) -> Fourier:
        return Fourier(self.method.orders, self.method.first_samples)

    @cached_property
    def _loads(self) -> Loads:
        """Forces in the kept harmonics."""
        return self.lowered.loads(self._series)

    def at(self, omega: float) -> Point:
        """The structure at ω, rad/s."""
        if self.by_receptances:
            return self.contacts_stuck.receptances(self._series, self._loads, omega).at(omega)
        return self.condensation.at(omega)

    def with_method(self, method: HarmonicBalance) -> "Equations":
        """The equations with another method."""
        return replace(self, method=method, _balances={}, _stuck=self.contacts_stuck if self.by_receptances else None)

    @cached_property
    def with_even(self) -> "Equations":
        """The equations with even harmonics too; they themselves if these are kept."""
        return self.with_method(replace(self.method, odd_only=False)) if self.method.odd_only else self

    @property
    def nonlinear(self) -> bool:
        """Whether there are contacts or springs."""
        return bool(self.lowered.blocks or self.lowered.laws or self.lowered.functions)

    def balance(self, samples: int) -> AnyBalance:
        """The elements with this many samples of a period."""
        if samples not in self._balances:
            series, events = Fourier(self.method.orders, samples), self.method.events
            self._balances[samples] = (
                ReceptanceBalance(self.lowered, series, self.contacts_stuck.reference, events)
                if self.by_receptances
                else Balance(self.lowered, series, events)
            )
        return self._balances[samples]

    def seen_by_functions(self, solution: Solution) -> dict[str, np.ndarray]:
        """Samples of the displacements that functions of the user's see at a solution, by their names."""
        balance = self.balance(solution.samples)
        samples = balance.displacements(solution.unknowns) @ balance.series.synthesis.T
        return {element.name: samples[rows] for rows, element in self.lowered.functions}

    def stiffness_balance(self, samples: int) -> Balance:
        """The same where the structure is written by dynamic stiffnesses."""
        balance = self.balance(samples)
        if isinstance(balance, Balance):
            return balance
        raise TypeError("the equations are by receptances, without dynamic stiffnesses")

    @cached_property
    def measured(self) -> np.ndarray:
        """Weights of the unknowns in the displacement of the measured degree of freedom, (unknowns,)."""
        row = self.lowered.measured
        assert row is not None  # it is asked of equations that measure one
        if self.by_receptances:
            return np.eye(1, len(self.lowered.row_names), row)[0]
        return self.lowered.coordinates.combination[row]

    def motion(self, point: Point, unknowns: np.ndarray, samples: int, dofs: np.ndarray | None = None) -> np.ndarray:
        """Coefficients of all degrees of freedom, or of some, (dofs, coefficients)."""
        balance = self.balance(samples)
        if isinstance(point, ReceptancePoint) and isinstance(balance, ReceptanceBalance):
            return point.motion(balance.deviation(point.omega, unknowns), dofs)
        assert not isinstance(point, ReceptancePoint)
        retained = balance.series.phasors(unknowns)
        whole = balance.series.coefficients(self.condensation.full(retained, point.interior(retained)))
        return whole if dofs is None else whole[dofs]

    def solve(
        self,
        unknowns: np.ndarray,
        omega: float,
        samples: int,
        plane: Constraint | None = None,
        point: Point | None = None,
        at: Callable[[float], Point] | None = None,
    ) -> Solution:
        """Solve the equations by Newton's method from a guess. Samples are doubled until they suffice. If nothing holds
        the structure along a motion, too few samples may leave a mean force along it, which no mean position balances.
        More samples remove this force. ``at``: the structure at a value of ω; of another parameter if it is given.
        """
        at = at or self.at
        fresh = partial(self.newton, unknowns, omega, samples, plane, point, at)
        if self.checkpoint is None:
            return fresh()
        computed: list[Solution] = []

        def compute() -> tuple[np.ndarray, np.ndarray]:
            computed.append(solution := fresh())
            numbers = (
                solution.omega,
                solution.iterations,
                solution.error,
                solution.converged,
                solution.samples,
                solution.sampling_error,
            )
            return solution.unknowns, np.array(numbers, dtype=float)

        values, numbers = self.checkpoint.once(self._key(unknowns, omega, samples, plane), compute)
        return computed[0] if computed else self._restored(at, values, *numbers.tolist())

    def newton(
        self,
        unknowns: np.ndarray,
        omega: float,
        samples: int,
        plane: Constraint | None,
        point: Point | None,
        at: Callable[[float], Point],
    ) -> Solution:
        """Solve as :meth:`solve` does, without a look at the checkpoint."""

        def finer(candidate: Solution) -> Solution:
            balance, near = self.balance(2 * candidate.samples), (candidate.unknowns, candidate.omega)
            return correct(balance, at, self.method, *near, plane, candidate.point)

        def solved(number: int) -> Solution:
            return correct(self.balance(number), at, self.method, unknowns, omega, plane, point)

        def back(candidate: Solution) -> Solution:
            """The solution with the first number of samples, by which a curve stays smooth; None if there is none."""
            near = candidate.unknowns, candidate.omega
            first = correct(self.balance(samples), at, self.method, *near, plane, candidate.point)
            return first if first.converged else candidate

        # Samples first, motion later: a residual below `sampling` that Newton's method cannot reduce is one of kinks,
        # or a mean force, that more samples remove.
        solution = solved(samples)
        while solution.error <= self.method.sampling and not solution.converged and self._doubles(solution):
            before, solution = solution.error, finer(solution)
            if not solution.converged and solution.error > before / 2:  # what is left is not of the samples
                break
        alternates = solution.error <= self.method.sampling and not solution.converged
        if alternates and plane is None and self.method.samples == AUTO:  # on a path, a shorter step is cheaper
            # Other numbers of samples have their kinks at other motions; from their solution the first number often
            # converges.
            numbers = (int(part * samples) for part in RESAMPLED if part * samples <= MOST_SAMPLES)
            solution = next((back(candidate) for candidate in map(solved, numbers) if candidate.converged), solution)
        # Enough samples: twice as many change the balance by less than `sampling` of the forces. At most 8192.
        while solution.converged:
            solution = replace(solution, sampling_error=self._sampling_error(solution))
            if solution.sampling_error <= self.method.sampling or not self._doubles(solution):
                break
            better = finer(solution)
            solution = replace(better, iterations=solution.iterations + better.iterations)
        return solution

    def placed(self, unknowns: np.ndarray, omega: float, samples: int) -> Solution:
        """Return the balance and its tangent at a place, without an iteration."""
        return placed(self.balance(samples), self.at(omega), self.method, unknowns, omega)

    def first(self, omega: float) -> Solution:
        """Return a first point: from contacts that stick, from the motion without contacts, or by increasing force.

        With little varying force contacts stick, so that this is the way of a friction limit from infinity to its own.
        """
        point, best = self.at(omega), None
        for guess in first_guesses(self.balance(self.method.first_samples), self.method, point):
            solution = self.solve(guess, omega, self.method.first_samples, point=point)
            if solution.converged:
                return solution
            best = solution if best is None or solution.error < best.error else best
        assert best is not None  # there is always a first guess
        return best

    def once(self, what: str, solution: Solution, compute: Callable[[], np.ndarray]) -> np.ndarray:
        """Return a named quantity of a solution. It is stored where solutions are."""
        if self.checkpoint is None:
            return compute()
        key = what.encode() + self._key(solution.unknowns, solution.omega, solution.samples, None)
        return self.checkpoint.once(key, lambda: (compute(),))[0]

    def _restored(
        self, at: Callable[[float], Point], unknowns: np.ndarray, omega: float, iterations: float, error: float,
        converged: float, samples: float, sampling_error: float,
    ) -> Solution:  # fmt: skip
        balance: Any = self.balance(int(samples))
        point = at(omega)
        evaluation, tangent = balance.linearised(point, unknowns)
        return Solution(
            omega, unknowns, point, evaluation, tangent, evaluation.scale, int(iterations), error,
            bool(converged), int(samples), sampling_error,
        )  # fmt: skip

    def _key(self, unknowns: np.ndarray, omega: float, samples: int, plane: Constraint | None) -> bytes:
        """Hash of all that a solution depends on."""
        parts = [np.array([omega, samples]), unknowns]
        if plane is not None:
            parts += plane.numbers()
        return hashlib.sha256(self._system + b"".join(map(np.ndarray.tobytes, parts))).digest()

    @cached_property
    def _system(self) -> bytes:
        return b"harmonic balance" + self.lowered.fingerprint(self.method).encode()

    def _doubles(self, solution: Solution) -> bool:
        return self.method.samples == AUTO and solution.samples < MOST_SAMPLES

    def _sampling_error(self, solution: Solution) -> float:
        """Residual with twice the samples, as part of the forces."""
        balance: Any = self.balance(2 * solution.samples)
        evaluation = balance.at(solution.point, solution.unknowns)
        return norm(evaluation.residual) / evaluation.scale


def equations(
    system: VibrationSystem,
    method: HarmonicBalance,
    checkpoint: Checkpoint | None = None,
    *,
    residuals: bool = True,
    stability: bool = False,
    derivatives: bool = False,
    highest: float = 0.0,
    known: KnownStructures | None = None,
    measured: int | None = None,
) -> Equations:
    """Return the equations of a system, their kernels compiled or loaded. ``checkpoint``: where solutions are stored;
    ``residuals``, ``stability``, ``derivatives``: what is computed besides residuals with their Jacobians: residuals
    alone (:meth:`Equations.solve` needs them), the stability of solutions by the time map, derivatives by parameters;
    ``highest``: largest angular frequency of the motions, rad/s; ``known``: structures of other systems; ``measured``:
    degree of freedom whose displacement is to be linear in the unknowns.
    Parts on degrees of freedom that the structure lacks, odd harmonics alone where a force has a mean or even
    harmonics, rigid contacts that depend on each other, and mean forces along a motion that nothing holds are refused.
    """
    lowered = replace(lower(system).real, periods=method.periods)
    if method.odd_only:
        require_symmetry(lowered)
    if measured is not None:
        lowered = lowered.measuring(measured)
    prepare_balance(lowered, method.events, residuals=residuals, stability=stability, derivatives=derivatives)
    stuck = ContactsStuck(lowered, highest, KnownStructures() if known is None else known)
    return Equations(lowered, method, checkpoint, _stuck=stuck)


LARGE = 500
"""Unknowns of elastic contacts above which a system is solved by receptances."""


def chosen_solver(lowered: Lowered, method: HarmonicBalance, stability: bool = False) -> str:
    """Return the way in which the structure is written for a curve. ``stability``: whether that of motions, or free
    motions, are asked for.

    InputError where receptances are asked for and rigid contacts need dynamic stiffnesses.
    """
    causes = [
        f"the contact {lowered.contacts[block.contacts[0]]!r} is rigid"
        + (" and predicts velocities" if not stability else "")
        for block in lowered.blocks
        if not block.memory or (stability and block.kind != ELASTIC)
    ]
    if method.solver == RECEPTANCE and causes:
        raise InputError(
            f"HarmonicBalance: solver is 'receptance', but {causes[0]}, which needs dynamic stiffnesses. "
            "Use solver='stiffness'"
        )
    if method.solver != AUTO:
        return method.solver
    orders = method.first().orders
    rows = sum(len(np.unique(block.rows)) for block in lowered.blocks)
    rigid = any(block.kind != ELASTIC for block in lowered.blocks)
    # All rigid contacts are active by receptances, which pays where the structure is large alone.
    if causes or (rigid and lowered.structure.size <= DENSE) or rows * (2 * len(orders) - (orders[0] == 0)) <= LARGE:
        return STIFFNESS
    # All modes of a small structure make receptances exact, at the cost of a matrix of them where damping couples them.
    if lowered.structure.size <= DENSE and couples(lowered.structure):
        return STIFFNESS
    try:
        ContactsStuck(lowered.real).reference  # noqa: B018
    except SolveError:  # a part moves freely, which dynamic stiffnesses allow
        return STIFFNESS
    return RECEPTANCE


def require_one_period(method: HarmonicBalance, where: str) -> None:
    """Raise InputError for motions of several periods of the excitation."""
    if method.periods > 1:
        raise InputError(
            f"{where}: periods of the harmonic balance is {method.periods}, which only frequency_response and "
            "follow_branch take. Use periods=1"
        )


RESAMPLED = (1.25, 2.0, 1.5, 4.0)
"""Other numbers of samples, as parts of the first one, where Newton's method alternates between the sides of kinks."""
