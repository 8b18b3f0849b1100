"""A structure at the coordinates of its nonlinear elements, at one frequency."""

from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Any

import numpy as np

from dalembert.vibration.interface.free_motions import FLOATING

NEARLY = 1e-8
"""Dynamic stiffness, as part of the stiffness, of an interior mode that has none: half the digits are left of both."""


@dataclass(frozen=True)
class CondensedStructure:
    """A condensed structure at one frequency, and the matrices that recover all coordinates. ``omega``: rad/s;
    ``frequencies`` (orders,): h ω, rad/s; ``stiffness``, ``slope`` (orders, q, q), complex: Z_q and its derivative by
    ω; ``force``, ``force_slope`` (orders, q), complex; ``follow`` (orders, l, q), complex: Z_ll⁻¹ Z_lq: the interior
    follows q by the negative of it; ``passed`` (orders, q, l), complex: Z_ql Z_ll⁻¹: the negative of it passes forces
    on the interior to q; ``free`` (orders, l), complex: Z_ll⁻¹ f_l: the interior with q held; ``kept``:
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
    passed: np.ndarray
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
                # Along a motion that the symmetric part does not resist no force does work.
                stiffness = np.real(self.stiffness[0])
                values, vectors = np.linalg.eigh((stiffness + stiffness.T) / 2)
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
        varies = self.frequencies[:, None] > 0
        varying = np.where(varies, self.force, 0.0)
        return replace(
            self, slope=np.zeros_like(self.slope), force=self.force + (part - 1.0) * varying, force_slope=varying,
            free=np.where(varies, part, 1.0) * self.free, rate=0.0,
        )  # fmt: skip

    def interior(self, retained: np.ndarray) -> np.ndarray:
        """Interior coordinates (orders, l) where the retained ones are (orders, q)."""
        return self.free - (self.follow @ retained[:, :, None])[:, :, 0]


def norm(array: np.ndarray) -> float:
    """Return the Euclidean norm of all entries. It is faster than :func:`numpy.linalg.norm` for small arrays."""
    return float(np.sqrt(np.vdot(array, array).real))
