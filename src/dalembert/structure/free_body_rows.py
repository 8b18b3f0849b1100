"""Degrees of freedom of a free body: rigid motions, mass properties, and integrals of shapes over the mass."""

from typing import NamedTuple

import numpy as np

from dalembert.errors import InputError
from dalembert.structure.eigenmodes import real_part
from dalembert.structure.structure import Structure, known_nodes

ROUNDING = 1e-7
"""Largest force of a rigid motion, as part of that of its entries alone, that counts as none."""
DIRECTIONS = ("x", "y", "z", "rx", "ry", "rz")
MOTIONS = (
    "a displacement along x", "a displacement along y", "a displacement along z", "a rotation about x",
    "a rotation about y", "a rotation about z",
)  # fmt: skip


class Rows(NamedTuple):
    """Degrees of freedom: place (n, 3) and number (n,) of the node of each, number of its axis (n,), and whether it is
    a displacement (n,).
    """

    places: np.ndarray
    nodes: np.ndarray
    axes: np.ndarray
    translations: np.ndarray

    def about(self, centre: np.ndarray) -> "Rows":
        """The same with places from another point."""
        return self._replace(places=self.places - centre)

    @property
    def rigid(self) -> np.ndarray:
        """The motion of all rows by rigid displacements and rotations, (n, 6)."""
        motions = np.zeros((len(self.axes), 6))
        motions[np.arange(len(self.axes)), self.axes + 3 * ~self.translations] = 1.0
        motions[:, 3:] += self.turned(self.places)
        return motions

    def turned(self, vectors: np.ndarray) -> np.ndarray:
        """What unit rotations of vectors (n, 3), one for each row, move it by, (n, 3): zero for rotations."""
        turned = np.cross(np.eye(3)[:, None], vectors[None])[:, np.arange(len(vectors)), self.axes]
        return np.where(self.translations, turned, 0.0).T


def rows_of(structure: Structure) -> Rows:
    """The degrees of freedom of a structure; refuse those that a free body does not have."""
    nodes, names = known_nodes(structure, "free_body_modes"), structure.dofs.names
    directions = [name.rpartition(".")[2] for name in names]
    for name, direction in zip(names, directions, strict=True):
        if direction not in DIRECTIONS:
            raise InputError(
                f"free_body_modes: the structure has the degree of freedom {name!r}; a free body moves by "
                "displacements x, y, z and rotations rx, ry, rz. Use a mesh of solid elements"
            )
    numbers = nodes.rows([name.rpartition(".")[0] for name in names])
    places = np.array([DIRECTIONS.index(direction) for direction in directions])
    return Rows(nodes.places[numbers], numbers, places % 3, places < 3)


def mass_properties(structure: Structure, rows: Rows) -> tuple[np.ndarray, np.ndarray]:
    """Centre of mass (3,), and the pseudo-inertia (4, 4) about it."""
    rigid = rows.rigid
    matrix = rigid.T @ (structure.mass @ rigid)
    masses = np.real(np.diagonal(matrix)[:3])
    if not np.all(masses > 0) or np.ptp(masses) > ROUNDING * masses.max():
        raise InputError(
            f"free_body_modes: the mass of the structure is {', '.join(f'{mass:.6g}' for mass in masses)} kg along x, "
            "y and z; expected the same positive mass along all of them. Use a structure that moves in space"
        )
    centre = _static_moments(np.real(matrix)) / masses[0]
    rigid = rows.about(centre).rigid
    matrix = rigid.T @ (structure.mass @ rigid)
    moments, inertia = _static_moments(matrix), matrix[3:, 3:]
    second = 0.5 * np.trace(inertia) * np.eye(3) - inertia
    return centre, np.block([[matrix[:1, :1], moments[None]], [moments[:, None], second]])


def _static_moments(matrix: np.ndarray) -> np.ndarray:
    """Mass times the place of its centre, from the matrix (6, 6): its upper right block is that of v . (w x m c)."""
    block = matrix[:3, 3:]
    return 0.5 * np.array([block[1, 2] - block[2, 1], block[2, 0] - block[0, 2], block[0, 1] - block[1, 0]])


def require_free(structure: Structure, rows: Rows) -> None:
    """Refuse a structure that a rigid motion strains."""
    stiffness = real_part(structure.stiffness)
    for motion, column in zip(MOTIONS, rows.rigid.T, strict=True):
        force, size = np.abs(stiffness @ column).max(), (abs(stiffness) @ np.abs(column)).max()
        if force > ROUNDING * size:
            raise InputError(
                f"free_body_modes: {motion} strains the structure; expected a free one. Leave out clamps and springs "
                "to the ground, and check the places of the nodes"
            )


def node_shapes(rows: Rows, motion: np.ndarray, count: int) -> np.ndarray:
    """Displacements of nodes, (nodes, 3, modes)."""
    shapes, moved = np.zeros((count, 3, motion.shape[1])), rows.translations
    shapes[rows.nodes[moved], rows.axes[moved]] = motion[moved]
    return shapes


def integrals(structure: Structure, rows: Rows, motion: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Integrals of the places and the shapes over the mass, (4, 3, modes) and (3, 3, modes, modes).

    For w and W, a and b any two of them as fields, the matrix of (w x a) . (W x b) is B = tr(A) 1 - A^T with A the
    integral of a_i b_j, so that A = (tr(B) / 2 1 - B)^T. This holds for any mass matrix, also that of elements with
    rotations, whose antisymmetric part of A follows from the angular momentum.
    """
    modes, rigid = motion.shape[1], rows.rigid
    shapes = node_shapes(rows, motion, int(rows.nodes.max()) + 1)[rows.nodes]
    turned = np.stack([rows.turned(shape) for shape in np.moveaxis(shapes, 2, 0)], axis=-1)
    flat = turned.reshape(len(turned), -1)
    weighed = structure.mass @ np.hstack([rigid, flat])
    momenta = weighed[:, :6].T @ motion
    products = weighed[:, 3:].T @ flat
    linear = _products(products[:3].reshape(3, 3, modes))
    # Momentum and angular momentum of the modes: zero in mean axes, but for directions of derivatives.
    spin = momenta[3:]
    across = np.zeros((3, 3, modes), spin.dtype)
    for i, j, k in ((0, 1, 2), (1, 2, 0), (2, 0, 1)):
        across[i, j], across[j, i] = 0.5 * spin[k], -0.5 * spin[k]
    symmetric = 0.5 * (linear + linear.transpose(1, 0, 2))
    first = np.concatenate([momenta[None, :3], symmetric + across])
    second = _products(products[3:].reshape(3, modes, 3, modes).transpose(0, 2, 1, 3))
    return first, second


def _products(turning: np.ndarray) -> np.ndarray:
    """Integrals A_ij of a_i b_j from those of turned fields, (3, 3, ...)."""
    trace = np.einsum("ii...->...", turning)
    unit = np.eye(3).reshape(3, 3, *(1,) * (turning.ndim - 2))
    return (0.5 * trace * unit - turning).swapaxes(0, 1)
