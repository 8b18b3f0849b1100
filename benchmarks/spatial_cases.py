"""Rigid mechanisms in space, said once and used by both sides. All bodies start with the fixed axes as their own."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np
from scipy.spatial.transform import Rotation

from benchmarks.cases import Integration

Triple = tuple[float, float, float]
GROUND = -1


@dataclass(frozen=True)
class Solid:
    """A rigid body: mass, inertia tensor about its centre of mass, centre of mass in its axes, initial state."""

    mass: float
    tensor: np.ndarray
    centre: np.ndarray
    position: np.ndarray
    velocity: Triple = (0.0, 0.0, 0.0)
    spin: Triple = (0.0, 0.0, 0.0)


@dataclass(frozen=True)
class Pin:
    """A joint of body ``a`` (or the ground) and body ``b`` at a point of the fixed axes.

    A revolute joint; a spherical one without an axis, a cylindrical one if it ``slides``.
    """

    a: int
    b: int
    point: np.ndarray
    axis: Triple | None = None
    slides: bool = False


@dataclass(frozen=True)
class Mechanism:
    """Bodies and joints; ``tip``, a point of the last body in its axes, is observed and compared until ``compared``."""

    name: str
    bodies: Sequence[Solid]
    joints: Sequence[Pin]
    tip: np.ndarray
    integration: Integration
    gravity: Triple = (0.0, 0.0, -9.81)
    compared: float = 1.0


def heavy_top(step: float = 2e-4) -> Mechanism:
    """The box-like top of Geradin and Cardona, to 1 s."""
    top = Solid(
        15.0, np.diag([0.234375, 0.46875, 0.234375]), np.array([0.0, 1.0, 0.0]), np.zeros(3),
        spin=(0.0, 150.0, -4.61538),
    )  # fmt: skip
    name = f"heavy top, h = {step * 1e3:g} ms"
    return Mechanism(name, [top], [Pin(GROUND, 0, np.zeros(3))], top.centre, _integration(1.0, step))


def double_pendulum() -> Mechanism:
    """Two flat rods, with a spherical and a skew revolute joint."""
    turned = Rotation.from_euler("xy", [0.5, 0.3]).as_matrix()
    sides = np.square([0.05, 0.08, 1.0])
    tensor = turned @ np.diag(np.sum(sides) - sides) @ turned.T / 12
    spin, end = (1.0, 0.2, 0.0), -turned[:, 2]
    upper = Solid(1.0, tensor, end / 2, np.zeros(3), spin=spin)
    lower = Solid(1.0, tensor, end / 2, end, tuple(np.cross(spin, end)), spin)
    joints = [Pin(GROUND, 0, np.zeros(3)), Pin(0, 1, end, tuple(turned @ (1.0, 0.2, 0.1)))]
    return Mechanism("double pendulum", [upper, lower], joints, end, _integration(2.0, 1e-3))


def chain(links: int, end: float = 1.0, compared: float = 0.5) -> Mechanism:
    """Rods in a zigzag from the ground, at rest, with revolute joints about y and z in turn."""
    bodies, joints, at = [], [], np.zeros(3)
    for k in range(links):
        along = np.array([0.2, 0.05 * (-1) ** k, 0.03 * (-1) ** (k // 2)])
        bodies.append(_rod(at, along))
        joints.append(Pin(k - 1, k, at, ((0.0, 1.0, 0.0), (0.0, 0.0, 1.0))[k % 2]))
        at = at + along
    return Mechanism(f"chain of {links}", bodies, joints, _end(bodies[-1]), _integration(end, 1e-3), compared=compared)


def bricard() -> Mechanism:
    """Five rods along edges of a cube (IFToMM library, A04); the sixth joint may slide: no constraint is redundant."""
    corners = np.array([(0, 0, 0), (1, 0, 0), (1, -1, 0), (1, -1, 1), (0, -1, 1), (0, 0, 1)], dtype=float)
    axes = ((0.0, 1.0, 0.0), (0.0, 0.0, 1.0), (1.0, 0.0, 0.0)) * 2
    bodies = [_rod(corner, after - corner) for corner, after in pairwise(corners)]
    joints = [Pin(k - 1, k if k < 5 else GROUND, corners[k], axes[k], slides=k == 5) for k in range(6)]
    return Mechanism(
        "Bricard mechanism", bodies, joints, 0.5 * _end(bodies[-1]), _integration(1.0, 1e-3),
        gravity=(0.0, -9.81, 0.0),
    )  # fmt: skip


def _rod(at: np.ndarray, along: np.ndarray, **state: Triple) -> Solid:
    """A rod of 1 kg from a position, with a little inertia about its axis."""
    tensor = (along @ along * np.eye(3) - np.outer(along, along)) / 12 + 1e-4 * np.eye(3)
    return Solid(1.0, tensor, along / 2, at, **state)


def _end(rod: Solid) -> np.ndarray:
    return 2.0 * rod.centre


def _integration(end: float, step: float) -> Integration:
    return Integration(end=end, step=step, every=max(1, round(end / step / 50)), spectral_radius=0.9)


def scaled(case: Mechanism, factors: Mapping[str, float]) -> Mechanism:
    """A case of two bodies with numbers multiplied by named factors, such as ``{"mass": 1.1, "lower_moment": 0.9}``."""
    by = {**dict.fromkeys(("spin", "gravity"), 1.0), **factors}
    bodies = []
    for prefix, own in zip(("", "lower_"), case.bodies, strict=True):
        mass, moment, centre = (by.get(f"{prefix}{name}", 1.0) for name in ("mass", "moment", "centre"))
        spin, velocity = (tuple(by["spin"] * rate for rate in rates) for rates in (own.spin, own.velocity))
        bodies.append(Solid(mass * own.mass, moment * own.tensor, centre * own.centre, own.position, velocity, spin))
    return replace(case, bodies=bodies, gravity=tuple(by["gravity"] * g for g in case.gravity))
