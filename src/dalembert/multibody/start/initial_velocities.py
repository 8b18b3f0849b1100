"""Initial velocities: those that are stated are kept, the others follow from the joints.

The unknowns are the rates of the frames that no body states, those of placed bodies relative to the point that they are
placed at; the change from rest is the smallest one. In complex numbers the derivatives follow from the same equations.
"""

from collections.abc import Sequence
from itertools import pairwise

import numpy as np

from dalembert.errors import ModelError
from dalembert.multibody.components.base_body import BaseBody
from dalembert.multibody.kernels.block_table import BlockModel
from dalembert.multibody.model.carried_rates import carried_rates
from dalembert.multibody.model.evaluate import constraint_rates
from dalembert.multibody.model.lowered import Lowered
from dalembert.multibody.model.rigid_motions import CLOSED, modes_of, size_of, smallest, spread

_ROUNDING = 1e-9  # of the largest velocity: what stated velocities may leave of a constraint's rate


def initial_velocities(
    bodies: Sequence[BaseBody], rates: np.ndarray, lowered: Lowered, model: BlockModel
) -> np.ndarray:
    """Velocities of rigid motions that satisfy the joints, (N + 1,); ``rates`` are the rates that the bodies have."""
    motion = _RigidMotion(bodies, lowered, model)
    given = np.where(lowered.stated, lowered.rates, 0.0)
    _, v, left, (wrong, wrong_slope), (speed, slope) = motion.completed(given, rates & ~lowered.stated)
    if wrong > _ROUNDING * speed:
        raise _contradiction(motion, rates, left)
    if wrong_slope > _ROUNDING * slope:
        row = int(np.argmax(np.abs(np.imag(left))))
        raise ModelError(
            f"the stated initial velocities satisfy joint {motion.owner(row)!r}, but not for other values of a "
            "parameter that they or the positions depend on. Leave out velocities that follow from the joints"
        )
    return v


class _RigidMotion:
    """The first rigid motion of a mechanism as a function of the chosen rates, (bodies, rates)."""

    def __init__(self, bodies: Sequence[BaseBody], lowered: Lowered, model: BlockModel) -> None:
        self.bodies, self.lowered, self.model = bodies, lowered, model
        first = [lowered.structure.first[body.name] for body in bodies]
        self._slots = [slice(*ends) for ends in pairwise([*first, lowered.structure.n])]
        self._coordinates = [lowered.x[slots] for slots in self._slots]
        self._each = modes_of(bodies, self._coordinates, lowered.frames)
        self._place = max(size_of(lowered.x)[1], 1.0)

    def velocities(self, chosen: np.ndarray) -> np.ndarray:
        """All velocities, (N + 1,)."""
        rates = carried_rates(self.bodies, self._coordinates, self._each, chosen[:, :, None])[:, :, 0]
        v = np.zeros(len(self.lowered.x), np.result_type(rates, *self._each))
        for slots, modes, own in zip(self._slots, self._each, rates, strict=True):
            v[slots] = modes @ own
        return v

    def owner(self, row: int) -> str:
        """The joint of a constraint."""
        return self.lowered.structure.owners[self.lowered.structure.n + row]

    def completed(
        self, chosen: np.ndarray, free: np.ndarray
    ) -> tuple[np.ndarray, np.ndarray, np.ndarray, tuple[float, float], tuple[float, float]]:
        """Chosen rates with the smallest change of the ``free`` ones, velocities, and constraint rates that remain.

        Then the largest of these and of their derivatives, and the sizes of velocities and of their derivatives.
        """
        lowered, chosen = self.lowered, chosen.astype(self.lowered.x.dtype)
        units = None
        for attempt in range(4):  # linear: once for the value, twice for rounding
            v = self.velocities(chosen)
            left, _ = constraint_rates(lowered, self.model, lowered.x, v, np.zeros_like(v))
            wrong, (speed, slope) = size_of(left), size_of(v)
            speed = max(speed, 1.0)
            size = speed, max(slope, speed * self._place)  # rates, and their derivatives, that are small against it
            closed = all(error <= 10 * CLOSED * scale for error, scale in zip(wrong, size, strict=True))
            if attempt == 3 or closed or not free.any():
                break
            units = self._units(free) if units is None else units
            chosen[free] += smallest(lowered, self.model, lowered.x, units, -left)
        return chosen, v, left, wrong, size

    def _units(self, free: np.ndarray) -> np.ndarray:
        """Derivatives of the velocities by the free rates, (n, free)."""
        count = int(np.sum(free))
        unit = np.zeros((*free.shape, count))
        unit[free] = np.eye(count)
        rates = carried_rates(self.bodies, self._coordinates, self._each, unit)
        return np.tensordot(spread(self.lowered, self.bodies, self._each), rates, 2)


def _contradiction(motion: _RigidMotion, rates: np.ndarray, left: np.ndarray) -> ModelError:
    """Error for stated velocities that leave constraint rates."""
    wide = np.abs(np.real(left))
    joints = sorted({motion.owner(row) for row in np.flatnonzero(wide > 0.5 * wide.max()).tolist()})
    lowered, given = motion.lowered, np.where(motion.lowered.stated, motion.lowered.rates, 0.0)
    possible, _, remains, wrong, size = motion.completed(given, rates)
    worst = int(np.argmax(np.abs(np.real(remains))))
    if wrong[0] > _ROUNDING * size[0]:
        return ModelError(
            f"no initial velocities satisfy joint {motion.owner(worst)!r}: {np.abs(np.real(remains[worst])):.3g} "
            "(m/s or rad/s) remain. Check the prescribed motions at the start"
        )
    parts = []
    for body, own, near, mask in zip(motion.bodies, np.real(given), np.real(possible), lowered.stated, strict=True):
        near = np.where(np.abs(near) < 1e-12 * np.abs(near).max(), 0.0, near)
        changed = mask & (np.abs(near - own) > 1e-9 * max(1.0, np.abs(own).max()))
        linear, angular = slice(body.dimension), slice(body.dimension, None)
        for what, unit, part in (("velocity", "m/s", linear), ("angular_velocity", "rad/s", angular)):
            if changed[part].any():
                ours, theirs = _numbers(own[part]), _numbers(near[part])
                parts.append(f"{body.name}.{what} is {ours} {unit} (nearest possible: {theirs})")
    return ModelError(
        f"the stated initial velocities contradict joint {', '.join(map(repr, joints))} by {wide.max():.3g} (m/s or "
        f"rad/s): {', '.join(parts)}. Correct them, or leave out those that follow from the joints"
    )


def _numbers(values: np.ndarray) -> str:
    """Numbers as they are written in a model."""
    numbers = ", ".join(f"{value:.6g}" for value in values)
    return numbers if len(values) == 1 else f"({numbers})"
