"""Modes of a free body with interface nodes, and the integrals of its mass that large rotations need."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Any

import numpy as np
from scipy.linalg import eigh, null_space

from dalembert.arguments import array_of, is_number, takes_checked
from dalembert.errors import InputError, SolveError, shown
from dalembert.structure.craig_bampton import held_basis, kept_basis
from dalembert.structure.eigenmodes import EigenModes, eigenmodes
from dalembert.structure.free_body_rows import Rows, integrals, mass_properties, node_shapes, require_free, rows_of
from dalembert.structure.interface_nodes import (
    InterfaceNode,
    Tie,
    rigid_coordinates,
    rigid_motion,
    tied,
    ties_of,
)
from dalembert.structure.structure import Structure, changed, known_nodes
from dalembert.structure.surface_strains import surface_strains

DEPENDENT = 1e-10
"""Part of a motion's energies that other motions leave, below which it counts as one of theirs."""
LOOSE = 1e-14
"""Square of a frequency, as part of that of the highest mode, that counts as that of a free motion."""


@dataclass(frozen=True, eq=False)
class FreeBodyModes:
    r"""Modes of a free body with interface nodes; :func:`free_body_modes` makes them.

    A point of the body at the place s from the centre of mass moves by :math:`\Phi(s) \eta` relative to axes that
    float with it. These are the mean axes of Tisserand: the modes have no momentum and no angular momentum about the
    centre of mass.

    Parameters
    ----------
    pseudo_inertia : array, shape (4, 4)
        :math:`\int z z^T \mathrm{d}m` with :math:`z = (1, s)`, in kg, kg m and kg m².
    first : array, shape (4, 3, modes)
        :math:`\int z_i \Phi_{ja} \mathrm{d}m`.
    second : array, shape (3, 3, modes, modes)
        :math:`\int \Phi_{ia} \Phi_{jb} \mathrm{d}m`.
    mass, stiffness, damping : array, shape (modes, modes)
        Of the modal coordinates :math:`\eta`, which are displacements, m: the largest of a mode along an axis is 1.
    names : tuple of str
        Of the interface nodes.
    interface_places : array, shape (interface nodes, 3)
        From the centre of mass, m.
    interface_shapes : array, shape (interface nodes, 6, modes)
        Displacements and rotations of the interface nodes.
    centre : array, shape (3,)
        Centre of mass in the axes of the structure, m.
    places : array, shape (nodes, 3)
        Nodes of the structure from the centre of mass, m.
    shapes : array, shape (nodes, 3, modes)
        Displacements of these nodes.
    faces : array of int, shape (faces, 3 or 4)
        Rows of ``places``, to draw the body; none where the structure has none.
    recovery : mapping of str to array, shape (modes,)
        Strains, stresses and other quantities by the modal coordinates, for sensors.
    strains : array, shape (nodes of faces, 6, modes), optional
        Strains xx, yy, zz, yz, zx, xy of each mode, 1/m, at the nodes of ``faces`` in ascending order, for drawings.
        Shears are half of the changed angles. A node has the mean of its elements. None without a mesh of solids.
    """

    pseudo_inertia: np.ndarray
    first: np.ndarray
    second: np.ndarray
    mass: np.ndarray
    stiffness: np.ndarray
    damping: np.ndarray
    names: tuple[str, ...]
    interface_places: np.ndarray
    interface_shapes: np.ndarray
    centre: np.ndarray
    places: np.ndarray
    shapes: np.ndarray
    faces: np.ndarray
    recovery: Mapping[str, np.ndarray] = field(default_factory=dict)
    strains: np.ndarray | None = None

    IN_WORDS = "FreeBodyModes, such as free_body_modes(structure, {'end': 'right'})"

    @property
    def count(self) -> int:
        """Number of modes."""
        return len(self.mass)

    @cached_property
    def frequencies(self) -> np.ndarray:
        """Natural frequencies of the free body, Hz, ascending."""
        return _frequencies(np.real(self.mass), np.real(self.stiffness))

    @cached_property
    def clamped_frequency(self) -> float:
        """Lowest natural frequency with one interface node clamped, Hz."""
        pseudo, modes = np.real(self.pseudo_inertia), self.count
        mass, stiffness = np.zeros((2, 6 + modes, 6 + modes))
        mass[:3, :3] = pseudo[0, 0] * np.eye(3)
        mass[3:6, 3:6] = np.trace(pseudo[1:, 1:]) * np.eye(3) - pseudo[1:, 1:]
        mass[6:, 6:], stiffness[6:, 6:] = np.real(self.mass), np.real(self.stiffness)
        lowest = []
        for place, shapes in zip(self.interface_places, self.interface_shapes, strict=True):
            free = null_space(np.hstack([rigid_motion(place), shapes]))
            lowest.append(_frequencies(free.T @ mass @ free, free.T @ stiffness @ free)[0])
        return float(min(lowest))

    def scaled(self, stiffness: complex = 1.0, mass: complex = 1.0) -> "FreeBodyModes":
        """The modes of a body whose stiffness and mass are multiplied by factors.

        A homogeneous body of another Young's modulus or density has the same shapes, so that the reduction need not
        be repeated. The damping stays, and so does ``recovery``: rows of stresses are to be multiplied by the factor of
        the stiffness.

        Parameters
        ----------
        stiffness, mass : float
            Positive.

        Raises
        ------
        InputError
            For a factor that is not positive.
        """
        for name, factor in (("stiffness", stiffness), ("mass", mass)):
            if not is_number(factor) or not np.real(factor) > 0:
                raise InputError(f"scaled: {name} is {shown(factor)}; expected a positive factor")
        return replace(
            self,
            pseudo_inertia=mass * self.pseudo_inertia,
            first=mass * self.first,
            second=mass * self.second,
            mass=mass * self.mass,
            stiffness=stiffness * self.stiffness,
        )


@takes_checked()
def free_body_modes(
    structure: Structure,
    interfaces: Mapping[str, InterfaceNode | str | Sequence[str]],
    modes: int = 12,
    recovery: Mapping[str, Any] | None = None,
) -> FreeBodyModes:
    r"""Reduce a free structure to its interface nodes and its lowest modes, for large rotations.

    The static shapes of the six coordinates of each interface node are those of Craig and Bampton. Of ``modes``, half
    are the lowest modes with these nodes held, and half the lowest modes of the free body. Without the six rigid
    motions, I interface nodes give at most 6 I - 6 + ``modes`` modes.

    Parameters
    ----------
    structure : Structure
        Free, with displacements x, y and z of nodes, perhaps with rotations, and with the places of the nodes.
    interfaces : mapping of str to InterfaceNode
        Where joints, loads and sensors attach; nodes or sets of nodes alone mean an InterfaceNode at their mean place.
    modes : int
        Number of modes beside the static shapes.
    recovery : mapping of str to array or mapping, optional
        Quantities that sensors read, each a linear combination of the displacements: a row (n,), or factors by degrees
        of freedom, such as those of :func:`strain_between`.

    Returns
    -------
    FreeBodyModes

    Raises
    ------
    InputError
        For a structure that is held or has other unknowns than displacements and rotations, for interface nodes that
        share nodes of the structure or whose nodes lie on a line, and for hysteretic damping.
    SolveError
        If a part of the structure moves freely while the interface nodes are held.

    References
    ----------
    Craig, R. R., Bampton, M. C. C.: Coupling of substructures for dynamic analyses. AIAA J. 6(7), 1968. Shabana, A. A.:
    Dynamics of Multibody Systems, 5th ed., Cambridge University Press, 2020.

    Examples
    --------
    >>> from dalembert.structure import Material, box, solid
    >>> bar = solid(box((0.4, 0.02, 0.03), (8, 2, 2)), Material(210e9, 0.3, 7800.0))
    >>> body = free_body_modes(bar, {"foot": "left", "tip": "right"}, modes=4)
    >>> body.count, body.names, round(float(body.pseudo_inertia[0, 0]), 9)
    (10, ('foot', 'tip'), 1.872)
    """
    nodes = known_nodes(structure, "free_body_modes")
    if structure.loss is not None:
        raise InputError(
            "free_body_modes: the structure has hysteretic damping, which motions in time do not have. Give it "
            "viscous damping: with_damping(Rayleigh(...))"
        )
    if structure.rotates:
        raise InputError(
            "free_body_modes: the structure has gyroscopic or circulatory parts. A body that moves in space has them "
            "by its motion; leave them out"
        )
    if modes < 1:
        raise InputError(f"free_body_modes: modes is {modes}; expected 1 or more")
    if not interfaces:
        raise InputError(
            "free_body_modes: there are no interface nodes; expected at least one, such as {'end': InterfaceNode('A')}"
        )
    stated = {
        name: entry if isinstance(entry, InterfaceNode) else InterfaceNode(entry) for name, entry in interfaces.items()
    }
    rows = rows_of(structure)
    centre, pseudo = mass_properties(structure, rows)
    rows = rows.about(centre)
    require_free(structure, rows)
    ties = ties_of(structure, stated, rows, centre)
    motion = kept_basis(lambda: _shapes(structure, rows, ties, modes))
    first, second = integrals(structure, rows, motion)
    reduced = changed(structure, lambda matrix: motion.T @ (matrix @ motion))
    interface_shapes = [np.linalg.lstsq(tie.motion, motion[tie.rows], rcond=None)[0] for tie in ties]
    node_motion = node_shapes(rows, motion, len(nodes.names))
    return FreeBodyModes(
        pseudo_inertia=pseudo,
        first=first,
        second=second,
        mass=reduced["mass"],
        stiffness=reduced["stiffness"],
        damping=reduced.get("damping", np.zeros(reduced["mass"].shape)),
        names=tuple(stated),
        interface_places=np.array([tie.place for tie in ties]),
        interface_shapes=np.array(interface_shapes),
        centre=centre,
        places=nodes.places - centre,
        shapes=node_motion,
        faces=np.zeros((0, 3), dtype=int) if nodes.faces is None else nodes.faces,
        recovery={name: _row(structure, name, entry) @ motion for name, entry in (recovery or {}).items()},
        strains=surface_strains(nodes, node_motion),
    )


def strain_between(structure: Structure, first: str, second: str) -> dict[str, float]:
    """Return the factors of the strain between two nodes: their displacement apart over their distance.

    Parameters
    ----------
    structure : Structure
        With nodes.
    first, second : str
        Nodes with displacements x, y and z.

    Raises
    ------
    InputError
        For unknown nodes, and nodes at one place.
    """
    nodes = known_nodes(structure, "strain_between")
    start, end = nodes.places[nodes.rows([first, second])]
    distance = float(np.linalg.norm(end - start))
    if distance == 0.0:
        raise InputError(f"strain_between: the nodes {first!r} and {second!r} are at one place; expected two places")
    direction = (end - start) / distance**2
    factors = {f"{second}.{axis}": float(part) for axis, part in zip("xyz", direction, strict=True) if part}
    return factors | {f"{first}.{name.rpartition('.')[2]}": -part for name, part in factors.items()}


def _row(structure: Structure, name: str, entry: Any) -> np.ndarray:
    """A row of a recovery matrix, (n,)."""
    if not isinstance(entry, Mapping):
        row = array_of(entry)
        if row.shape != (structure.size,):
            raise InputError(
                f"free_body_modes: recovery {name!r} has the shape {row.shape}; expected {(structure.size,)}, a factor "
                "for each degree of freedom, or a mapping from degrees of freedom to factors"
            )
        return row
    row = np.zeros(structure.size)
    for dof, factor in entry.items():
        if not is_number(factor) or np.iscomplexobj(factor):
            raise InputError(
                f"free_body_modes: recovery {name!r} has the factor {shown(factor)} for {dof!r}; expected a real number"
            )
        row[structure.dofs.index(dof, f"free_body_modes: recovery {name!r}")] += factor
    return row


def _frequencies(mass: np.ndarray, stiffness: np.ndarray) -> np.ndarray:
    """Natural frequencies, Hz, ascending."""
    return np.sqrt(np.clip(eigh(stiffness, mass, eigvals_only=True), 0.0, None)) / (2 * np.pi)


def _shapes(structure: Structure, rows: Rows, ties: Sequence[Tie], modes: int) -> np.ndarray:
    """Motions of all rows by the modes of the free body, (n, modes), with a largest displacement of 1."""
    length = float(np.ptp(rows.places, axis=0).max())
    whole, spread = tied(structure, ties, length)
    mass, stiffness = whole.mass, whole.stiffness
    inner, masters = np.split(np.arange(whole.size), [-6 * len(ties)])  # interface nodes stand last
    try:
        held = held_basis(whole, masters, inner, min(modes - modes // 2, len(inner)))
    except SolveError:
        raise SolveError(
            "free_body_modes: the structure can move without strains while its interface nodes are held: a part is "
            "loose, or elements have motions without energy, as a row of single bricks has. Connect the part, or take "
            'two bricks across or element="brick 27"'
        ) from None
    rigid = held @ rigid_coordinates(ties, held.shape[1], length)
    # The lowest modes of the free body: rigid ones are among them, and those above a low shift are the lowest elastic.
    estimate = _elastic_modes(held, mass, stiffness, rigid).frequencies[0]
    free = eigenmodes(whole, min(6 + modes // 2, whole.size), 0.05 * estimate).shapes
    # Both sets of modes: those of the free body alone miss what is held at its nodes, and the others what swings
    # freely. Six of each were as exact as twelve of the kind that suits best.
    mixed = _independent(np.hstack([held, free]), mass + stiffness / (2 * np.pi * estimate) ** 2)
    motion = spread @ _elastic_modes(mixed, mass, stiffness, rigid).shapes
    # Rotations count by the displacement that they make over the body: modes of torsion may have no other.
    sizes = np.abs(motion) * np.where(rows.translations, 1.0, length)[:, None]
    # The sign is that of the first row of nearly the largest motion, so that symmetric modes keep theirs.
    first = np.argmax(np.abs(motion) > 0.999 * np.abs(motion).max(axis=0), axis=0)
    return motion / (sizes.max(axis=0) * np.sign(motion[first, np.arange(len(first))]))


def _independent(motions: np.ndarray, metric: Any) -> np.ndarray:
    """A basis of the motions (n, -), orthonormal by a metric (n, n), without what depends on the others."""
    # The metric has the strain energy too: by the mass alone, motions of light soft parts would count as none.
    product = motions.T @ (metric @ motions)
    scale = np.sqrt(np.diagonal(product))
    sizes, axes = eigh(product / np.outer(scale, scale))
    kept = sizes > DEPENDENT
    return motions / scale @ (axes[:, kept] / np.sqrt(sizes[kept]))


def _elastic_modes(basis: np.ndarray, mass: Any, stiffness: Any, rigid: np.ndarray) -> EigenModes:
    """Modes without momentum in the span of a basis (n, -) that has the rigid motions (n, 6): shapes (n, - - 6)."""
    # The mass projects rigid motions out, not a limit of the frequency: the axes are mean axes to rounding, and modes
    # of low frequencies stay.
    basis = basis / np.sqrt(np.einsum("ij,ij->j", basis, mass @ basis))  # displacements and rotations alike
    momenta = (mass @ rigid).T @ basis
    others = basis @ null_space(momenta / np.linalg.norm(momenta, axis=1)[:, None])
    squares, shapes = eigh(others.T @ (stiffness @ others), others.T @ (mass @ others))
    if squares[0] <= LOOSE * squares[-1]:
        raise InputError(
            "free_body_modes: a part of the structure moves freely against the others; expected one connected body"
        )
    return EigenModes(np.sqrt(squares) / (2 * np.pi), others @ shapes)
