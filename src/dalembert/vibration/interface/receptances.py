r"""Receptances of a structure at the rows of its elements, at any frequency, without a factorisation there.

With the compliance G_0 and the modes of the structure whose contacts stick
(:mod:`dalembert.vibration.interface.stuck_structure`),

.. math:: G(s) = B (K_r - s^2 M + i s C + i\,\mathrm{sign}(s) D + \Omega (N + i s G))^{-1} B^T
          = G_0 + B V [(1 + \hat Z(s))^{-1} - 1] V^T B^T,

where :math:`\hat Z` are the terms beside the stiffness among the modes. With all modes this is exact. Without the fast
ones it is modal acceleration: their compliance is in :math:`G_0`, and what is left out of each is its inertia,
:math:`s^2\mu` of it.
"""

from collections.abc import Callable
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Any

import numpy as np

from dalembert.errors import SolveError
from dalembert.vibration.fourier import Fourier
from dalembert.vibration.interface.condensed_structure import NEARLY, norm
from dalembert.vibration.interface.dynamic_stiffness import combined, factors, slope_factors
from dalembert.vibration.interface.free_motions import FLOATING
from dalembert.vibration.interface.loads import Loads
from dalembert.vibration.interface.stuck_structure import StuckStructure

FULL = 0.5
"""Part of the rows from which on a product with some columns of the compliance takes all of them."""


@dataclass(frozen=True)
class ReceptancePoint:
    """Receptances at one frequency. ``omega``: rad/s; ``frequencies`` (orders,): h ω; ``gains``, ``gain_slopes``
    (orders, modes) or (orders, modes, modes): the bracket of the formula and its derivative by ω; ``linear``,
    ``linear_slope`` (rows, coefficients): displacements of the rows under the loads while all contacts stick, m, and
    their derivative by what the path follows; ``forced`` (orders, n): phasors of the loads; ``rate``: derivative of ω
    by what the path follows: 1 or 0; ``resonates``: whether a mode has no dynamic stiffness where it is driven.
    """

    stuck: StuckStructure
    series: Fourier
    omega: float
    frequencies: np.ndarray
    gains: np.ndarray
    gain_slopes: np.ndarray
    linear: np.ndarray
    linear_slope: np.ndarray
    forced: np.ndarray
    rate: float = 1.0
    resonates: bool = False
    kept: dict[str, Any] = field(default_factory=dict, repr=False)

    #: The equations are of displacements: no stiffness scales them.
    stiffest = 1.0
    #: The reference holds all parts.
    held = True

    @cached_property
    def load(self) -> float:
        """Norm of the displacements by the loads."""
        return norm(self.linear)

    def respond(self, forces: np.ndarray, rows: np.ndarray | None = None, single: bool = False) -> np.ndarray:
        """G times forces on all rows (rows, coefficients), or on some. ``single``: compliance in single precision."""
        return self._static(forces, rows, single) + self._modal(self.gains, forces, rows)

    def respond_slope(self, forces: np.ndarray) -> np.ndarray:
        """The derivative of G by ω times forces (rows, coefficients)."""
        return self._modal(self.gain_slopes, forces, None)

    def respond_growth(self, forces: np.ndarray) -> np.ndarray:
        """The derivative of G by the negative damping ξ times forces (rows, coefficients)."""
        # q = 1 + Ẑ has the part -i s ξ μ: ∂(1/q)/∂ξ = (1/q) i s μ (1/q), and 1/q is one more than the gains.
        inertias, frequencies = self.stuck.inertias, 1j * self.frequencies[:, None]
        if self.gains.ndim == 2:
            return self._modal((1 + self.gains) ** 2 * frequencies * inertias, forces, None)
        inverse = np.eye(len(inertias)) + self.gains
        return self._modal(inverse * (frequencies * inertias)[:, None, :] @ inverse, forces, None)

    def respond_transposed(self, forces: np.ndarray) -> np.ndarray:
        """The transpose of G, as a real matrix of coefficients, times forces (rows, coefficients)."""
        # A phasor matrix G = Gᵀ, that of a structure without a rotor that turns, has the conjugate as its real
        # transpose: conj(G) f = conj(G conj(f)).
        turned = np.ones(self.series.count)
        turned[self.series.mean + 1 :: 2] = -1.0
        return turned * self.respond(turned * forces)

    def among(self, rows: np.ndarray) -> np.ndarray:
        """G at some rows, (orders, rows, rows)."""
        # G_0 + (B V) d (B V)ᵀ; d is diagonal where the damping couples no modes.
        shapes = self.stuck.row_shapes[rows]
        gained = shapes * self.gains[:, None, :] if self.gains.ndim == 2 else shapes @ self.gains
        return self.stuck.compliance[np.ix_(rows, rows)] + gained @ shapes.T

    def motion(self, forces: np.ndarray, dofs: np.ndarray | None = None) -> np.ndarray:
        """Coefficients of the displacements of all degrees of freedom (n, coefficients), or of some (dofs, ...).

        ``forces`` (rows, coefficients): what the elements' forces differ from those of their reference.
        """
        stuck, series = self.stuck, self.series
        # x = (K_r - s²M + isC)⁻¹ (f - Bᵀ (λ - r u)): the static part of all modes, and the gains of the kept ones.
        loads = series.coefficients(self.forced)
        # A few degrees of freedom have rows of their own, computed once. For many, a solution at each point is cheaper.
        if dofs is None:
            return self.answer(loads - stuck.rows.T @ forces)
        if len(dofs) > MANY * series.count:
            static = stuck.solve(loads - stuck.rows.T @ forces)[dofs]
        else:
            static = self._static_loads(dofs) - stuck.recovery(dofs) @ forces
        modal = self.with_gains(stuck.shapes.T @ loads - stuck.row_shapes.T @ forces)
        return static + stuck.shapes[dofs] @ modal

    def answer(self, loads: np.ndarray) -> np.ndarray:
        """Displacements under loads on all degrees of freedom while all contacts stick, (n, coefficients) both."""
        stuck = self.stuck
        return stuck.solve(loads) + stuck.shapes @ self.with_gains(stuck.shapes.T @ loads)

    def loaded(self, part: float) -> "ReceptancePoint":
        """The same with a part of the varying loads, and derivatives by that part."""
        varies = self.frequencies[:, None] > 0
        series = self.series
        varying = series.coefficients(np.where(varies, series.phasors(self.linear), 0.0))
        return replace(
            self, linear=self.linear + (part - 1.0) * varying, linear_slope=varying,
            gain_slopes=np.zeros_like(self.gain_slopes), rate=0.0,
            forced=np.where(varies, part, 1.0) * self.forced, kept={},
        )  # fmt: skip

    def _static_loads(self, dofs: np.ndarray) -> np.ndarray:
        key = f"loads {dofs.tobytes()!r}"
        if key not in self.kept:
            self.kept[key] = self.stuck.solve(self.series.coefficients(self.forced))[dofs]
        return self.kept[key]

    def _static(self, forces: np.ndarray, rows: np.ndarray | None, single: bool) -> np.ndarray:
        compliance = self.stuck.single if single else self.stuck.compliance
        forces = forces.astype(compliance.dtype, copy=False)
        if rows is None:
            return compliance @ forces
        if len(rows) < FULL * len(compliance):
            # The compliance is symmetric: its rows are its columns, and lie side by side in memory.
            return compliance[rows].T @ forces
        placed = np.zeros((len(compliance), forces.shape[1]), compliance.dtype)
        placed[rows] = forces
        return compliance @ placed

    def _modal(self, gains: np.ndarray, forces: np.ndarray, rows: np.ndarray | None) -> np.ndarray:
        shapes = self.stuck.row_shapes
        among = (shapes if rows is None else shapes[rows]).T @ forces
        return shapes @ self.with_gains(among, gains)

    def with_gains(self, modal: np.ndarray, gains: np.ndarray | None = None) -> np.ndarray:
        """Gains, or their slopes, times coefficients of modal forces (modes, coefficients)."""
        gains = self.gains if gains is None else gains
        phasors = self.series.phasors(modal)
        turned = gains * phasors if gains.ndim == 2 else (gains @ phasors[:, :, None])[:, :, 0]
        return self.series.coefficients(turned)


MANY = 8
"""Observed degrees of freedom, in parts of the coefficients, above which all of them are solved for at each point."""


@dataclass(frozen=True)
class Receptances:
    """A structure whose contacts stick, with the harmonics of a series. ``loads``: forces in these harmonics; ``spin``:
    speed of the rotor and its derivative, over ω.
    """

    stuck: StuckStructure
    series: Fourier
    loads: Loads
    spin: Callable[[float], tuple[float, float]]

    def at(self, omega: float, growth: float = 0.0) -> ReceptancePoint:
        """The receptances at ω, rad/s, with the damping C - ξ M. ``growth``: ξ, 1/s."""
        s = np.array(self.series.orders, dtype=float) * omega
        gains, slopes, still = self._gains(s, self.spin(omega), growth)
        weights, weight_slopes = self.loads.weights(omega)
        (static, modal), (static_slope, modal_slope) = (
            [np.tensordot(factors, parts, 1) for parts in self._loaded] for factors in (weights, weight_slopes)
        )
        driven = np.abs(modal) > FLOATING * np.abs(modal).max(initial=0.0)
        shapes = self.stuck.row_shapes

        def moved(gain: np.ndarray, modal: np.ndarray) -> np.ndarray:
            turned = gain * modal if gain.ndim == 2 else (gain @ modal[:, :, None])[:, :, 0]
            return shapes @ self.series.coefficients(turned)

        slope = moved(slopes, modal)
        if self.loads.factors:
            slope += static_slope + moved(gains, modal_slope)
        return ReceptancePoint(
            self.stuck, self.series, omega, s, gains, slopes, static + moved(gains, modal), slope,
            self.loads.at(omega), resonates=bool(np.any(still & driven)),
            kept={} if self.loads.factors else self._kept,
        )  # fmt: skip

    @cached_property
    def _kept(self) -> dict[str, Any]:
        return {}

    @cached_property
    def _loaded(self) -> tuple[np.ndarray, np.ndarray]:
        """Static displacements of the rows (patterns, rows, coefficients) under each pattern of the loads, and modal
        loads (patterns, orders, modes).
        """
        patterns = self.loads.patterns
        static = np.zeros((len(patterns), len(self.stuck.reference), self.series.count))
        for pattern, result in zip(patterns, static, strict=True):
            loads = self.series.coefficients(pattern)
            pushed = np.any(loads, axis=0)
            result[:, pushed] = self.stuck.rows @ self.stuck.solve(loads[:, pushed])
        return static, patterns @ self.stuck.shapes

    def _gains(
        self, s: np.ndarray, spin: tuple[float, float], growth: float
    ) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """1/q - 1 with q = 1 + Ẑ, its derivative by ω, and whether a mode has q = 0."""
        stuck, orders = self.stuck, np.array(self.series.orders, dtype=float)
        full = any(part.ndim == 2 for part in stuck.damping.values())
        matrices = {"mass": np.diag(stuck.inertias) if full else stuck.inertias, **stuck.damping}
        if growth:
            matrices["damping"] = matrices.get("damping", 0.0) - growth * matrices["mass"]
        s, orders = (values.reshape(-1, *[1] * (1 + full)) for values in (s, orders))
        # q - 1, which is small for fast modes: 1/q - 1 = -(q - 1)/q has no cancellation.
        beyond = combined(factors(matrices, s, spin[0]), matrices)
        slope = combined(slope_factors(matrices, orders, s, spin), matrices)
        if not full:
            # An undamped mode at its frequency, with half of the digits of both terms: contacts that slip detune it.
            still = np.abs(1 + beyond) < NEARLY
            stiffness = np.where(still, NEARLY, 1 + beyond)
            return -beyond / stiffness, -slope / stiffness**2, still
        try:
            inverse = np.linalg.inv(np.eye(beyond.shape[1]) + beyond)
        except np.linalg.LinAlgError:
            raise SolveError("the structure whose contacts stick resonates without damping; give it damping") from None
        return -inverse @ beyond, -inverse @ slope @ inverse, np.zeros(beyond.shape[:2], dtype=bool)
