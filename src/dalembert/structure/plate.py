"""Thin rectangular plates in bending."""

from collections.abc import Sequence
from typing import Any

import numpy as np
from scipy.sparse import csc_array

from dalembert.arguments import takes_checked
from dalembert.errors import InputError
from dalembert.structure.assembly import assemble, library, require_counts, require_lengths
from dalembert.structure.dofs import Dofs
from dalembert.structure.material import Material
from dalembert.structure.nodes import Nodes
from dalembert.structure.structure import Structure

DIRECTIONS = ("z", "rx", "ry", "rxy")


@takes_checked("thickness")
def plate(size: Sequence[float], thickness: Any, material: Material, elements: Sequence[int] = (20, 20)) -> Structure:
    r"""A rectangular plate in the plane of x and y by Kirchhoff's theory, of Bogner–Fox–Schmit elements.

    The bending energy is
    :math:`\tfrac{D}{2} \int (1 - \nu)\, \nabla\nabla w : \nabla\nabla w + \nu\, (\Delta w)^2 \,\mathrm{d}A` with
    :math:`D = E h^3 / (12 (1 - \nu^2))`; the mass is that of the deflection. The elements conform and are bicubic, so
    that frequencies converge from above with the fourth power of the element's size. A node has the deflection z, the
    rotations :math:`r_x = \partial w / \partial y` and :math:`r_y = -\partial w / \partial x`, and the twist
    :math:`r_{xy} = \partial^2 w / \partial x \partial y`.

    Parameters
    ----------
    size : (length along x, length along y)
        m; one corner is the origin.
    thickness : float
        m; may be complex, with a complex step as its imaginary part.
    material : Material
    elements : (along x, along y)

    Returns
    -------
    Structure
        Not held; with the sets of nodes left, right (x), front, back (y) and edge (all of these). ``.fixed("edge")``
        clamps it all round.

    Raises
    ------
    InputError
        For lengths, a thickness or numbers of elements that are not positive, or if scikit-fem is not installed.

    References
    ----------
    Bogner, F. K., Fox, R. L., Schmit, L. A.: The generation of inter-element-compatible stiffness and mass matrices by
    the use of interpolation formulas. Proc. Conf. Matrix Methods in Structural Mechanics, 1965.

    Examples
    --------
    >>> from dalembert.structure import eigenmodes
    >>> steel = plate((1.0, 1.0), 0.01, Material(210e9, 0.3, 7800.0), elements=(6, 6)).fixed("edge")
    >>> float(eigenmodes(steel, 1).frequencies[0].round(2))
    89.97
    """
    if not thickness.real > 0:
        raise InputError(f"plate: thickness is {thickness} m; expected a positive number")
    require_lengths("plate", "size", size, 2)
    require_counts("plate", elements, 2)
    skfem = library("skfem", "plate")
    lines = [np.linspace(0.0, length, count + 1) for length, count in zip(size, elements, strict=True)]
    mesh = skfem.MeshQuad.init_tensor(*lines)
    basis = skfem.Basis(mesh, skfem.ElementQuadBFS(), intorder=6)
    values = np.array([np.asarray(function[0]) for function in basis.basis])
    curvatures = np.array([function[0].hess for function in basis.basis])
    laplacians = curvatures[:, 0, 0] + curvatures[:, 1, 1]
    ratio, weights = material.poisson_ratio, basis.dx
    rigidity = material.youngs_modulus * thickness**3 / (12 * (1 - ratio**2))

    def total(first: np.ndarray) -> csc_array:
        local = np.einsum("i...eq,j...eq,eq->eij", first, first, weights, optimize=True)
        return assemble(local, basis.element_dofs.T, basis.N)

    stiffness = rigidity * ((1 - ratio) * total(curvatures) + ratio * total(laplacians))
    mass = material.density * thickness * total(values)
    # A node's w, w_x, w_y, w_xy become z, rx = w_y, ry = -w_x, rxy.
    order = basis.nodal_dofs[[0, 2, 1, 3]].T.ravel()
    turn = csc_array(
        (np.tile([1.0, 1.0, -1.0, 1.0], mesh.nvertices), (order, np.arange(basis.N))), shape=(basis.N, basis.N)
    )
    names = tuple(str(node) for node in range(mesh.nvertices))
    return Structure(
        turn.T @ mass @ turn,
        turn.T @ stiffness @ turn,
        Dofs(tuple(f"{name}.{direction}" for name in names for direction in DIRECTIONS)),
        nodes=Nodes(names, np.vstack([mesh.p, np.zeros(mesh.nvertices)]).T, _edges(mesh.p, size), mesh.t.T),
    )


def _edges(places: np.ndarray, size: Sequence[float]) -> dict[str, tuple[str, ...]]:
    """Names of the nodes on the four edges; places come from linspace, whose ends are exact."""
    on = {
        "left": places[0] == 0,
        "right": places[0] == size[0],
        "front": places[1] == 0,
        "back": places[1] == size[1],
    }
    on["edge"] = np.any(list(on.values()), axis=0)
    return {name: tuple(map(str, np.flatnonzero(where))) for name, where in on.items()}
