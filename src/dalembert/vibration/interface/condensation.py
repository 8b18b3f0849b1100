r"""Dynamic stiffness of a structure at the coordinates of its nonlinear elements.

With q the retained and l the interior coordinates, for each harmonic at :math:`s = h\omega`, exactly,

.. math:: Z(s) = K - s^2 M + i s C + i \,\mathrm{sign}(s) D + \Omega (N + i s G), \qquad
          Z_q = Z_{qq} - Z_{ql} Z_{ll}^{-1} Z_{lq}, \qquad F_q = f_q - Z_{ql} Z_{ll}^{-1} f_l,

with the loss matrix D of hysteretic damping, which does not act on the mean (s = 0), and the circulatory and the
gyroscopic matrix N and G of a rotor with the speed Ω, with which Z is not symmetric. This is the inverse of the
receptance :math:`S Z^{-1} S^T`, and is also there where that has none. The interior of a small structure is written in
its modes with q held, so that :math:`Z_{ll}` is diagonal if the damping is; else it is factorised.
"""

from functools import cached_property
from typing import Any

import numpy as np
from scipy.linalg import LinAlgError, eigh, qr
from scipy.sparse import csc_array, diags_array, issparse
from scipy.sparse.linalg import splu

from dalembert.errors import ModelError, SolveError, listed
from dalembert.structure.eigenmodes import real_part
from dalembert.structure.structure import ROTATING
from dalembert.vibration.interface.condensed_structure import NEARLY, CondensedStructure
from dalembert.vibration.interface.dynamic_stiffness import combined, factors, slope_factors
from dalembert.vibration.interface.free_motions import FLOATING, free_motions, moving_names
from dalembert.vibration.interface.loads import Loads
from dalembert.vibration.interface.lowering import Lowered

DENSE = 1500
"""Size up to which a sparse interior is treated as a dense one."""
COUPLED = 1e-9
"""Damping between modes, as part of the largest of a mode, above which it counts."""
DECOUPLED = 1e-10
"""Stiffness or static force along a free motion, as part of the largest, that is rounding."""


class Condensation:
    """A structure ready to be condensed at any frequency.

    ``loads``: forces with these harmonics.
    """

    def __init__(self, lowered: Lowered, orders: tuple[int, ...], loads: Loads) -> None:
        structure, coordinates = lowered.structure, lowered.coordinates
        self.orders, self._spin = np.array(orders, dtype=float), lowered.spin
        size: int = structure.size
        stated = {name: getattr(structure, name) for name in ("stiffness", "mass", "damping", "loss", *ROTATING)}
        if stated["damping"] is None:
            stated["damping"] = 0.0 * structure.stiffness
        self.kinds = [name for name, matrix in stated.items() if matrix is not None]
        matrices = [real_part(stated[name]) for name in self.kinds]
        retained, interior = coordinates.retained, coordinates.interior
        dense = size <= DENSE or not issparse(structure.stiffness)
        self.retained, self.back = retained.toarray(), interior.toarray() if dense else interior
        # A congruence with x = T_q q + T_l l: symmetric blocks, and exact, as no coordinate is left out.
        inner = [self.back.T @ (matrix @ self.back) for matrix in matrices]
        if dense and interior.shape[1]:
            inner = self._modal(inner)
        self.inner: list[Any] = [block if dense else csc_array(block) for block in inner]
        self.outer = [np.asarray(self.retained.T @ (matrix @ self.retained)) for matrix in matrices]
        self.below = [np.asarray(self.back.T @ (matrix @ self.retained)) for matrix in matrices]
        self.across = [matrix.T for matrix in self.below]
        self._symmetric = not structure.rotates
        if not self._symmetric:
            self.across = [np.asarray(self.back.T @ (matrix.T @ self.retained)).T for matrix in matrices]
        self._loads, self.names = loads, structure.dofs.names
        self._outer_loads = loads.patterns @ self.retained
        self._inner_loads = np.stack([np.asarray((self.back.T @ pattern.T).T) for pattern in loads.patterns])
        self._shared: dict[str, np.ndarray] = {}
        self.free, self._pins = np.zeros((size, 0)), np.zeros(0, dtype=int)
        if self.orders[0] == 0 and self._inner_loads.shape[2]:
            self._set_free(free_motions(self.inner[0]))

    def at(self, omega: float) -> CondensedStructure:
        """The condensed structure at ω, rad/s."""
        s, spin = self.orders * omega, self._spin(omega)
        (outer, across, below, *inner), (outer_slope, across_slope, below_slope, *inner_slope) = self._together(s, spin)
        (outer_loads, inner_loads), (outer_loads_slope, inner_loads_slope) = self._loads_at(omega)
        if not inner_loads.shape[1]:
            return CondensedStructure(
                omega, s, outer, outer_slope, outer_loads, outer_loads_slope, below, across, inner_loads,
                shared=self._shared,
            )  # fmt: skip
        inner = inner[0] if inner else self._inner(s)
        right = np.concatenate([below, inner_loads[:, :, None]], axis=2)
        inner = self._off_resonance(s, inner, right)
        solved = self.solve(s, right, inner)
        # With Y = Z_ll⁻¹ Z_lq (follow) and X = Z_ql Z_ll⁻¹ (passed), which is Yᵀ of a symmetric structure:
        # Z_q = Z_qq - Z_ql Y, F_q = f_q - X f_l, and for the derivatives by ω
        # Z_q' = Z_qq' - Z_ql' Y - X Z_lq' + X Z_ll' Y, F_q' = f_q' - X f_l' - Z_ql' Z_ll⁻¹ f_l + X Z_ll' Z_ll⁻¹ f_l.
        follow, free = solved[:, :, :-1], solved[:, :, -1]
        passed = np.swapaxes(follow, 1, 2)
        if not self._symmetric:
            # Xᵀ = Z_ll⁻ᵀ Z_qlᵀ
            turned: Any = [csc_array(matrix.T) for matrix in inner] if isinstance(inner, list) else inner
            turned = np.swapaxes(turned, 1, 2) if np.ndim(turned) == 3 else turned
            passed = np.swapaxes(self.solve(s, np.swapaxes(across, 1, 2), turned), 1, 2)
        moved = _times(inner_slope[0], solved) if inner_slope else self._inner_slope(s, solved, spin)
        crossed = across_slope @ solved
        force_slope = (passed @ moved[:, :, -1:])[:, :, 0] - crossed[:, :, -1]
        if self._loads.factors:
            force_slope += outer_loads_slope - (passed @ inner_loads_slope[:, :, None])[:, :, 0]
        crossed_back = np.swapaxes(crossed[:, :, :-1], 1, 2) if self._symmetric else passed @ below_slope
        return CondensedStructure(
            omega=omega,
            frequencies=s,
            stiffness=outer - across @ follow,
            slope=outer_slope - crossed[:, :, :-1] - crossed_back + passed @ moved[:, :, :-1],
            force=outer_loads - (passed @ inner_loads[:, :, None])[:, :, 0],
            force_slope=force_slope,
            follow=follow,
            passed=passed,
            free=free,
            shared=self._shared,
        )

    def _loads_at(self, omega: float) -> tuple[tuple[np.ndarray, np.ndarray], tuple[np.ndarray, np.ndarray]]:
        """Forces on the retained and the interior coordinates, and their derivatives by ω, (orders, -) each."""
        outer, inner = self._outer_loads, self._inner_loads
        if not self._loads.factors:
            return (outer[0], inner[0]), self._no_loads
        first, second = (
            (np.tensordot(weights, outer, 1), np.tensordot(weights, inner, 1)) for weights in self._loads.weights(omega)
        )
        return first, second

    @cached_property
    def _no_loads(self) -> tuple[np.ndarray, np.ndarray]:
        return np.zeros_like(self._outer_loads[0]), np.zeros_like(self._inner_loads[0])

    @property
    def constant_loads(self) -> np.ndarray:
        """Forces that do not depend on the frequency, on retained and interior coordinates, (orders, n)."""
        return np.concatenate([self._outer_loads[0], self._inner_loads[0]], axis=1)

    def full(self, retained: np.ndarray, interior: np.ndarray) -> np.ndarray:
        """Return all degrees of freedom (orders, n) from the retained and the interior ones. If nothing holds the
        structure along the motions :attr:`free`, its mean position (order 0) is not determined along them. The one
        without a part along them is returned, which has the smallest norm.
        """
        motion = retained @ self.retained.T + np.asarray((self.back @ interior.T).T)
        if self.free.size:
            motion[0] -= self.free @ (self.free.T @ motion[0])
        return motion

    def _set_free(self, motions: np.ndarray) -> None:
        """Keep the motions (l, motions) that nothing holds where the coordinates of the elements are held. They must
        carry mass and no static force, else ModelError: periodic motions then exist, each about any mean position.
        """
        if not motions.size:
            return
        moved = np.asarray(self.back @ motions)
        size = np.abs(moved).max(axis=1)
        inner = self.inner[1]
        moving = inner[:, None] * motions if inner.ndim == 1 else np.asarray(inner @ motions)
        mass = np.linalg.eigvalsh(motions.T @ moving)
        coupled = np.abs(self.across[0] @ motions).max(initial=0.0)
        if mass[0] <= FLOATING * abs(self.inner[1]).max() or coupled > DECOUPLED * abs(self.outer[0]).max(initial=1.0):
            raise ModelError(
                f"the structure can move freely, at {moving_names(self.names, size)}, without a mass, a spring or a "
                "contact that holds it, so its motion is not determined; clamp it, or give it mass"
            )
        # An orthonormal basis, so that `full` removes exactly the part along free motions.
        self.free = np.linalg.qr(moved)[0]
        static = np.real(self._loads.constant[0])
        force = float(np.linalg.norm(self.free.T @ static))
        if force > DECOUPLED * np.linalg.norm(static):
            raise ModelError(
                f"a mean force of {force:.3g} N acts along {moving_names(self.names, size)}, where no spring and no "
                "contact holds the structure, so it has no periodic motion; clamp it, or balance the static forces"
            )
        self._pins = qr(motions.T, mode="r", pivoting=True)[-1][: motions.shape[1]]

    @property
    def free_names(self) -> str:
        """Degrees of freedom whose mean position nothing holds; empty without."""
        return moving_names(self.names, np.abs(self.free).max(axis=1)) if self.free.size else ""

    def _pinned(self, inner: Any) -> Any:
        """Interior stiffness of the mean position with a support for each free motion, which carries no force."""
        support = float(abs(self.inner[0]).max()) or 1.0
        if isinstance(inner, list):
            places = np.zeros(inner[0].shape[0])
            places[self._pins] = support
            return [csc_array(inner[0] + diags_array(places)), *inner[1:]]
        inner = inner.copy()
        inner[(0, self._pins) if inner.ndim == 2 else (0, self._pins, self._pins)] += support
        return inner

    def solve(self, s: np.ndarray, right: np.ndarray, inner: Any = None) -> np.ndarray:
        """Z_ll⁻¹ times right-hand sides (orders, l, columns)."""
        inner = self._off_resonance(s, self._inner(s)) if inner is None else inner
        if not isinstance(inner, list) and inner.ndim == 2:
            return right / inner[:, :, None]
        try:
            if isinstance(inner, list):
                return np.stack([splu(matrix).solve(columns) for matrix, columns in zip(inner, right, strict=True)])
            return np.linalg.solve(inner, right)
        except (RuntimeError, np.linalg.LinAlgError):
            raise _resonance(s, "") from None

    @cached_property
    def _resonant(self) -> np.ndarray:
        """Dynamic stiffness of each interior mode (l,) that is rounding of its stiffness and inertia."""
        return 2 * FLOATING * np.abs(self.inner[0])

    def _off_resonance(self, s: np.ndarray, inner: Any, right: np.ndarray | None = None) -> Any:
        """Return the dynamic stiffness of the interior modes, with a small value in place of zero. That is exact where
        nothing moves such a mode, and close to it where the retained coordinates hold it. SolveError if forces, the
        last of the right-hand sides, move one that the retained coordinates do not hold.
        """
        if self._pins.size:
            inner = self._pinned(inner)
        if isinstance(inner, list) or inner.ndim > 2:
            return inner
        # K - s²M of an undamped mode at its own frequency is rounding of its two terms. Half of the digits are kept by
        # a small value in its place.
        still = np.abs(inner) <= self._resonant
        if not still.any():
            return inner
        if right is not None:
            sizes = np.abs(right)
            resisted = sizes[:, :, :-1].max(axis=2, initial=0.0) > FLOATING * sizes[:, :, :-1].max(initial=0.0)
            free = still & ~resisted & (sizes[:, :, -1] > FLOATING * sizes[:, :, -1].max())
            if free.any():
                order, mode = np.argwhere(free)[0]
                raise _resonance(s[order : order + 1], f", at {moving_names(self.names, np.abs(self.back[:, mode]))},")
        return np.where(still, NEARLY * np.abs(self.inner[0]), inner)

    def _modal(self, blocks: list[np.ndarray]) -> list[np.ndarray]:
        """Interior matrices in modes with q held: vectors where they are diagonal. Without modes, as they are."""
        stiffness, mass, *damped = blocks
        try:
            squares, shapes = eigh(stiffness, mass)
        except LinAlgError:  # an interior without mass somewhere
            return blocks
        modal = [shapes.T @ matrix @ shapes for matrix in damped]
        if any(map(coupled, modal)):
            return blocks
        self.back = self.back @ shapes
        return [squares, np.ones_like(squares), *map(np.diag, modal)]

    def _inner(self, s: np.ndarray) -> Any:
        speed = self._spin(float(s[-1] / self.orders[-1]))[0]
        if issparse(self.inner[0]):
            return [csc_array(self._dynamic(self.inner, x, speed)) for x in s]
        return self._dynamic(self.inner, s, speed)

    def _dynamic(self, blocks: list[Any], s: Any, speed: float) -> Any:
        """Z at frequencies (orders,), or at one."""
        if np.ndim(s):
            s = s.reshape(-1, *[1] * blocks[0].ndim)
        return combined(factors(self.kinds, s, speed), dict(zip(self.kinds, blocks, strict=True)))

    def _slope(self, blocks: list[Any], s: np.ndarray, spin: tuple[float, float]) -> Any:
        """Derivative of :meth:`_dynamic` by ω. ``spin``: speed of the rotor, and its derivative by ω."""
        orders = self.orders.reshape(-1, *[1] * blocks[0].ndim)
        weights = slope_factors(self.kinds, orders, s.reshape(orders.shape), spin)
        return combined(weights, dict(zip(self.kinds, blocks, strict=True)))

    def _inner_slope(self, s: np.ndarray, solved: np.ndarray, spin: tuple[float, float]) -> np.ndarray:
        """Derivative of Z_ll by ω, times columns (orders, l, columns)."""
        if not issparse(self.inner[0]):
            return _times(self._slope(self.inner, s, spin), solved)
        moved = ({name: block @ x for name, block in zip(self.kinds, self.inner, strict=True)} for x in solved)
        weights = (slope_factors(self.kinds, h, w, spin) for h, w in zip(self.orders, s, strict=True))
        return np.stack([combined(*pair) for pair in zip(weights, moved, strict=True)])

    @cached_property
    def _side_by_side(self) -> tuple[list[np.ndarray], list[tuple[slice, tuple[int, ...]]]]:
        """Entries of the matrices that are not sparse in one vector, and the slice and shape of each."""
        parts = [self.outer, self.across, *([] if self._symmetric else [self.below])]
        parts += [] if issparse(self.inner[0]) else [self.inner]
        ends = np.cumsum([part[0].size for part in parts]).tolist()
        places = [(slice(end - part[0].size, end), part[0].shape) for part, end in zip(parts, ends, strict=True)]
        return [np.concatenate([matrix.ravel() for matrix in kind]) for kind in zip(*parts, strict=True)], places

    def _together(self, s: np.ndarray, spin: tuple[float, float]) -> tuple[list[np.ndarray], list[np.ndarray]]:
        """Dynamic stiffness of the matrices that are not sparse, and its derivative by ω: outer, across, below,
        inner.
        """
        entries, places = self._side_by_side
        both = self._dynamic(entries, s, spin[0]), self._slope(entries, s, spin)
        first, second = ([flat[:, span].reshape(len(s), *shape) for span, shape in places] for flat in both)
        if self._symmetric:
            for blocks in (first, second):
                blocks.insert(2, np.swapaxes(blocks[1], 1, 2))
        return first, second


def coupled(damping: np.ndarray) -> bool:
    """Whether damping (modes, modes) couples modes."""
    diagonal = np.diag(damping)
    off = np.abs(damping - np.diag(diagonal)).max(initial=0.0)
    return bool(off > COUPLED * max(np.abs(diagonal).max(initial=0.0), np.finfo(float).tiny))


def _times(inner: np.ndarray, columns: np.ndarray) -> np.ndarray:
    """Matrices (orders, l, l), or their diagonals (orders, l), times columns (orders, l, columns)."""
    return inner[:, :, None] * columns if inner.ndim == 2 else inner @ columns


def _resonance(s: np.ndarray, where: str) -> SolveError:
    frequencies = listed([f"{value / (2 * np.pi):.9g}" for value in s if value])
    return SolveError(
        f"the structure resonates without damping{where} at {frequencies} Hz, where its motion has no bound; give it "
        "damping, or choose another frequency"
    )
