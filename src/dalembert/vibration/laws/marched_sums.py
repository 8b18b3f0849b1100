r"""Fourier coefficients of the forces of laws with internal state or events, with their exact derivatives.

The state at the start of the period is the one that returns, :math:`z = \Phi(z, U, \omega)`. It is computed by periods
from rest, then by Newton's method. Its derivative follows from the same condition,
:math:`\mathrm{d}z = (1 - \Phi_{,z})^{-1}\,\Phi_{,U}\,\mathrm{d}U`. Where :math:`1 - \Phi_{,z}` is singular, as of a
slider that sticks, the state depends on the past; the past then is the one from rest.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from dalembert.vibration.fourier import Fourier, synthesis
from dalembert.vibration.laws.law_block import LawBlock
from dalembert.vibration.laws.law_march import UNPERTURBED, Called, MarchWorkspace, Motion, Rule, marches
from dalembert.vibration.laws.sampled_sums import STEP, derivatives, require_complex_steps, sampled_motion

GAUSS = 3
"""Nodes in each interval between events; the error falls with the sixth power of the interval."""
PER_INTERVAL = 2
"""Samples that an interval with these nodes stands for."""
PLAIN = 2
"""Periods from rest before Newton's method."""
SWEEPS = 200
"""Periods after which a state is taken as it is."""
SETTLED = 1e-13
"""Change of a state over a period, as part of its largest value, at which it is periodic."""
SETTLED_SLOPE = 1e-10
"""The same for a derivative of the state."""
NEUTRAL = 1e-6
"""Smallest singular value of 1 - Φ_z at which a state forgets its start."""
BEYOND = np.errstate(over="ignore", invalid="ignore")
"""A trial of Newton's method may lie beyond what a law is for. Forces are not finite there, and the search returns."""


@dataclass(frozen=True)
class MarchedSums:
    """Sums of laws with internal state or events. ``events``: whether the law's events divide the intervals. The
    intervals then have Gauss's nodes; else each sample is a node.
    """

    block: LawBlock
    series: Fourier
    events: bool

    @BEYOND
    def forces(self, displacements: np.ndarray, omega: float) -> np.ndarray:
        runs = self._runs(displacements, omega)
        force = np.array([run.forces([UNPERTURBED], run.periodic()[0][None])[0] for run in runs])
        return force if np.iscomplexobj(displacements) or np.iscomplexobj(self.block.numbers) else np.real(force)

    @BEYOND
    def with_slopes(self, displacements: np.ndarray, omega: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        require_complex_steps(self.block, self.series, displacements, omega)
        unknowns = displacements[0].size
        results = [run.with_slopes() for run in self._runs(displacements, omega)]
        force, slopes = (np.array(part) for part in zip(*results, strict=True))
        by_omega = slopes[:, :, unknowns].reshape(displacements.shape)
        return force, slopes[:, :, :unknowns], by_omega if self.block.element.rated else 0.0 * by_omega

    @BEYOND
    def derivatives(self, displacements: np.ndarray, omega: float) -> np.ndarray:
        """Derivatives at samples, (elements, samples, columns + states, 2 columns + states).

        See the same numbers of :func:`dalembert.vibration.laws.sampled_sums.law_derivatives`.
        """
        start = np.array([run.periodic()[0] for run in self._runs(displacements, omega)])
        directions = 2 * displacements.shape[1] + self.block.states
        _, slopes = derivatives(self.block, *sampled_motion(displacements, omega, self.series), start, directions)
        return np.moveaxis(slopes, 3, 1)

    def _runs(self, displacements: np.ndarray, omega: float) -> "list[_Run]":
        element = self.block.element
        addresses = self.block.law.address, element.events.address if self.events else 0
        return [
            _Run(Called(*addresses, element.event_count if self.events else 0, numbers), self._rule, self.block.states,
                 coefficients, omega)
            for numbers, coefficients in zip(self.block.complex_numbers, displacements, strict=True)
        ]  # fmt: skip

    @cached_property
    def _rule(self) -> Rule:
        series = self.series
        offsets, weights, intervals = np.zeros(1), np.ones(1), series.samples
        if self.events:
            # Three nodes of Gauss in each interval of two samples: 1.5 calls of the law a sample, and
            # order six.
            nodes, weights = np.polynomial.legendre.leggauss(GAUSS)
            offsets, weights, intervals = (nodes + 1) / 2, weights / 2, max(series.samples // PER_INTERVAL, 4)
        angles = 2 * np.pi / intervals * (np.arange(intervals)[:, None] + offsets).ravel()
        table = synthesis(series.orders, angles)
        orders = np.array(series.orders, dtype=np.int64)
        return Rule(offsets, weights, np.stack([table, table @ series.derivative]), orders, series.mean)


@dataclass(frozen=True)
class _Run:
    """Periods of one element with displacements (columns, coefficients)."""

    called: Called
    rule: Rule
    states: int
    displacements: np.ndarray
    omega: float

    def forces(self, directions: Sequence[int], start: np.ndarray, periods: int = 1) -> np.ndarray:
        """Coefficients (directions, columns, -) of the last period; replaces the states (directions, states)."""
        return self._march(directions, start, periods)[0]

    def with_slopes(self) -> tuple[np.ndarray, np.ndarray]:
        """Coefficients (columns, -) and their derivatives by all coefficients and ω, (coefficients, those + 1)."""
        start, sweeps = self.periodic()
        count = self.displacements.size + 1
        # Two periods from rest were enough for the state: derivatives along the same two periods usually return as
        # well, which saves the system with 1 - Φ_z.
        if sweeps <= PLAIN:  # derivatives often return with the state
            forces, settled = self._from_rest(sweeps)
            if settled:
                return np.real(forces[0]), _derivatives(forces)
        ends = np.tile(start, (count + self.states, 1))
        # Directions of coefficients, then of ω, then of the state at the start, which has its own complex step.
        ends[count:] += 1j * STEP * np.eye(self.states)
        forces = self.forces([*range(count), *[UNPERTURBED] * self.states], ends)
        slopes, moved = _derivatives(forces), _derivatives(ends)
        free = np.eye(self.states) - moved[:, count:]
        if _forgets(free):
            # dF = F_U dU + F_z (1 - Φ_z)⁻¹ Φ_U dU
            total = slopes[:, :count] + slopes[:, count:] @ np.linalg.solve(free, moved[:, :count])
        else:
            total = _derivatives(self._from_rest(sweeps)[0])
        return np.real(forces[0]), total

    def _from_rest(self, sweeps: int) -> tuple[np.ndarray, bool]:
        """Coefficients along each coefficient and ω, (those, columns, -), and whether the last period is as before."""
        directions = range(self.displacements.size + 1)
        ends = np.zeros((len(directions), self.states), complex)
        if sweeps > 1:
            self.forces(directions, ends, sweeps - 1)
        before = _derivatives(ends)
        forces, after = self.forces(directions, ends), _derivatives(ends)
        return forces, bool(np.all(np.abs(after - before) <= SETTLED_SLOPE * np.abs(after)))

    def periodic(self) -> tuple[np.ndarray, int]:
        """State (states,) at the start of a period that returns to it, and the periods that it took."""
        start, best = np.zeros(self.states, complex), np.inf
        for sweep in range(SWEEPS if self.states else 1):
            # Newton's method on z - Φ(z) after `PLAIN` periods from rest.
            newton = sweep >= PLAIN
            ends = np.tile(start, (1 + newton * self.states, 1))
            ends[1:] += 1j * STEP * np.eye(self.states)[: len(ends) - 1]
            _, largest = self._march([UNPERTURBED] * len(ends), ends, 1)
            change = ends[0] - start
            errors = np.abs(np.real(change)) / np.maximum(largest, np.finfo(float).tiny)
            if np.all(errors <= SETTLED) and np.all(np.abs(change.imag) <= SETTLED_SLOPE * np.abs(ends[0].imag)):
                return ends[0], sweep + 1
            error = np.max(errors)
            if not np.isfinite(error):
                break
            free = np.eye(self.states) - _derivatives(ends[1:] - ends[0]) if newton else np.zeros((0, 0))
            # A Newton step only while the error falls; else the plain period, whose fixed point is the same.
            start = start + np.linalg.solve(free, change) if error < best and _forgets(free) else ends[0]
            best = error if newton else best
        return start, SWEEPS

    def _march(self, directions: Sequence[int], start: np.ndarray, periods: int) -> tuple[np.ndarray, np.ndarray]:
        """Coefficients (directions, columns, -), and the largest states (states,) of the last direction."""
        columns, count = self.displacements.shape
        place, rate = self.displacements @ np.swapaxes(self.rule.nodes, 1, 2)
        motion = Motion(
            self.displacements.astype(complex), np.array([self.omega], complex), place.astype(complex),
            (self.omega * rate).astype(complex), np.empty(2, dtype=np.int64),
        )  # fmt: skip
        u, v, force = np.zeros((3, columns), complex)
        first, last, values = np.zeros((3, self.called.event_count), complex)
        largest, pieces = np.zeros(self.states), np.empty((len(directions), columns, count), complex)
        sampled = np.empty((len(directions), *place.shape), complex)
        marches(
            self.called, motion, start, np.array(directions, dtype=np.int64), periods, self.rule,
            MarchWorkspace(u, v, force, first, last, values, np.zeros((2, 1, count), complex)), largest, sampled,
            pieces,
        )  # fmt: skip
        # Integrals over pieces and weighted samples of whole intervals, divided by π as Euler and Fourier's formulas
        # demand; half of that for the mean.
        weights = 2 * np.pi * len(self.rule.weights) / place.shape[1] * self.rule.weights
        result = (pieces + sampled * np.resize(weights, place.shape[1]) @ self.rule.nodes[0]) / np.pi
        result[:, :, : self.rule.mean] /= 2
        return result, largest


def _derivatives(values: np.ndarray) -> np.ndarray:
    """Derivatives (values, directions) from values with a complex step (directions, ...)."""
    return np.imag(values).reshape(len(values), -1).T / STEP


def _forgets(free: np.ndarray) -> bool:
    """Whether 1 - Φ_z is regular."""
    return bool(free.size and np.all(np.isfinite(free)) and np.linalg.svd(free, compute_uv=False)[-1] > NEUTRAL)
