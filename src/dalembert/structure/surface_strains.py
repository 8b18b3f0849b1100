"""Strains at the surface of a solid of finite elements, by the displacements of its nodes."""

import numpy as np
from scipy.sparse import coo_array, csr_array

from dalembert.structure.assembly import library
from dalembert.structure.nodes import Nodes

KINDS = {
    10: ("ElementTetP2", "ElementTetP1", 2),
    20: ("ElementHexS2", "ElementHex1", 3),
    27: ("ElementHex2", "ElementHex1", 3),
}
"""By the nodes of an element: its shape functions, those of its corners, and the degree of a quadrature with as many
points as corners, where strains are most accurate."""
SHEARS = ((1, 2), (2, 0), (0, 1))


def surface_strains(nodes: Nodes, shapes: np.ndarray) -> np.ndarray | None:
    r"""Return the strains at the nodes of the faces, :math:`(\nabla u + \nabla u^T) / 2`; None without elements.

    The strains of an element at its Gauss points are continued to its corners by the shape functions of these. A
    node has the mean of its elements.

    Parameters
    ----------
    nodes : Nodes
        With ``elements`` and ``faces`` between corners of these.
    shapes : array, shape (nodes, 3, modes)
        Displacements of all nodes.

    Returns
    -------
    array, shape (nodes of the faces, 6, modes), or None
        xx, yy, zz, yz, zx, xy, per unit of a mode; shears are half of the changed angles. The nodes ascend.
    """
    if nodes.faces is None or nodes.elements is None or not len(nodes.faces):
        return None
    drawn = np.unique(nodes.faces)
    modes = shapes.shape[2]
    slopes = _gradients(nodes.places, nodes.elements, drawn) @ shapes.reshape(len(shapes), -1)
    slopes = slopes.reshape(len(drawn), 3, 3, modes)  # [node, along, of, mode]
    normal = [slopes[:, k, k] for k in range(3)]
    return np.stack(normal + [(slopes[:, a, b] + slopes[:, b, a]) / 2 for a, b in SHEARS], axis=1)


def _gradients(places: np.ndarray, elements: np.ndarray, drawn: np.ndarray) -> csr_array:
    """Gradients at drawn nodes of a function by its values at all nodes, (3 drawn nodes, nodes), 1/m."""
    skfem = library("skfem", "free_body_modes")
    full, linear, degree = KINDS[elements.shape[1]]
    full, linear = getattr(skfem, full)(), getattr(skfem, linear)()
    points = skfem.quadrature.get_quadrature(full.refdom, degree)[0]
    slopes = np.array([full.lbasis(points, k)[1] for k in range(elements.shape[1])])  # (m, 3, points)
    corners = np.array([linear.lbasis(points, k)[0] for k in range(points.shape[1])])  # (corners, points)
    place = np.full(len(places), -1)
    place[drawn] = np.arange(len(drawn))
    at = place[elements[:, : len(corners)]]
    elements, at = elements[(at >= 0).any(axis=1)], at[(at >= 0).any(axis=1)]
    turns = np.einsum("mkq,emj->eqkj", slopes, places[elements])
    by_node = np.linalg.solve(turns, slopes.transpose(2, 1, 0)[None])  # (elements, points, 3, m)
    by_node = np.einsum("qc,eqjm->ecjm", np.linalg.inv(corners), by_node)[at >= 0]
    members = np.broadcast_to(elements[:, None], (*at.shape, elements.shape[1]))[at >= 0]
    at = at[at >= 0]
    by_node /= np.bincount(at)[at][:, None, None]
    rows = np.broadcast_to((3 * at[:, None] + np.arange(3))[..., None], by_node.shape)
    columns = np.broadcast_to(members[:, None], by_node.shape)
    return csr_array(coo_array((by_node.ravel(), (rows.ravel(), columns.ravel())), shape=(3 * len(drawn), len(places))))
