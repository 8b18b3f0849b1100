"""Beams without stress: where the nodes are for which the strains at the points of an element are those of a shape."""

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
from scipy.linalg import expm

from dalembert.multibody.components.spatial.beam_kinematics import strains
from dalembert.multibody.components.spatial.beam_shapes import Places, rule
from dalembert.multibody.components.spatial.orientation import skew, turned
from dalembert.multibody.kernels.elementary import STEP

_MOST_ITERATIONS = 12
_ROUNDING = 1e-14


def placed_nodes(degree: int, elements: int, length: Any, curvature: Sequence | Callable[[float], Any]) -> np.ndarray:
    """Nodes of a chain in the frame of its start, (nodes, 4, 3): origins, m, and directors, one in each row.

    ``curvature``: twist and curvatures about y and z, 1/m, or a function of the place, m from the start. The strains
    at the points of the elements are exactly those of the shape; the ends of elements are on it up to the order of the
    element, twice the degree.
    """
    h, at = length / elements, np.array(rule(degree, degree).places)
    if not callable(curvature):
        shape = _element(degree, h, np.tile(np.array(curvature), (degree, 1)))
        shapes = [shape] * elements
    else:
        shapes = [_element(degree, h, np.array([curvature(e * h + s) for s in at * h])) for e in range(elements)]
    nodes = [shapes[0][:1]]
    for shape in shapes:
        last = nodes[-1][-1]
        moved = shape[1:] @ last[1:]
        moved[:, 0] += last[0]
        nodes.append(moved)
    return np.concatenate(nodes)


def _element(degree: int, h: Any, curvatures: np.ndarray) -> np.ndarray:
    """Nodes of an element from the origin on, (nodes, 4, 3), for curvatures (points, 3) at its points."""
    places, wanted = Places.at(degree, np.array(rule(degree, degree).places)), np.zeros((degree, 6))
    wanted = np.concatenate([wanted[:, :3] + (1.0, 0.0, 0.0), curvatures], axis=1)
    nodes = _arc(degree, h, curvatures.mean(axis=0))
    if not np.any(curvatures):
        return nodes  # straight: the strains are exact
    size = np.full(1, h)

    def missed(moved: np.ndarray) -> np.ndarray:
        return (strains(moved[None], places, size)[0] - wanted).ravel()

    before = np.inf
    for _ in range(_MOST_ITERATIONS):
        # Newton's method; the matrix of the real part serves the derivatives in imaginary parts, too.
        real = np.real(nodes).astype(complex)
        columns = np.imag(strains(_perturbed(real), places, np.real(size))).reshape(6 * degree, -1)
        step = np.linalg.solve(columns.T / STEP, missed(nodes))
        nodes = _moved(nodes, -step.reshape(degree, 6))
        norm = np.abs(np.real(step)).max() + np.abs(np.imag(step)).max() / STEP
        if norm <= _ROUNDING * np.abs(np.real(np.array(h))) or norm >= before:
            break
        before = norm
    return nodes


def _moved(nodes: np.ndarray, changes: np.ndarray) -> np.ndarray:
    """Nodes (nodes, 4, 3) after displacements and rotations (nodes - 1, 6) of all but the first."""
    moved = [np.vstack([node[0] + c[:3], turned(node[1:], c[3:])]) for node, c in zip(nodes[1:], changes, strict=True)]
    return np.array([nodes[0], *moved])


def _perturbed(nodes: np.ndarray) -> np.ndarray:
    """Nodes with an imaginary step of each displacement and rotation of all but the first, (steps, nodes, 4, 3)."""
    count = len(nodes) - 1
    moved = np.tile(nodes, (6 * count, 1, 1, 1))
    for step, (node, axis) in enumerate(np.ndindex(count, 6)):
        unit, directors = np.eye(3)[axis % 3], nodes[node + 1, 1:]
        if axis < 3:
            moved[step, node + 1, 0] += 1j * STEP * unit
        else:
            moved[step, node + 1, 1:] += 1j * STEP * np.cross(unit, directors)
    return moved


def _arc(degree: int, h: Any, curvature: np.ndarray) -> np.ndarray:
    """Nodes on a line of constant curvature: its pose g follows from g' = g [K, e_1; 0, 0]."""
    rate = np.zeros((4, 4), dtype=np.result_type(curvature, h))
    rate[:3, :3], rate[0, 3] = skew(curvature), 1.0
    poses = np.array([expm(h * k / degree * rate) for k in range(degree + 1)])
    return np.concatenate([poses[:, None, :3, 3], np.swapaxes(poses[:, :3, :3], 1, 2)], axis=1)
