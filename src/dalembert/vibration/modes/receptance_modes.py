"""Nonlinear modes by receptances: displacements of the elements' rows are the unknowns."""

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from dalembert.errors import InputError, SolveError
from dalembert.vibration.balance.newton import ROUNDING, VERIFIED
from dalembert.vibration.balance.receptance_balance import ReceptanceBalance
from dalembert.vibration.balance.row_elements import Elements
from dalembert.vibration.balance.sensitivity import step_of, with_elements
from dalembert.vibration.interface.lowering import Lowered
from dalembert.vibration.interface.receptances import ReceptancePoint, Receptances
from dalembert.vibration.interface.stiffened_mode import with_stiffened_mode
from dalembert.vibration.interface.stuck_structure import StuckStructure, stiffened, stuck_structure
from dalembert.vibration.modes.free_motion import FreeMotion, Linear, ModePlane
from dalembert.vibration.modes.mode_equations import ModeEquations, Trial
from dalembert.vibration.system.requirements import require_viscous

STILL = 1.0
"""Angular frequency, rad/s, of the place of rest, which has no harmonics and does not depend on it."""
COUPLED = 1e-9
"""Stiffness of an element at rest between two of its displacements, as part of that of one, that is none."""
HIGHER = 2.0
"""Frequency of a mode, as a multiple of that while contacts stick, up to which modes are computed."""


@dataclass(frozen=True)
class ReceptanceModes(ModeEquations):
    """The equations with all rows that elements see, the measured one and the coordinate of the linear mode as unknowns
    (rows, coefficients). That mode has a spring in the reference, with which the receptances are bounded at its
    frequency.
    """

    @cached_property
    def rest(self) -> np.ndarray:
        """Displacements of the rows (rows, coefficients) under the static forces: a mean alone."""
        problem = self.problem
        if not self.series().mean:
            return np.zeros((len(problem.lowered.row_names), self.series().count))
        samples = problem.method.first_samples
        point = problem.at(STILL)
        assert isinstance(point, ReceptancePoint)  # that of these equations
        solution = problem.solve(point.linear, STILL, samples, point=point)
        if not solution.converged:
            raise SolveError("backbone: the static forces found no balance; give smaller ones, or hold the structure")
        return solution.unknowns

    @cached_property
    def stuck(self) -> StuckStructure:
        """The structure whose contacts stick, with the stiffness of other elements at rest and a spring on its mode."""
        lowered, problem = self.problem.lowered, self.problem
        require_viscous(lowered.structure, "nonlinear modes")
        # Springs and stops act in the linear mode as they do at rest.
        still = Elements(lowered, self.series(problem.method.first_samples), problem.method.events)
        reference, count = problem.contacts_stuck.of_contacts.copy(), self.series().count
        no_contacts = [np.zeros(len(block.rows), dtype=bool) for block in lowered.blocks]
        for rows, local in still.slopes(STILL, self.rest, no_contacts).laws:
            # Of the first coefficient: all coefficients of a small motion have the same stiffness.
            single = local.reshape(*rows.shape, count, rows.shape[1], count)[:, :, 0, :, 0]
            diagonal = np.einsum("cii->ci", single)
            if np.any(np.abs(single).sum(axis=2) > (1 + COUPLED) * np.abs(diagonal)):
                raise InputError(
                    "backbone: an element couples several displacements at rest, which linear modes by receptances do "
                    "not contain. Use solver='stiffness'"
                )
            np.add.at(reference, rows, diagonal)
        try:
            slow = stuck_structure(lowered.structure, lowered.matrix, reference, 0.0)
        except SolveError:
            raise SolveError(
                "backbone: a part moves freely at rest, where receptances have no linear mode of it. Clamp it, or use "
                "solver='stiffness'"
            ) from None
        modes = int(np.sum(slow.inertias > 0))
        if not 1 <= self.mode <= modes:
            raise InputError(
                f"backbone: mode {self.mode} is asked for; expected 1 to {modes}, as many as are computed where "
                "contacts stick"
            )
        highest = HIGHER * problem.method.orders[-1] / np.sqrt(slow.inertias[self.mode - 1])
        if not slow.is_fast_enough(highest):
            slow = stuck_structure(lowered.structure, lowered.matrix, reference, highest, slow)
        covector = stiffened(lowered.structure, lowered.matrix, reference) @ slow.shapes[:, self.mode - 1]
        return with_stiffened_mode(slow, self.mode - 1, covector)

    @cached_property
    def _kept(self) -> dict[int, ReceptanceBalance]:
        return {}

    def _balance(self, samples: int) -> ReceptanceBalance:
        if samples not in self._kept:
            bare, events = (len(self.stuck.reference) - 1,), self.problem.method.events
            self._kept[samples] = ReceptanceBalance(
                self.problem.lowered, self.series(samples), self.stuck.reference, events, bare
            )
        return self._kept[samples]

    @cached_property
    def _receptances(self) -> Receptances:
        lowered, series = self.problem.lowered, self.series(self.problem.method.first_samples)
        return Receptances(self.stuck, series, lowered.loads(series), lowered.spin)

    def linear(self) -> Linear:
        """As the equations state it."""
        stuck, place = self.stuck, self.mode - 1
        # The mode without its spring: v √(1 + κ), whose coordinate is 1.
        spring = stuck.reference[-1]
        shape = stuck.shapes[:, place] * np.sqrt(1 + spring)
        inertia = stuck.inertias[place] * (1 + spring)
        damping = stuck.damping.get("damping", np.zeros(len(stuck.inertias)))
        growth = (np.diag(damping) if damping.ndim == 2 else damping)[place] * (1 + spring) / inertia
        rest = np.vstack([self.rest, np.zeros((1, self.series().count))])
        if self.series().mean:
            # wᵀ x of the rest: η = η_lin - wᵀ G (λ - r u) of the others and of -κ η, so that η/(1 + κ) is that of them.
            point = self._receptances.at(STILL)
            forces = self._balance(self.problem.method.first_samples).deviation(STILL, rest)
            rest[-1, 0] = (point.linear - point.respond(forces))[-1, 0] * (1 + spring)
        return Linear(float(1 / np.sqrt(inertia)), float(growth), rest, np.asarray(stuck.rows @ shape), shape)

    def softer(self, part: float, rest: np.ndarray) -> None:
        """None: the linear mode of large interfaces is that of contacts that stick, which small motions have."""

    def displacements(self, motion: FreeMotion) -> np.ndarray:
        """As the equations state it."""
        point, samples = self._receptances.at(motion.omega, motion.growth), self.problem.method.first_samples
        deviation = self._balance(motion.samples or samples).deviation(motion.omega, motion.harmonics)
        return point.motion(deviation)

    def trial(self, motion: FreeMotion, plane: ModePlane, samples: int) -> Trial:
        """As the equations state it."""
        point, balance = self._receptances.at(motion.omega, motion.growth), self._balance(samples)
        evaluation = balance.at(point, motion.harmonics)
        scale, measured = evaluation.scale, motion.harmonics[self.problem.lowered.measured]
        everything = np.append(evaluation.residual.ravel() / scale, self.wrong(motion, measured, plane))
        floor = min(ROUNDING * max(float(np.linalg.norm(motion.harmonics)), evaluation.terms) / scale, VERIFIED)
        return Trial(motion, everything, floor, scale, (point, balance, evaluation))

    def change(self, at: Trial, moved: Lowered) -> np.ndarray:
        """As the equations state it."""
        point, balance, _ = at.local
        motion = at.motion
        moving = replace(balance, lowered=with_elements(balance.lowered, moved))
        forces = step_of(moving.deviation(motion.omega, motion.harmonics))
        displaced = step_of(moving.displacements(motion.harmonics))
        answer = point.stuck.rows @ point.answer(self.pushes(motion, moved))
        return (displaced + point.respond(forces) - answer).ravel()

    def step(self, at: Trial, plane: ModePlane, right: np.ndarray) -> np.ndarray:
        """As the equations state it."""
        point, balance, evaluation = at.local
        motion, tangent = at.motion, balance.linearised(point, at.motion.harmonics)[1]
        size, shape = plane.scale, motion.harmonics.shape
        # J dU + ∂R/∂log ω dlog ω + ∂R/∂ξ dξ = r scale, with dU in the plane's scale, and ξ in parts of ω.
        deviation = balance.deviation(motion.omega, motion.harmonics)
        columns = np.zeros((*shape, 3))
        columns[:, :, 0] = motion.omega * tangent.slope
        columns[:, :, 1] = plane.at.omega * point.respond_growth(deviation)
        across, first = np.zeros((3, *shape)), self.series().mean
        across[[0, 1], self.problem.lowered.measured, [first, first + 1]] = size / motion.size
        across[2] = plane.direction[:-3].reshape(shape)
        corner = np.zeros((3, 3))
        corner[0, 2], corner[2] = -1.0, plane.direction[-3:]
        top = right[:-3].reshape(shape) * (evaluation.scale / size)
        change, scalars = tangent.bordered(columns / size, across, corner, top, right[-3:], tangent.forcing)
        return np.append(change, scalars)
