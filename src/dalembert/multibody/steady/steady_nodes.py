"""Local coordinates about a steady motion, node by node.

A node moves relative to a frame by a constant twist: its points turn at the rate w about a centre c, which moves at a
constant velocity. The frame turns at the rate W about an axis through o. A local coordinate moves the node and the axis
of its twist together, without the turn: a rotor that spins about its axis gets a new position and a new direction of
that axis, and keeps its rate. So the local coordinates of an axisymmetric rotor have constant equations.

A position p in the frame is o + R (p - o) in the fixed axes, R = exp(W t). With p' and p'' in the frame, velocity and
acceleration are R (p' + W p) and R (p'' + 2 W p' + W W p), p from o on. The same holds for derivatives of p.
"""

from dataclasses import dataclass, field
from typing import NamedTuple

import numpy as np
from scipy.linalg import expm

from dalembert.multibody.components.base_body import ANGLE, DISPLACEMENT, POSITION
from dalembert.multibody.model.lowered import Lowered

_STILL = 1e-9
"""Rate or velocity, as part of the largest one, that counts as none."""


class Frame(NamedTuple):
    """A frame that turns at a constant rate.

    ``rate`` (1,): rad/s, in the fixed axes; ``origin`` (2,): a point of the axis.
    """

    rate: np.ndarray
    origin: np.ndarray


class Motion(NamedTuple):
    """Numbers of some coordinates, or their derivatives by local coordinates, at one time.

    ``q``, ``v``, ``a`` (size,).
    """

    q: np.ndarray
    v: np.ndarray
    a: np.ndarray


def skew(rate: np.ndarray) -> np.ndarray:
    """Return the matrix of the cross product with a rate, (2, 2) for one number and (3, 3) for three."""
    if len(rate) == 1:
        return rate[0] * np.array([[0.0, -1.0], [1.0, 0.0]])
    x, y, z = rate
    return np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])


@dataclass
class SteadyNode:
    """Coordinates that one twist moves. ``position`` (d,): coordinates of a position; ``vectors`` (vectors, d):
    coordinates of vectors that turn with the node; ``scalars``: coordinates that are numbers; ``turns``: whether
    rotations are local coordinates; ``absolute``: whether the numbers are angles against the fixed axes; ``p0``,
    ``s0``: position and numbers at the time 0, in the frame; ``directions`` (vectors, d); ``rate``, ``centre``,
    ``velocity``, ``speeds``: of the twist relative to the frame, and of the numbers.
    """

    position: np.ndarray
    vectors: np.ndarray
    scalars: np.ndarray
    turns: bool
    absolute: bool
    p0: np.ndarray = field(init=False)
    s0: np.ndarray = field(init=False)
    directions: np.ndarray = field(init=False)
    rate: np.ndarray = field(init=False)
    centre: np.ndarray = field(init=False)
    velocity: np.ndarray = field(init=False)
    speeds: np.ndarray = field(init=False)

    @property
    def rates(self) -> int:
        """Number of rotations."""
        d = self.vectors.shape[1]
        return (d * (d - 1) // 2) if self.turns else 0

    @property
    def size(self) -> int:
        """Number of local coordinates: of the position, of vectors that do not turn as one, rotations, numbers."""
        flat = 0 if self.turns else self.vectors.size
        return len(self.position) + flat + self.rates + (0 if self.turns else len(self.scalars))

    @property
    def index(self) -> np.ndarray:
        """All coordinates."""
        return np.concatenate([self.position, self.vectors.ravel(), self.scalars])

    def spin(self, x: np.ndarray, v: np.ndarray) -> np.ndarray:
        """Angular velocity of a node that turns; zeros for others."""
        d = self.vectors.shape[1]
        if not self.turns:
            return np.zeros(1 if d == 2 else 3)
        if d == 2:
            return v[self.scalars].copy()
        return 0.5 * np.cross(x[self.vectors], v[self.vectors]).sum(axis=0)

    def begin(self, frame: Frame, x: np.ndarray, v: np.ndarray) -> float:
        """Take the twist of a state, and return the velocity that the twist does not have."""
        d = self.vectors.shape[1]
        turning = skew(frame.rate)
        self.rate = self.spin(x, v) - frame.rate if self.turns else np.zeros_like(frame.rate)
        if np.abs(self.rate).max() <= _STILL * max(np.abs(frame.rate).max(), np.abs(self.spin(x, v)).max()):
            self.rate = np.zeros_like(self.rate)
        at = x[self.position] - frame.origin if len(self.position) else np.zeros(d)
        drift = v[self.position] - turning @ at if len(self.position) else np.zeros(d)
        own, square = skew(self.rate), float(self.rate @ self.rate)
        # The point of the axis of the twist that is nearest: c - p = w x v / w^2; it moves along the axis.
        away = own @ drift / square if square else np.zeros(d)
        self.p0, self.centre = at, at + away
        self.velocity = drift + own @ away
        self.directions = x[self.vectors]
        wrong = v[self.vectors] - self.directions @ (turning + own).T
        self.s0 = x[self.scalars].copy()
        self.speeds = v[self.scalars] - (frame.rate[0] if self.absolute else 0.0)
        return float(np.abs(wrong).max(initial=0.0))

    def move(self, step: np.ndarray) -> None:
        """Apply a step of the local coordinates to the motion."""
        k = len(self.position)
        shift, step = step[:k], step[k:]
        if not self.turns:
            flat = self.vectors.size
            self.directions = self.directions + step[:flat].reshape(self.directions.shape)
            self.s0 = self.s0 + step[flat:]
            if k:
                self.p0, self.centre = self.p0 + shift, self.centre + shift
            return
        turn = expm(skew(step))
        if k:
            self.p0 = self.centre + shift + turn @ (self.p0 - self.centre)
            self.centre = self.centre + shift
        self.directions = self.directions @ turn.T
        if len(self.rate) == 1:
            self.s0 = self.s0 + step
        else:
            self.rate, self.velocity = turn @ self.rate, turn @ self.velocity

    def at(self, frame: Frame, t: float) -> tuple[Motion, Motion]:
        """Coordinates with velocities and accelerations, (size,), and their derivatives (size, local)."""
        d, own = self.vectors.shape[1], skew(self.rate)
        turn = expm(own * t)
        local, row, k = self.size, 0, len(self.position)
        parts, columns = [], []
        units = [skew(unit) for unit in np.eye(len(self.rate))] if self.turns else []
        if k:
            lever = turn @ (self.p0 - self.centre)
            parts.append((self.centre + self.velocity * t + lever, self.velocity + own @ lever, own @ own @ lever))
            slopes = np.zeros((3, d, local))
            slopes[0, :, :k] = np.eye(d)
            for j, unit in enumerate(units):
                slopes[:, :, k + j] = unit @ lever, unit @ own @ lever, unit @ own @ own @ lever
            columns.append(slopes)
        for number, direction in enumerate(self.directions):
            vector = turn @ direction
            parts.append((vector, own @ vector, own @ own @ vector))
            slopes = np.zeros((3, d, local))
            for j, unit in enumerate(units):
                slopes[:, :, k + j] = unit @ vector, unit @ own @ vector, unit @ own @ own @ vector
            if not self.turns:
                slopes[0, :, k + d * number : k + d * (number + 1)] = np.eye(d)
            columns.append(slopes)
        turned = [_fixed(frame, t, part, origin=bool(k) and n == 0) for n, part in enumerate(parts)]
        moved = [_fixed(frame, t, slopes) for slopes in columns]
        numbers, still = self.s0 + self.speeds * t + (frame.rate[0] * t if self.absolute else 0.0), 0.0 * self.s0
        turned.append(Motion(numbers, self.speeds + (frame.rate[0] if self.absolute else 0.0), still))
        slopes = np.zeros((len(self.scalars), local))
        row = local - len(self.scalars)
        slopes[:, row:] = np.eye(len(self.scalars))
        moved.append(Motion(slopes, 0.0 * slopes, 0.0 * slopes))
        return _stacked(turned), _stacked(moved)

    def turned(self, axis: np.ndarray) -> np.ndarray:
        """Derivative of the local coordinates by a rotation of shapes about a direction, (local, local)."""
        matrix = np.zeros((self.size, self.size))
        d = self.vectors.shape[1]
        unit = skew(axis)
        blocks = self.size - (len(self.scalars) if not self.turns or d == 2 else 0)
        for row in range(0, blocks, d):
            matrix[row : row + d, row : row + d] = unit
        return matrix


def _fixed(frame: Frame, t: float, part: tuple | np.ndarray, origin: bool = False) -> Motion:
    """From the frame to the fixed axes."""
    p, first, second = part
    turning = skew(frame.rate)
    turn = expm(turning * t)
    q = turn @ p
    return Motion(
        q + frame.origin if origin else q,
        turn @ (first + turning @ p),
        turn @ (second + 2.0 * turning @ first + turning @ turning @ p),
    )


def _stacked(parts: list[Motion]) -> Motion:
    return Motion(*(np.concatenate(own) for own in zip(*parts, strict=True)))


def nodes_of(lowered: Lowered) -> list[SteadyNode]:
    """Nodes of all bodies, in the order of their coordinates."""
    found, d = [], lowered.dimension
    none, flat = np.zeros(0, dtype=int), np.zeros((0, d), dtype=int)
    for body in lowered.bodies.values():
        kinds, first = body.coordinate_kinds, lowered.structure.first[body.name]
        index = np.arange(first, first + len(kinds))
        if body.rigid and body.turns:
            vectors = index[d:].reshape(-1, 3) if d == 3 else flat
            found.append(SteadyNode(index[:d], vectors, index[d:] if d == 2 else none, turns=True, absolute=d == 2))
            continue
        k = 0
        while k < len(kinds):
            if kinds[k] == POSITION:
                found.append(SteadyNode(index[k : k + d], flat, none, turns=False, absolute=False))
                k += d
            elif kinds[k] == DISPLACEMENT or len(kinds) - k < d or kinds[k] != kinds[k + d - 1]:
                absolute = d == 2 and kinds[k] == ANGLE
                found.append(SteadyNode(none, flat, index[k : k + 1], turns=False, absolute=absolute))
                k += 1
            else:
                found.append(SteadyNode(none, index[k : k + d][None], none, turns=False, absolute=False))
                k += d
    return found
