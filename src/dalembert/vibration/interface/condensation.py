r"""Dynamic stiffness of a structure at the coordinates of its nonlinear elements.

With q the retained and l the interior coordinates, for each harmonic at :math:`s = h\omega`, exactly,

.. math:: Z(s) = K - s^2 M + i s C + i \,\mathrm{sign}(s) D, \qquad Z_q = Z_{qq} - Z_{ql} Z_{ll}^{-1} Z_{lq}, \qquad
          F_q = f_q - Z_{ql} Z_{ll}^{-1} f_l,

with the loss matrix D of hysteretic damping, which does not act on the mean (s = 0); this
is the inverse of the receptance :math:`S Z^{-1} S^T`, and is also there where that has none. The interior of a
small structure is written in its modes with q held, so that :math:`Z_{ll}` is diagonal if the damping is; else it is
factorised.
"""

from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Any

import numpy as np
from scipy.linalg import LinAlgError, eigh, qr
from scipy.sparse import csc_array, diags_array, issparse
from scipy.sparse.linalg import splu

from dalembert.errors import ModelError, SolveError, listed
from dalembert.structure import Structure
from dalembert.structure.eigenmodes import real_part
from dalembert.vibration.interface.coordinates import Coordinates
from dalembert.vibration.interface.free_motions import FLOATING, free_motions, moving_names

DENSE = 1500
"""Size up to which a sparse interior is treated as a dense one."""
COUPLED = 1e-9
"""Damping between modes, as part of the largest of a mode, above which it counts."""
NEARLY = 1e-8
"""Dynamic stiffness, as part of the stiffness, of an interior mode that has none: half the digits are left of both."""
DECOUPLED = 1e-10
"""Stiffness or static force along a free motion, as part of the largest, that is rounding."""


@dataclass(frozen=True)
class CondensedStructure:
    """A condensed structure at one frequency, and the matrices that recover all coordinates. ``omega``: rad/s;
    ``frequencies`` (orders,): h ω, rad/s; ``stiffness``, ``slope`` (orders, q, q), complex: Z_q and its derivative by
    ω; ``force``, ``force_slope`` (orders, q), complex; ``follow`` (orders, l, q), complex: Z_ll⁻¹ Z_lq: the interior
    follows q by the negative of it; ``free`` (orders, l), complex: Z_ll⁻¹ f_l: the interior with q held; ``kept``:
    factors that serve all iterations here; ``shared``: what all frequencies have in common; ``rate``: derivative of ω
    by what ``slope`` and ``force_slope`` are derivatives by: 1, unless that is not ω.
    """

    omega: float
    frequencies: np.ndarray
    stiffness: np.ndarray
    slope: np.ndarray
    force: np.ndarray
    force_slope: np.ndarray
    follow: np.ndarray
    free: np.ndarray
    kept: dict[str, Any] = field(default_factory=dict, repr=False)
    shared: dict[str, np.ndarray] = field(default_factory=dict, repr=False)
    rate: float = 1.0

    @cached_property
    def load(self) -> float:
        """Norm of the forces."""
        return norm(self.force)

    @cached_property
    def stiffest(self) -> float:
        """Largest entry of the stiffness."""
        return float(np.abs(self.stiffness).max(initial=0.0))

    @property
    def free_motions(self) -> np.ndarray:
        """Mean motions (q, motions) that the stiffness does not resist. Contacts may hold them."""
        if "free motions" not in self.shared:
            motions = np.zeros((self.stiffness.shape[1], 0))
            if len(self.frequencies) and self.frequencies[0] == 0 and len(motions):
                values, vectors = np.linalg.eigh(np.real(self.stiffness[0]))
                motions = vectors[:, values <= FLOATING * self.stiffest]
            self.shared["free motions"] = motions
        return self.shared["free motions"]

    @property
    def held(self) -> bool:
        """Whether the stiffness alone holds the mean position."""
        return not self.free_motions.size

    @property
    def resonates(self) -> bool:
        """Whether a forced harmonic drives a motion that has no dynamic stiffness."""
        forced = np.abs(self.force).max(axis=1, initial=0.0) > FLOATING * self.load
        stiffness = self.stiffness[forced & (self.frequencies > 0)]
        if not stiffness.size:
            return False
        # The smallest singular value is the dynamic stiffness against the least resisted motion at this harmonic.
        smallest = np.linalg.svd(stiffness, compute_uv=False)[:, -1]
        return bool(np.any(smallest <= NEARLY * self.stiffest))

    def loaded(self, part: float) -> "CondensedStructure":
        """The same with a part of the varying forces, and derivatives by that part."""
        # f(p) = f_0 + p f_varying at one frequency: ∂R/∂p = -f_varying, and no matrix depends on p. Static forces stay,
        # as they may be what presses the contacts.
        varying = np.where(self.frequencies[:, None] > 0, self.force, 0.0)
        return replace(
            self, slope=np.zeros_like(self.slope), force=self.force + (part - 1.0) * varying, force_slope=varying,
            rate=0.0,
        )  # fmt: skip

    def interior(self, retained: np.ndarray) -> np.ndarray:
        """Interior coordinates (orders, l) where the retained ones are (orders, q)."""
        return self.free - (self.follow @ retained[:, :, None])[:, :, 0]


class Condensation:
    """A structure ready to be condensed at any frequency.

    ``loads`` (orders, n), complex: phasors of the forces.
    """

    def __init__(
        self, structure: Structure, coordinates: Coordinates, orders: tuple[int, ...], loads: np.ndarray
    ) -> None:
        self.orders = np.array(orders, dtype=float)
        size: int = structure.size
        matrices = [real_part(structure.stiffness), real_part(structure.mass)]
        matrices.append(matrices[0] * 0.0 if structure.damping is None else real_part(structure.damping))
        if structure.loss is not None:
            matrices.append(real_part(structure.loss))
        retained, interior = coordinates.retained, coordinates.interior
        dense = size <= DENSE or not issparse(structure.stiffness)
        self.retained, self.back = retained.toarray(), interior.toarray() if dense else interior
        # A congruence with x = T_q q + T_l l: symmetric blocks, and exact, as no coordinate is left out.
        inner = [self.back.T @ (matrix @ self.back) for matrix in matrices]
        if dense and interior.shape[1]:
            inner = self._modal(inner)
        self.inner: list[Any] = [block if dense else csc_array(block) for block in inner]
        self.outer = [np.asarray(self.retained.T @ (matrix @ self.retained)) for matrix in matrices]
        self.across = [np.asarray(self.back.T @ (matrix @ self.retained)).T for matrix in matrices]
        self.loads, self.names = loads, structure.dofs.names
        self.outer_loads, self.inner_loads = loads @ self.retained, np.asarray((self.back.T @ loads.T).T)
        self._shared: dict[str, np.ndarray] = {}
        self.free, self._pins = np.zeros((size, 0)), np.zeros(0, dtype=int)
        if self.orders[0] == 0 and self.inner_loads.shape[1]:
            self._set_free(free_motions(self.inner[0]))

    def at(self, omega: float) -> CondensedStructure:
        """The condensed structure at ω, rad/s."""
        s = self.orders * omega
        (outer, across, *inner), (outer_slope, across_slope, *inner_slope) = self._together(s)
        if not self.inner_loads.shape[1]:
            nothing = self.inner_loads
            return CondensedStructure(
                omega, s, outer, outer_slope, self.outer_loads, 0 * self.outer_loads, np.swapaxes(across, 1, 2),
                nothing, shared=self._shared,
            )  # fmt: skip
        inner = inner[0] if inner else self._inner(s)
        right = np.concatenate([np.swapaxes(across, 1, 2), self.inner_loads[:, :, None]], axis=2)
        solved = self.solve(s, right, self._off_resonance(s, inner, right))
        # With Y = Z_ll⁻¹ Z_lq (follow): Z_q = Z_qq - Z_ql Y, F_q = f_q - Yᵀ f_l, and for the derivatives by ω
        # Z_q' = Z_qq' - Z_ql' Y - Yᵀ Z_lq' + Yᵀ Z_ll' Y, F_q' = -Z_ql' Z_ll⁻¹ f_l + Yᵀ Z_ll' Z_ll⁻¹ f_l.
        follow, free = solved[:, :, :-1], solved[:, :, -1]
        turned = np.swapaxes(follow, 1, 2)
        moved = _times(inner_slope[0], solved) if inner_slope else self._inner_slope(s, solved)
        crossed = across_slope @ solved
        return CondensedStructure(
            omega=omega,
            frequencies=s,
            stiffness=outer - across @ follow,
            slope=outer_slope - crossed[:, :, :-1] - np.swapaxes(crossed[:, :, :-1], 1, 2) + turned @ moved[:, :, :-1],
            force=self.outer_loads - (turned @ self.inner_loads[:, :, None])[:, :, 0],
            force_slope=-crossed[:, :, -1] + (turned @ moved[:, :, -1:])[:, :, 0],
            follow=follow,
            free=free,
            shared=self._shared,
        )

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
        static = np.real(self.loads[0])
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

    def interior_slope(self, point: CondensedStructure, retained: np.ndarray) -> np.ndarray:
        """Derivative of the interior coordinates by ω where the retained ones (orders, q) are held, (orders, l)."""
        s, interior = point.frequencies, point.interior(retained)
        across = np.swapaxes(self._slope(self.across, s), 1, 2) @ retained[:, :, None]
        return -self.solve(s, self._inner_slope(s, interior[:, :, None]) + across)[:, :, 0]

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
        if issparse(self.inner[0]):
            return [csc_array(_dynamic(self.inner, x)) for x in s]
        return _dynamic(self.inner, s)

    def _slope(self, blocks: list[np.ndarray], s: np.ndarray) -> np.ndarray:
        """Derivative of K - s²M + i s C by ω."""
        _, mass, damping = blocks[:3]
        factor = self.orders.reshape(-1, *[1] * mass.ndim)
        return factor * (1j * damping - 2 * s.reshape(factor.shape) * mass)

    def _inner_slope(self, s: np.ndarray, solved: np.ndarray) -> np.ndarray:
        """Derivative of Z_ll by ω, times columns (orders, l, columns)."""
        _, mass, damping = self.inner[:3]
        if issparse(mass):
            return np.stack(
                [h * (1j * (damping @ x) - 2 * w * (mass @ x)) for h, w, x in zip(self.orders, s, solved, strict=True)]
            )
        return _times(self._slope(self.inner, s), solved)

    @cached_property
    def _side_by_side(self) -> tuple[list[np.ndarray], list[tuple[slice, tuple[int, ...]]]]:
        """Entries of the matrices that are not sparse in one vector, and the slice and shape of each."""
        parts = [part for part in (self.outer, self.across, self.inner) if not issparse(part[0])]
        ends = np.cumsum([part[0].size for part in parts]).tolist()
        places = [(slice(end - part[0].size, end), part[0].shape) for part, end in zip(parts, ends, strict=True)]
        return [np.concatenate([matrix.ravel() for matrix in kind]) for kind in zip(*parts, strict=True)], places

    def _together(self, s: np.ndarray) -> tuple[list[np.ndarray], list[np.ndarray]]:
        """Dynamic stiffness of the matrices that are not sparse, and its derivative by ω: outer, across, inner."""
        entries, places = self._side_by_side
        both = _dynamic(entries, s), self._slope(entries, s)
        first, second = ([flat[:, span].reshape(len(s), *shape) for span, shape in places] for flat in both)
        return first, second


def coupled(damping: np.ndarray) -> bool:
    """Whether damping (modes, modes) couples modes."""
    diagonal = np.diag(damping)
    off = np.abs(damping - np.diag(diagonal)).max(initial=0.0)
    return bool(off > COUPLED * max(np.abs(diagonal).max(initial=0.0), np.finfo(float).tiny))


def norm(array: np.ndarray) -> float:
    """Return the Euclidean norm of all entries. It is faster than :func:`numpy.linalg.norm` for small arrays."""
    return float(np.sqrt(np.vdot(array, array).real))


def _times(inner: np.ndarray, columns: np.ndarray) -> np.ndarray:
    """Matrices (orders, l, l), or their diagonals (orders, l), times columns (orders, l, columns)."""
    return inner[:, :, None] * columns if inner.ndim == 2 else inner @ columns


def _dynamic(blocks: list[Any], s: Any) -> Any:
    """Z at frequencies (orders,), or at one."""
    stiffness, mass, damping, *loss = blocks
    if np.ndim(s):
        s = s.reshape(-1, *[1] * mass.ndim)
    result = stiffness - s**2 * mass + 1j * s * damping
    return result + 1j * np.sign(s) * loss[0] if loss else result


def _resonance(s: np.ndarray, where: str) -> SolveError:
    frequencies = listed([f"{value / (2 * np.pi):.9g}" for value in s if value])
    return SolveError(
        f"the structure resonates without damping{where} at {frequencies} Hz, where its motion has no bound; give it "
        "damping, or choose another frequency"
    )
