"""Strains at the surface of solids: exact for linear displacements, with parts that are tied, and none without a mesh."""

from dataclasses import replace

import numpy as np
import pytest

from dalembert.structure import Material, box, combine, free_body_modes, pairs, solid, tie
from dalembert.structure.surface_strains import surface_strains

STEEL = Material(210e9, 0.3, 7800.0)
GRADIENT = np.array([[1.0, 0.4, -0.3], [0.2, -0.5, 0.7], [0.1, 0.6, 0.8]]) * 1e-3
EXPECTED = [1e-3, -5e-4, 8e-4, 6.5e-4, -1e-4, 3e-4]
"""xx, yy, zz, yz, zx, xy of its symmetric part."""


def moved(structure) -> np.ndarray:
    """Displacements of nodes by the gradient, (nodes, 3, 1)."""
    return (structure.nodes.places @ GRADIENT.T)[:, :, None]


@pytest.mark.parametrize("element", ["brick 20", "brick 20 full", "brick 27", "tetrahedron 10"])
def test_linear_displacements_have_the_same_strain_everywhere(element: str) -> None:
    mesh = box((0.4, 0.2, 0.3), (3, 2, 2))
    if element == "tetrahedron 10":
        mesh = mesh.to_meshtet()
    bent = replace(mesh, doflocs=mesh.p + 0.03 * np.sin(9.0 * mesh.p[[1, 2, 0]]))
    structure = solid(bent, STEEL, element)
    strains = surface_strains(structure.nodes, moved(structure))
    assert strains is not None
    assert strains.shape == (len(np.unique(structure.nodes.faces)), 6, 1)
    np.testing.assert_allclose(strains[:, :, 0], [EXPECTED] * len(strains), atol=1e-15)


def test_tied_parts_keep_their_elements() -> None:
    halves = {
        "a": solid(box((0.2, 0.1, 0.08), (2, 2, 2)), STEEL),
        "b": solid(box((0.2, 0.1, 0.08), (2, 2, 2), (0.2, 0, 0)), STEEL),
    }
    apart = combine(halves)
    both = tie(apart, pairs(apart, "a/right", "b/left", 1e-9))
    strains = surface_strains(both.nodes, moved(both))
    np.testing.assert_allclose(strains[:, :, 0], [EXPECTED] * len(strains), atol=1e-15)
    one = free_body_modes(solid(box((0.4, 0.1, 0.08), (4, 2, 2)), STEEL), {"foot": "left"}, 4)
    two = free_body_modes(both, {"foot": "a/left"}, 4)
    np.testing.assert_allclose(np.abs(two.strains).max(axis=(0, 1)), np.abs(one.strains).max(axis=(0, 1)), rtol=1e-5)


def test_parts_of_several_kinds_have_no_elements() -> None:
    parts = {
        "a": solid(box((0.2, 0.1, 0.1), (1, 1, 1)), STEEL),
        "b": solid(box((0.2, 0.1, 0.1), (1, 1, 1)), STEEL, "brick 27"),
    }
    both = combine(parts)
    assert both.nodes.elements is None
    assert both.nodes.faces is not None
    assert surface_strains(both.nodes, moved(both)) is None


def test_matrices_without_a_mesh_have_no_strains() -> None:
    bar = solid(box((0.4, 0.02, 0.03), (4, 2, 2)), STEEL)
    bare = replace(bar, nodes=replace(bar.nodes, elements=None))
    assert free_body_modes(bare, {"foot": "left"}, 4).strains is None
