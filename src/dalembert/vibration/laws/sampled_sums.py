r"""Fourier coefficients of the forces of laws without internal state, by samples, with their exact derivatives.

Alternating frequency and time: the law is called at each sample. Its derivatives by displacement and velocity come from
complex steps, and :math:`\partial\lambda/\partial U_k = \lambda_{,u} \cos k\tau - \omega k\,\lambda_{,v} \sin k\tau`.
"""

from dataclasses import dataclass
from functools import partial
from typing import NamedTuple

import numpy as np

from dalembert.errors import InputError
from dalembert.forward.complex_steps import DROPPING, attempted, lost_step
from dalembert.kernels.kernel import inner, kernel
from dalembert.kernels.words import Address, Complexes, Complexes2, Complexes3, Reals3, Reals4
from dalembert.vibration.fourier import Fourier
from dalembert.vibration.laws.law import call_law
from dalembert.vibration.laws.law_block import LawBlock

STEP = 1e-30
"""Size of the imaginary step; second-order terms vanish below the rounding of the first."""


class SampledSumsWorkspace(NamedTuple):
    """Workspace for one element: displacements, velocities, forces (columns,), and internal numbers (states,)."""

    u: Complexes
    v: Complexes
    force: Complexes
    state: Complexes

    @classmethod
    def of(cls, columns: int, states: int) -> "SampledSumsWorkspace":
        """Workspace for an element with these numbers of columns and of internal numbers."""
        u, v, force = np.zeros((3, columns), complex)
        return cls(u, v, force, np.zeros(states, complex))


@inner
def _place(place, velocity, t, scratch):
    """Set displacements and velocities to those (columns, samples) of a sample."""
    for i in range(len(scratch.u)):
        scratch.u[i], scratch.v[i] = place[i, t], velocity[i, t]


@kernel
def sampled_forces(
    law: Address,
    numbers: Complexes2,
    place: Complexes3,
    velocity: Complexes3,
    scratch: SampledSumsWorkspace,
    result: Complexes3,
) -> None:
    """Forces (elements, columns, samples) from rest over a motion (elements, columns, samples)."""
    for e in range(len(place)):
        scratch.state[:] = 0.0
        for t in range(place.shape[2]):
            _place(place[e], velocity[e], t, scratch)
            call_law(law, scratch.u, scratch.v, scratch.state, numbers[e], scratch.force)
            for i in range(len(scratch.u)):
                result[e, i, t] = scratch.force[i]


@kernel
def law_derivatives(
    law: Address, numbers: Complexes2, place: Complexes3, velocity: Complexes3, start: Complexes2, directions: int,
    scratch: SampledSumsWorkspace, moved: Complexes, force: Reals3, slopes: Reals4,
) -> None:  # fmt: skip
    """Forces (elements, columns, samples), and derivatives of forces and next state, at each sample. ``start``
    (elements, states) are the states before the first sample; ``moved`` (states,) is workspace. ``slopes`` (elements,
    columns + states, directions, samples), by displacements, velocities and states before.
    """
    columns, states = len(scratch.u), len(scratch.state)
    for e in range(len(place)):
        for s in range(states):
            scratch.state[s] = start[e, s].real
        for t in range(place.shape[2]):
            # One call of the law for each derivative and sample: the law is short, and the complex step has no error of
            # differences.
            for direction in range(directions):
                _place(place[e], velocity[e], t, scratch)
                for s in range(states):
                    moved[s] = scratch.state[s]
                if direction < columns:
                    scratch.u[direction] += 1j * STEP
                elif direction < 2 * columns:
                    scratch.v[direction - columns] += 1j * STEP
                else:
                    moved[direction - 2 * columns] += 1j * STEP
                call_law(law, scratch.u, scratch.v, moved, numbers[e], scratch.force)
                for i in range(columns):
                    force[e, i, t] = scratch.force[i].real
                    slopes[e, i, direction, t] = scratch.force[i].imag / STEP
                for s in range(states):
                    slopes[e, columns + s, direction, t] = moved[s].imag / STEP
            if states:
                _place(place[e], velocity[e], t, scratch)
                call_law(law, scratch.u, scratch.v, scratch.state, numbers[e], scratch.force)


@dataclass(frozen=True)
class SampledSums:
    """Sums of samples, of laws without internal state."""

    block: LawBlock
    series: Fourier

    def forces(self, displacements: np.ndarray, omega: float) -> np.ndarray:
        force = forces_from_rest(self.block, *self._motion(displacements, omega)) @ self.series.analysis.T
        return force if np.iscomplexobj(displacements) or np.iscomplexobj(self.block.numbers) else np.real(force)

    def with_slopes(self, displacements: np.ndarray, omega: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        require_complex_steps(self.block, self.series, displacements, omega)
        rated, columns, series = self.block.element.rated, displacements.shape[1], self.series
        motion, none = self._motion(displacements, omega), np.zeros((len(displacements), 0))
        force, slopes = derivatives(self.block, *motion, none, (1 + rated) * columns)
        # ∂λ/∂U_k = λ_u cos kτ, and -ω k λ_v sin kτ where velocities count: weights of samples, analysed as the force
        # is.
        local = slopes[:, :, :columns, None] * series.synthesis.T  # (elements, columns, columns, coefficients, samples)
        by_omega = np.zeros(displacements.shape)
        if rated:
            by_rate, rates = slopes[:, :, columns:], displacements @ series.waves[1].T
            local = local + omega * (by_rate[:, :, :, None] * series.waves[1].T)
            # v = ω ∂u/∂τ: ∂λ/∂ω = λ_v ∂u/∂τ
            by_omega = np.einsum("eijt,ejt->eit", by_rate, rates) @ series.analysis.T
        local = np.moveaxis((local.reshape(-1, series.samples) @ series.analysis.T).reshape(*local.shape[:4], -1), 4, 2)
        unknowns = columns * series.count
        return force @ series.analysis.T, local.reshape(-1, unknowns, unknowns), by_omega

    def _motion(self, displacements: np.ndarray, omega: float) -> tuple[np.ndarray, np.ndarray]:
        return sampled_motion(displacements, omega * self.block.element.rated, self.series)


def sampled_motion(displacements: np.ndarray, omega: float, series: Fourier) -> tuple[np.ndarray, np.ndarray]:
    """Displacements and velocities at samples, as kernels take them."""
    place = (displacements @ series.waves[0].T).astype(complex)
    return place, omega * (displacements @ series.waves[1].T).astype(complex) if omega else np.zeros_like(place)


def forces_from_rest(block: LawBlock, place: np.ndarray, velocity: np.ndarray) -> np.ndarray:
    """Forces at samples of a motion, all (elements, columns, samples), complex."""
    result = np.empty_like(place)
    scratch = SampledSumsWorkspace.of(place.shape[1], block.states)
    sampled_forces(block.law.address, block.complex_numbers, place, velocity, scratch, result)
    return result


def derivatives(
    block: LawBlock, place: np.ndarray, velocity: np.ndarray, start: np.ndarray, directions: int
) -> tuple[np.ndarray, np.ndarray]:
    """Forces and derivatives at each sample, see :func:`law_derivatives`."""
    (elements, columns, samples), states = place.shape, block.states
    force, slopes = np.empty(place.shape), np.empty((elements, columns + states, directions, samples))
    law_derivatives(
        block.law.address, block.complex_numbers, place, velocity, start.astype(complex), directions,
        SampledSumsWorkspace.of(columns, states), np.empty(states, complex), force, slopes,
    )  # fmt: skip
    return force, slopes


_compared: set[str] = set()
"""Digests of the laws whose complex step was compared with differences."""


def require_complex_steps(block: LawBlock, series: Fourier, displacements: np.ndarray, omega: float) -> None:
    """Refuse a law of the user's that drops the imaginary part of displacements or of its state."""
    law = block.law
    if law.packaged or law.digest in _compared or not np.any(displacements):
        return
    place, velocity = sampled_motion(displacements, omega, series)
    # Along one random direction of the size of the motion: a law that drops the step anywhere shows it there.
    way = np.random.default_rng(0).uniform(0.5, 1.0, displacements.shape)
    way *= np.max(np.abs(place)) / max(np.max(np.abs(way @ series.synthesis.T)), np.finfo(float).tiny)
    moves, speeds = sampled_motion(way, omega, series)

    def forces(shift: complex) -> np.ndarray:
        values = np.ravel(forces_from_rest(block, place + shift * moves, velocity + shift * speeds))
        return values if np.imag(shift) else np.real(values)

    lost = attempted(partial(lost_step, forces, 1.0))
    if lost:
        raise InputError(
            f"element {block.names[0]!r}: the derivative of its force along a motion is {lost.by_step:.6g} N by the "
            f"complex step, but {lost.by_differences:.6g} N by differences. Its law {law.name!r} drops the imaginary "
            f"part, as {DROPPING} do. Compare real parts (u[0].real), and use absolute, norm, hypot and atan2 of "
            "dalembert"
        )
    _compared.add(law.digest)
