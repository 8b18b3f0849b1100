"""Local coordinates of a mechanism: rotation increments in place of the directors of bodies in space."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from dalembert.multibody.components.base_body import ANGLE, DISPLACEMENT, POSITION
from dalembert.multibody.model.lowered import Lowered

_AXES = "xyz"


@dataclass(frozen=True, eq=False)
class LocalCoordinates:
    """Coordinates without internal constraints, relative to a reference state. The directors of a node are
    d_i = exp([t]x) d_i0, with the rotation increment t (3,) from the directors d_i0 of the reference; its rates are the
    angular velocity w, d_i' = w x d_i. Both are in the fixed axes. All other coordinates are local coordinates
    themselves, so in the plane all are.

    ``names``, ``kinds``: such as ``"bar.x"``, ``"bar.angle"`` and ``"bar.rotation x"``; rotation increments are angles;
    ``coordinates``: number n of coordinates; ``directors`` (nodes, 9): coordinates of the directors; ``rotations``
    (nodes, 3): slots of the rotation increments among the local coordinates; ``inner``: constraints that local
    coordinates satisfy: those of the directors.
    """

    names: tuple[str, ...]
    kinds: tuple[str, ...]
    coordinates: int
    directors: np.ndarray
    rotations: np.ndarray
    inner: np.ndarray

    @classmethod
    def of(cls, lowered: Lowered) -> "LocalCoordinates":
        """Those of a mechanism."""
        structure = lowered.structure
        nodal = [(index, kind.chart.size) for kind, index in structure.index.items() if kind.chart is not None]
        directors = np.concatenate([np.zeros((0, 9), dtype=int), *(index[:, :size] for index, size in nodal)])
        inner = [index[:, size:].ravel() - structure.n for index, size in nodal]
        within, first = set(directors.ravel().tolist()), {int(node[0]): row for row, node in enumerate(directors)}
        owners = [structure.owners[int(node[0])] for node in directors]
        names, kinds, rotations = [], [], np.zeros((len(directors), 3), dtype=int)
        for coordinate, (name, kind) in enumerate(zip(coordinate_names(lowered), structure.kinds, strict=True)):
            if coordinate in first:
                node = first[coordinate]
                number = f" {owners[:node].count(owners[node]) + 1}" if owners.count(owners[node]) > 1 else ""
                rotations[node] = len(names) + np.arange(3)
                names += [f"{owners[node]}.rotation {axis}{number}" for axis in _AXES]
                kinds += [ANGLE] * 3
            elif coordinate not in within:
                names.append(name)
                kinds.append(kind)
        constraints = np.concatenate([np.zeros(0, dtype=int), *inner])
        return cls(tuple(names), tuple(kinds), structure.n, directors, rotations, constraints)

    @cached_property
    def flat(self) -> tuple[np.ndarray, np.ndarray]:
        """Coordinates that are local coordinates, and their places among these."""
        return (
            np.setdiff1d(np.arange(self.coordinates), self.directors),
            np.setdiff1d(np.arange(len(self.names)), self.rotations),
        )

    @property
    def rate_names(self) -> tuple[str, ...]:
        """Names of the rates."""
        turning = set(self.rotations.ravel().tolist())
        return tuple(
            name.replace("rotation", "angular velocity") if place in turning else f"{name} rate"
            for place, name in enumerate(self.names)
        )

    def restored(self, q: np.ndarray) -> np.ndarray:
        """Real coordinates (n,) with the nearest orthonormal directors."""
        q = q.copy()
        for node in self.directors:
            left, _, right = np.linalg.svd(q[node].reshape(3, 3))
            q[node] = (left @ right).ravel()
        return q

    def basis(self, q: np.ndarray) -> np.ndarray:
        """Derivative of the velocities by the rates at coordinates (n,), shape (n, local)."""
        flat, places = self.flat
        basis = np.zeros((self.coordinates, len(self.names)), dtype=q.dtype)
        basis[flat, places] = 1.0
        for node, turn in zip(self.directors, self.rotations, strict=True):
            for axis in range(3):
                basis[node, turn[axis]] = np.cross(np.eye(3)[axis], q[node].reshape(3, 3)).ravel()
        return basis

    def moved(self, q: np.ndarray, local: np.ndarray) -> np.ndarray:
        """Coordinates (n,) at local coordinates (local,) relative to reference coordinates ``q`` (n,)."""
        flat, places = self.flat
        moved = q.astype(np.result_type(q, local))
        moved[flat] = local[places]
        if len(self.directors):
            from dalembert.multibody.components.spatial.orientation import turned

            for node, turn in zip(self.directors, self.rotations, strict=True):
                moved[node] = turned(q[node].reshape(3, 3), local[turn]).ravel()
        return moved

    def slopes(self, q: np.ndarray, local: np.ndarray) -> np.ndarray:
        """Derivative of :meth:`moved` by the local coordinates, shape (n, local)."""
        flat, places = self.flat
        slopes = np.zeros((self.coordinates, len(self.names)))
        slopes[flat, places] = 1.0
        for place in self.rotations.ravel():
            shifted = local.astype(complex)
            shifted[place] += 1e-30j
            slopes[:, place] = np.imag(self.moved(q, shifted)) / 1e-30
        return slopes

    def positions(self, q: np.ndarray, x: np.ndarray) -> np.ndarray:
        """Local coordinates (..., local) of coordinates ``x`` (..., n), relative to reference coordinates (n,)."""
        flat, places = self.flat
        local = np.zeros((*x.shape[:-1], len(self.names)), dtype=x.dtype)
        local[..., places] = x[..., flat]
        for node, turn in zip(self.directors, self.rotations, strict=True):
            local[..., turn] = _increment(q[node].reshape(3, 3), x[..., node].reshape(*x.shape[:-1], 3, 3))
        return local

    def rates(self, x: np.ndarray, v: np.ndarray) -> np.ndarray:
        """Rates (..., local) of coordinates and velocities (..., n): w = sum of d_i x d_i' / 2."""
        flat, places = self.flat
        rates = np.zeros((*x.shape[:-1], len(self.names)), dtype=np.result_type(x, v))
        rates[..., places] = v[..., flat]
        for node, turn in zip(self.directors, self.rotations, strict=True):
            directors, changes = (part[..., node].reshape(*x.shape[:-1], 3, 3) for part in (x, v))
            rates[..., turn] = 0.5 * np.cross(directors, changes).sum(axis=-2)
        return rates


def coordinate_names(lowered: Lowered) -> list[str]:
    """Names of all coordinates: ``"bar.x"``, ``"bar.y"`` and ``"bar.angle"``, numbered in bodies of several nodes."""
    names: list[str] = []
    for body in lowered.bodies.values():
        counts: dict[str, int] = {}
        for kind in body.coordinate_kinds:
            number = counts[kind] = counts.get(kind, -1) + 1
            single = kind in (ANGLE, DISPLACEMENT)
            node, axis = (number, 0) if single else divmod(number, body.dimension)
            what = kind if single else _AXES[axis] if kind == POSITION else f"{kind} {_AXES[axis]}"
            names.append(
                f"{body.name}.{what}" + ("" if body.rigid and (single or kind == POSITION) else f" {node + 1}")
            )
    return names


def _increment(reference: np.ndarray, directors: np.ndarray) -> np.ndarray:
    """Rotation vectors (..., 3) from a reference to directors (..., 3, 3), with angles within [0, pi].

    sin(angle) axis = sum of d_i0 x d_i / 2, and 1 + 2 cos(angle) = sum of d_i0 . d_i.
    """
    across = 0.5 * np.cross(reference, directors).sum(axis=-2)
    cosine = 0.5 * ((reference * directors).sum(axis=(-2, -1)) - 1.0)
    square = (across * across).sum(axis=-1)
    small = (np.real(square) < 1e-9) & (np.real(cosine) > 0.0)
    sine = np.sqrt(np.where(small, 1.0, square) + 1e-300)
    angle = np.arctan2(np.real(sine), np.real(cosine)) + 0.0 * sine
    if np.iscomplexobj(sine):
        slope = np.real(cosine) * np.imag(sine) - np.real(sine) * np.imag(cosine)
        angle = angle + 1j * slope / (np.real(sine) ** 2 + np.real(cosine) ** 2)
    near = 1.0 + square / 6.0 + 3.0 / 40.0 * square * square
    return across * np.where(small, near, angle / sine)[..., None]
