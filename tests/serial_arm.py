"""Torques of serial arms with revolute joints by an independent recursive Newton-Euler algorithm, for many samples."""

from dataclasses import dataclass

import numpy as np

from dalembert.inverse.inertial import parameter_names


@dataclass(frozen=True)
class SerialArm:
    """Each joint turns about z of its frame; rows (roll about x, then x, y, z) place the frame in its parent."""

    frames: tuple[tuple[float, float, float, float], ...]
    gravity: tuple[float, float, float] = (0.0, 0.0, -9.81)
    friction: bool = False

    @property
    def joints(self) -> int:
        return len(self.frames)

    @property
    def links(self) -> tuple[str, ...]:
        return tuple(f"link{k + 1}" for k in range(self.joints))

    @property
    def others(self) -> tuple[str, ...]:
        numbers = ("damping", "friction", "armature") if self.friction else ()
        return tuple(f"joint{k + 1}.{name}" for k in range(self.joints) for name in numbers)

    @property
    def names(self) -> tuple[str, ...]:
        return (*parameter_names(self.links), *self.others)

    def torques(self, ten: np.ndarray, q: np.ndarray, v: np.ndarray, a: np.ndarray) -> np.ndarray:
        """Torques (samples, joints) of links alone, from ten parameters each, (joints, 10)."""
        turns, spin, linear, angular = [], [], [], []
        w = b = np.zeros((len(q), 3))
        x = np.tile(-np.array(self.gravity), (len(q), 1))
        axis = np.array([0.0, 0.0, 1.0])
        for k, (roll, *shift) in enumerate(self.frames):
            turn = _about_x(roll) @ _about_z(q[:, k])  # to the parent
            p = np.array(shift)
            x = _into(turn, x + np.cross(b, p) + np.cross(w, np.cross(w, p)))
            w, b = _into(turn, w), _into(turn, b)
            b = b + a[:, k, None] * axis + np.cross(w, v[:, k, None] * axis)
            w = w + v[:, k, None] * axis
            turns.append(turn), spin.append(w), angular.append(b), linear.append(x)
        found = np.empty(q.shape)
        force = moment = np.zeros((len(q), 3))
        for k in range(self.joints - 1, -1, -1):
            m, h, (xx, yy, zz, xy, xz, yz) = ten[k, 0], ten[k, 1:4], ten[k, 4:]
            tensor = np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])
            w, b, x = spin[k], angular[k], linear[k]
            own = m * x + np.cross(b, h) + np.cross(w, np.cross(w, h))
            turning = b @ tensor + np.cross(w, w @ tensor) + np.cross(h, x)
            if k + 1 < self.joints:
                out, p = turns[k + 1], np.array(self.frames[k + 1][1:])
                force, moment = np.einsum("sij,sj->si", out, force), np.einsum("sij,sj->si", out, moment)
                moment = moment + np.cross(p, force)
            force, moment = force + own, moment + turning
            found[:, k] = moment[:, 2]
        return found

    def regressor(self, q: np.ndarray, v: np.ndarray, a: np.ndarray) -> np.ndarray:
        """Columns (samples, joints, parameters), one by one from unit parameters."""
        columns = [self.torques(unit.reshape(-1, 10), q, v, a) for unit in np.eye(10 * self.joints)]
        found = np.stack(columns, axis=-1)
        if self.friction:
            own = np.stack([v, np.tanh(v / 1e-3), a], axis=-1)
            others = np.einsum("sjn,jk->sjkn", own, np.eye(self.joints)).reshape(*q.shape, -1)
            found = np.concatenate([found, others], axis=-1)
        return found


PLANAR = SerialArm(((np.pi / 2, 0.0, 0.0, 0.0), (0.0, 0.4, 0.0, 0.0)))
"""Two links in the vertical plane; the second joint is 0.4 m from the first."""

SIX = SerialArm(
    (
        (0.0, 0.0, 0.0, 0.3),
        (-np.pi / 2, 0.1, 0.05, 0.0),
        (np.pi / 2 - 0.3, 0.4, 0.02, -0.03),
        (-np.pi / 2, 0.03, 0.35, 0.01),
        (np.pi / 2, 0.02, 0.01, 0.0),
        (-np.pi / 2, 0.01, 0.08, 0.02),
    ),
    friction=True,
)
"""Six links in general position, the first axis vertical."""

THREE = SerialArm(SIX.frames[:3], friction=True)


def bodies(count: int, seed: int = 0) -> np.ndarray:
    """Inertial parameters (count, 10) of bodies that exist: clouds of point masses."""
    rng = np.random.default_rng(seed)
    found = []
    for k in range(count):
        masses = rng.uniform(0.2, 1.0, 8) * 4.0 / (k + 1.0)
        points = rng.normal(0.0, [0.06, 0.08, 0.1], (8, 3)) + rng.uniform(-0.05, 0.1, 3)
        second = np.einsum("n,ni,nj->ij", masses, points, points)
        tensor = np.trace(second) * np.eye(3) - second
        six = (*np.diagonal(tensor), tensor[0, 1], tensor[0, 2], tensor[1, 2])
        found.append([masses.sum(), *(masses @ points), *six])
    return np.array(found)


def truth(arm: SerialArm, seed: int = 0) -> np.ndarray:
    """True parameters of an arm."""
    others = [0.4, 0.6, 0.08] * arm.joints if arm.friction else []
    return np.concatenate([bodies(arm.joints, seed).ravel(), others])


def wrong(values: np.ndarray, links: int, by: float, seed: int) -> np.ndarray:
    """Consistent parameters that differ from given ones: each link scaled and turned by a random factor near 1."""
    from dalembert.inverse.inertial.log_cholesky import parameters_of_factor, upper_factor

    rng = np.random.default_rng(seed)
    own = upper_factor(values[: 10 * links].reshape(-1, 10))
    moved = own @ (np.eye(4) + by * np.triu(rng.uniform(-1.0, 1.0, (links, 4, 4))))
    others = values[10 * links :] * rng.uniform(1 - by, 1 + by, len(values) - 10 * links)
    return np.concatenate([parameters_of_factor(moved).ravel(), others])


def swinging(joints: int, seed: int, samples: int = 200, end: float = 10.0) -> tuple[np.ndarray, ...]:
    """Times and a smooth random motion (samples, joints): positions, velocities, accelerations."""
    rng, times = np.random.default_rng(seed), np.linspace(0.0, end, samples, endpoint=False)
    rates = 2 * np.pi * np.arange(1, 6) / end
    sizes, phases = rng.uniform(0.2, 0.5, (joints, 5)), rng.uniform(0, 2 * np.pi, (joints, 5))
    angles = rates * times[:, None, None] + phases
    return (
        times,
        np.sum(sizes * np.sin(angles), axis=-1),
        np.sum(sizes * rates * np.cos(angles), axis=-1),
        -np.sum(sizes * rates**2 * np.sin(angles), axis=-1),
    )


def _into(turn: np.ndarray, vectors: np.ndarray) -> np.ndarray:
    return np.einsum("sji,sj->si", turn, vectors)


def _about_x(angle: float) -> np.ndarray:
    c, s = np.cos(angle), np.sin(angle)
    return np.array([[1.0, 0.0, 0.0], [0.0, c, -s], [0.0, s, c]])


def _about_z(angles: np.ndarray) -> np.ndarray:
    c, s, o = np.cos(angles), np.sin(angles), np.zeros_like(angles)
    return np.moveaxis(np.array([[c, -s, o], [s, c, o], [o, o, o + 1.0]]), -1, 0)
