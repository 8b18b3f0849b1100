import sys

import numpy as np
import pytest
import skfem

from dalembert.errors import InputError
from dalembert.structure import Material, box, eigenmodes, solid
from support import says

STEEL = Material(210e9, 0.3, 7800.0)
ALUMINIUM = Material(70e9, 0.33, 2700.0)
BLOCK = box((0.3, 0.2, 0.1), (2, 2, 1), corner=(1.0, 0.0, 0.0))


@pytest.mark.parametrize(
    ("mesh", "kind"),
    [
        (BLOCK, "brick 20"),
        (BLOCK, "brick 20 full"),
        (box((0.3, 0.1, 0.1), (3, 1, 1)), "brick 20 full"),
        (BLOCK, "brick 27"),
        (BLOCK.to_meshtet(), "tetrahedron 10"),
    ],
    ids=["brick 20", "brick 20 full", "brick 20 full, a row", "brick 27", "tetrahedron 10"],
)
def test_only_rigid_motions_carry_no_energy(mesh, kind: str) -> None:
    free = solid(mesh, STEEL, kind)
    assert free.nodes is not None
    x, y, z = free.nodes.places.T
    zero, one = np.zeros_like(x), np.ones_like(x)
    turns = [(zero, -z, y), (z, zero, -x), (-y, x, zero)]
    shifts = [(one, zero, zero), (zero, one, zero), (zero, zero, one)]
    motions = np.array([np.transpose(motion).ravel() for motion in shifts + turns]).T
    largest = np.abs(free.stiffness).max()
    assert np.abs(free.stiffness @ motions).max() < 1e-9 * largest
    energies = np.linalg.eigvalsh(free.stiffness.toarray())
    assert np.count_nonzero(energies < 1e-9 * largest) == 6
    volume = float(np.prod(np.ptp(mesh.p, axis=1)))
    np.testing.assert_allclose(np.diag(motions.T @ (free.mass @ motions))[:3], 7800 * volume)


@pytest.mark.parametrize("kind", ["brick 20", "brick 20 full", "brick 27"])
def test_a_uniform_strain_is_met_exactly_on_distorted_elements(kind: str) -> None:
    """Patch test: a linear displacement on the surface leaves the inside in balance."""
    bent = skfem.MeshHex(BLOCK.p + 0.02 * np.sin(40 * BLOCK.p[[1, 2, 0]] + 3), BLOCK.t)
    block = solid(bent, STEEL, kind)
    assert block.nodes is not None
    linear = (block.nodes.places @ np.array([[1.0, 0.2, 0.3], [0.1, -0.5, 0.4], [0.0, 0.6, 0.7]])).ravel()
    skin = np.unique(skfem.Basis(bent, skfem.ElementHex2() if kind == "brick 27" else skfem.ElementHexS2()).get_dofs())
    inside = np.setdiff1d(np.arange(len(block.nodes.names)), skin)
    rows = (3 * inside[:, None] + np.arange(3)).ravel()
    assert len(rows) > 0
    assert np.abs(block.stiffness @ linear)[rows].max() < 1e-9 * np.abs(block.stiffness @ linear).max()


def test_a_rod_of_two_materials_stretches_in_series() -> None:
    rod = box((2.0, 0.1, 0.1), (4, 1, 1)).with_subdomains({"far": lambda x: x[0] > 1.0, "near": lambda x: x[0] < 1.0})
    soft, hard = Material(1e9, 0.0, 1000.0), Material(4e9, 0.0, 3000.0)
    held = solid(rod, {"near": soft, "far": hard}).fixed("left")
    assert held.nodes is not None
    np.testing.assert_allclose(solid(rod, {"near": soft, "far": hard}).mass.sum() / 3, 0.01 * (1000 + 3000))
    ends = held.rows([f"{node}.x" for node in held.nodes.members("right")])
    pull = np.zeros(held.size)
    # Consistent nodal forces of a uniform pull of 1 N on a serendipity face: -1/12 at corners, 1/3 at middles of edges.
    corners = [row for row in ends if int(held.dofs.names[row][:-2]) < rod.nvertices]
    pull[ends], pull[corners] = 1 / 3, -1 / 12
    np.testing.assert_allclose(np.linalg.solve(held.stiffness.toarray(), pull)[ends], 100 * (1 / 1e9 + 1 / 4e9))


def test_derivatives_run_through_each_material() -> None:
    step = 1e-30j
    two = BLOCK.with_subdomains({"low": lambda x: x[0] < 1.15, "high": lambda x: x[0] > 1.15})
    turned = solid(two, {"low": Material(210e9, 0.3 + step, 7800.0), "high": ALUMINIUM})

    def at(ratio: float) -> np.ndarray:
        return solid(two, {"low": Material(210e9, ratio, 7800.0), "high": ALUMINIUM}).stiffness.toarray()

    numeric = (at(0.3 + 1e-6) - at(0.3 - 1e-6)) / 2e-6
    np.testing.assert_allclose(turned.stiffness.imag.toarray() / 1e-30, numeric, atol=1e-8 * np.abs(numeric).max())
    assert turned.mass.dtype == complex
    assert np.abs(turned.mass.imag).max() == 0


def test_a_mesh_is_read_from_a_file(tmp_path) -> None:
    path = tmp_path / "block.vtk"
    BLOCK.save(path)
    np.testing.assert_allclose(solid(path, STEEL).stiffness.sum(), solid(BLOCK, STEEL).stiffness.sum(), atol=1)
    assert solid(str(path), STEEL).size == solid(BLOCK, STEEL).size


def test_sides_of_a_box_are_sets_of_nodes() -> None:
    held = solid(BLOCK, STEEL).nodes
    assert held is not None
    np.testing.assert_allclose(held.places[held.rows(held.members("left"))][:, 0], 1.0)
    np.testing.assert_allclose(held.places[held.rows(held.members("top"))][:, 2], 0.1)
    assert set(held.members("edge")) == {
        node for side in ("left", "right", "front", "back") for node in held.members(side)
    }
    assert held.faces is not None
    assert held.faces.shape == (16, 4)


FOLDED = skfem.MeshHex(BLOCK.p + np.array([[0.0], [0.0], [0.15]]) * (BLOCK.p[0] == 1.0) * (BLOCK.p[2] == 0.0), BLOCK.t)
HALF = BLOCK.with_subdomains({"half": lambda x: x[0] < 1.15})


@pytest.mark.parametrize(
    ("make", "sentence"),
    [
        (
            lambda: solid(BLOCK, STEEL, "brick 8"),
            "solid: unknown element 'brick 8'; did you mean 'brick 27' or 'brick 20'?",
        ),
        (
            lambda: solid(BLOCK, STEEL, "tetrahedron 10"),
            "solid: the element 'tetrahedron 10' does not fit a mesh of 4 Hexahedral elements",
        ),
        (
            lambda: solid(FOLDED, STEEL),
            "solid: 2 elements of the mesh are flat or folded, the first is element 0",
        ),
        (lambda: solid(HALF, {"halve": STEEL}), "solid: unknown subdomain 'halve'; did you mean 'half'?"),
        (
            lambda: solid(HALF, {"half": STEEL}),
            "solid: 2 of the 4 elements of the mesh belong to no subdomain with a material; "
            "materials are given for half",
        ),
    ],
)
def test_what_does_not_fit_is_told(make, sentence: str) -> None:
    with pytest.raises(InputError, match=says(sentence)):
        make()


def test_a_missing_library_is_told(monkeypatch) -> None:
    monkeypatch.setitem(sys.modules, "skfem", None)
    sentence = "box: scikit-fem is needed and not installed; run: pip install 'dalembert[fem]'"
    with pytest.raises(InputError, match=says(sentence)):
        box((1.0, 1.0, 1.0), (1, 1, 1))


def test_both_bricks_agree_on_a_short_beam() -> None:
    beam = box((0.5, 0.1, 0.1), (8, 2, 2))
    first, second = (
        eigenmodes(solid(beam, STEEL, kind).fixed("left"), 5).frequencies for kind in ("brick 20", "brick 27")
    )
    np.testing.assert_allclose(first, second, rtol=4e-3)
