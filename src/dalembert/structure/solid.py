"""Solids in three dimensions."""

from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from dalembert.arguments import takes_checked
from dalembert.errors import InputError, require_known, shown, unknown
from dalembert.structure.assembly import assemble, library, require_counts, require_lengths
from dalembert.structure.dofs import Dofs
from dalembert.structure.material import Material
from dalembert.structure.mesh_files import read_mesh
from dalembert.structure.nodes import Nodes
from dalembert.structure.structure import Structure

ELEMENTS = {
    "brick 20": ("ElementHexS2", 3, 5),
    "brick 20 full": ("ElementHexS2", 5, 5),
    "brick 27": ("ElementHex2", 5, 5),
    "tetrahedron 10": ("ElementTetP2", 2, 4),
}
"""Kinds of elements: shape functions, and the degrees that the quadratures of stiffness and mass integrate exactly."""

SAME = 1e-9
"""Distance of a node from a point of a file, as part of the structure's size, within which they are the same."""
SIDES = ("left", "right", "front", "back", "bottom", "top")


@takes_checked()
def box(size: Sequence[float], elements: Sequence[int], corner: Sequence[float] = (0.0, 0.0, 0.0)) -> Any:
    """A mesh of bricks for :func:`solid`.

    Parameters
    ----------
    size : (along x, along y, along z)
        m.
    elements : (along x, along y, along z)
        Numbers of bricks.
    corner : (x, y, z)
        m, of the least x, y and z.

    Returns
    -------
    skfem.MeshHex
        With the named boundaries left, right (x), front, back (y), bottom, top (z) and edge (the first four).
    """
    require_lengths("box", "size", size, 3)
    require_counts("box", elements, 3)
    if len(corner) != 3:
        raise InputError(f"box: corner is {shown(corner)}; expected three numbers in m")
    return grid(
        *(
            start + np.linspace(0.0, length, count + 1)
            for start, length, count in zip(corner, size, elements, strict=True)
        )
    )


def grid(x: np.ndarray, y: np.ndarray, z: np.ndarray) -> Any:
    """A mesh of bricks between ascending coordinates, with the named boundaries of :func:`box`."""
    lines = (x, y, z)
    sides = {name: _at(at // 2, lines[at // 2][-(at % 2)]) for at, name in enumerate(SIDES)}
    sides["edge"] = lambda x: np.any([sides[name](x) for name in SIDES[:4]], axis=0)
    return library("skfem", "box").MeshHex.init_tensor(*lines).with_boundaries(sides)


def _at(axis: int, place: float) -> Callable[[np.ndarray], np.ndarray]:
    """Whether points (3, ...) lie where one of their coordinates has a value."""
    return lambda x: np.isclose(x[axis], place, rtol=1e-12, atol=0.0)


@takes_checked()
def solid(mesh: Any, material: Material | Mapping[str, Material], element: str | None = None) -> Structure:
    r"""An elastic solid, of finite elements that are good for thin parts too.

    The energy is :math:`\tfrac12 \int \lambda (\nabla \cdot u)^2 + 2 \mu\, \varepsilon : \varepsilon \,\mathrm{d}V`.
    Bricks of 8 nodes lock in bending (a thin plate comes out 70 % too stiff), so there are none.

    Parameters
    ----------
    mesh : skfem mesh or path
        Hexahedra or tetrahedra, made by :func:`box`, by scikit-fem, or read by meshio from a file (Gmsh, VTK, Abaqus,
        Nastran and others), of first or second order (bricks of 20 and 27 nodes, tetrahedra of 10). Its named
        boundaries become sets of nodes, and so do sets of nodes in the file (``*NSET`` of Abaqus): all nodes at the
        places of theirs.
    material : Material, or mapping of str to Material
        One for all, or one for each named subdomain of the mesh; where subdomains overlap the last one holds.
    element : str, optional
        "brick 20" (the default for hexahedra): serendipity, 2 × 2 × 2 Gauss points for the stiffness, 3 × 3 × 3 for the
        mass. Its eight Gauss points miss some motions of a brick, which neighbours hold; a row of single bricks keeps
        them, without energy, so have two across, or take one of the next ones. "brick 20 full" and "brick 27":
        3 × 3 × 3 points throughout, stiffer in thin parts. "tetrahedron 10" (the default for tetrahedra).

    Returns
    -------
    Structure
        Not held, with sparse matrices; nodes are numbered "0", "1", …, the corners of the elements first.

    Raises
    ------
    DataError
        For a file that is missing or cannot be read.
    InputError
        For an unknown kind of element or one that does not fit the mesh, an unknown subdomain, elements without
        material, flat or folded ones, or if scikit-fem is not installed.

    References
    ----------
    Zienkiewicz, O. C., Taylor, R. L., Too, J. M.: Reduced integration technique in general analysis of plates and
    shells. Int. J. Numer. Meth. Engng 3, 1971.

    Examples
    --------
    >>> bar = solid(box((1.0, 0.1, 0.1), (4, 1, 1)), Material(210e9, 0.3, 7800.0))
    >>> bar.size, float((bar.mass.sum() / 3).round(9))  # kg
    (168, 78.0)
    >>> bar.nodes.nearest((1.0, 0.0, 0.0)) in bar.nodes.members("right")
    True
    """
    skfem = library("skfem", "solid")
    points, sets = np.zeros((0, 3)), {}
    if isinstance(mesh, (str, Path)):
        mesh, points, sets = read_mesh(mesh)
    if not isinstance(mesh, skfem.Mesh):
        raise InputError(f"solid: mesh is {shown(mesh)}; expected a mesh of scikit-fem, such as box(...), or a path")
    kind = element or ("tetrahedron 10" if isinstance(mesh, skfem.MeshTet) else "brick 20")
    require_known("element", kind, ELEMENTS, "solid")
    shape, degree, mass_degree = ELEMENTS[kind]
    shape = getattr(skfem, shape)()
    if shape.refdom is not mesh.refdom:
        raise InputError(
            f"solid: the element {kind!r} does not fit a mesh of {mesh.nelements} {mesh.refdom.name} elements"
        )
    turns = np.sign(mesh.mapping().detDF(mesh.refdom.p))
    bad = np.flatnonzero(np.any((turns != turns[:, :1]) | (turns == 0), axis=1))
    if len(bad):
        raise InputError(f"solid: {len(bad)} elements of the mesh are flat or folded, the first is element {bad[0]}")
    basis = skfem.Basis(mesh, shape, intorder=degree)
    first, second, density = _materials(mesh, material)
    weighing = skfem.Basis(mesh, shape, intorder=mass_degree)
    size = 3 * basis.N
    dofs = (3 * basis.element_dofs.T[:, :, None] + np.arange(3)).reshape(mesh.nelements, -1)
    names = tuple(str(node) for node in range(basis.N))
    places = basis.doflocs.T
    boundaries = {
        name: tuple(map(str, np.unique(basis.get_dofs(facets).all())))
        for name, facets in (mesh.boundaries or {}).items()
    }
    node_sets = {name: _nodes_at(places, points[members]) for name, members in sets.items()}
    return Structure(
        assemble(_mass(weighing, density), dofs, size),
        assemble(_stiffness(basis, first, second), dofs, size),
        Dofs(tuple(f"{name}.{direction}" for name in names for direction in "xyz")),
        nodes=Nodes(
            names, places, boundaries | node_sets, mesh.facets[:, mesh.boundary_facets()].T, basis.element_dofs.T
        ),
    )


def _nodes_at(places: np.ndarray, points: np.ndarray) -> tuple[str, ...]:
    """Names of the nodes at points; points without a node, such as those of other parts of a file, have none."""
    from scipy.spatial import KDTree

    near = SAME * np.ptp(places, axis=0).max()
    near_nodes = KDTree(places).query_ball_point(points, near)
    return tuple(map(str, sorted({node for nodes in near_nodes for node in nodes})))


def _materials(mesh: Any, material: Material | Mapping[str, Material]) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """λ, μ and the density of each element."""
    regions = {"": material} if isinstance(material, Material) else material
    constants = [(*region.lame, region.density) for region in regions.values()]
    table = np.zeros((3, mesh.nelements), dtype=np.result_type(float, *(value for row in constants for value in row)))
    for name, row in zip(regions, constants, strict=True):
        if name and name not in (mesh.subdomains or {}):
            raise InputError(unknown("subdomain", name, mesh.subdomains or {}, "solid"))
        table[:, mesh.subdomains[name] if name else slice(None)] = np.array(row)[:, None]
    bare = np.flatnonzero(table[2] == 0)
    if len(bare):
        raise InputError(
            f"solid: {len(bare)} of the {mesh.nelements} elements of the mesh belong to no subdomain with a material; "
            f"materials are given for {', '.join(regions)}"
        )
    return table[0], table[1], table[2]


def _stiffness(basis: Any, first: np.ndarray, second: np.ndarray) -> np.ndarray:
    """Element matrices (elements, 3 m, 3 m) from λ and μ (elements,)."""
    gradients = np.array([function[0].grad for function in basis.basis])  # (m, 3, elements, points)
    count, _, elements, points = gradients.shape
    flat = gradients.transpose(2, 0, 1, 3).reshape(elements, 3 * count, points)
    # products[e, i, a, j, b] = ∫ ∂_a φ_i ∂_b φ_j
    products = ((flat * basis.dx[:, None]) @ flat.transpose(0, 2, 1)).reshape(elements, count, 3, count, 3)
    first, second = (value.reshape(-1, 1, 1, 1, 1) for value in (first, second))
    local = first * products + second * products.transpose(0, 1, 4, 3, 2)
    laplacian = second[..., 0, 0] * np.einsum("eiaja->eij", products)
    for axis in range(3):
        local[:, :, axis, :, axis] += laplacian
    return local.reshape(elements, 3 * count, 3 * count)


def _mass(basis: Any, density: np.ndarray) -> np.ndarray:
    """Element matrices (elements, 3 m, 3 m)."""
    values = np.array([np.broadcast_to(np.asarray(function[0]), basis.dx.shape) for function in basis.basis])
    flat = values.transpose(1, 0, 2)
    scalar = (flat * (density[:, None] * basis.dx)[:, None]) @ flat.transpose(0, 2, 1)
    return np.einsum("eij,ab->eiajb", scalar, np.eye(3)).reshape(len(scalar), 3 * len(values), 3 * len(values))
