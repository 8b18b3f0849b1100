"""Sets of nodes of mesh files."""

from pathlib import Path

import numpy as np
import pytest

from dalembert.errors import DataError
from dalembert.structure import Dofs, Material, Nodes, Structure, mesh_files, pairs, solid

meshio = pytest.importorskip("meshio")
skfem = pytest.importorskip("skfem")
STEEL = Material(210e9, 0.3, 7800.0)
ABAQUS = """*HEADING
two blocks side by side, nodes numbered from 101 downwards in no order
*NODE
112, 2., 0., 0.
101, 0., 0., 0.
102, 1., 0., 0.
103, 1., 1., 0.
104, 0., 1., 0.
105, 0., 0., 1.
106, 1., 0., 1.
107, 1., 1., 1.
108, 0., 1., 1.
113, 2., 1., 0.
114, 2., 0., 1.
115, 2., 1., 1.
900, 50., 50., 50.
*ELEMENT, TYPE=C3D8
1, 101, 102, 103, 104, 105, 106, 107, 108
2, 102, 112, 113, 103, 106, 114, 115, 107
*NSET, NSET=held
101, 104, 105, 108
*NSET, NSET=tip
112, 115
*NSET, NSET=reference
900
"""


def test_sets_of_nodes_of_abaqus_are_kept(tmp_path: Path) -> None:
    (tmp_path / "bar.inp").write_text(ABAQUS)
    bar = solid(tmp_path / "bar.inp", STEEL)
    assert bar.nodes is not None
    places = {name: bar.nodes.places[bar.nodes.rows(bar.nodes.members(name))] for name in ("held", "tip")}
    assert sorted(map(tuple, places["tip"].tolist())) == [(2.0, 0.0, 0.0), (2.0, 1.0, 1.0)]
    assert sorted(map(tuple, places["held"].tolist())) == [(0, 0, 0), (0, 0, 1), (0, 1, 0), (0, 1, 1)]
    assert bar.nodes.members("reference") == ()  # no element has this point
    assert bar.fixed("held").size == bar.size - 12
    np.testing.assert_allclose(bar.mass.sum() / 3, 2 * 7800.0)


CORNERS = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0, 0, 1], [1, 0, 1], [1, 1, 1], [0, 1, 1]], float)
EDGES = ((0, 1), (1, 2), (2, 3), (3, 0), (4, 5), (5, 6), (6, 7), (7, 4), (0, 4), (1, 5), (2, 6), (3, 7))


def bricks(angle: float = 0.0) -> tuple[np.ndarray, np.ndarray]:
    """Points and three bricks of 20 nodes in a row, or along an arc of three times an angle between radii 1 and 2."""
    found: dict[tuple[float, ...], int] = {}
    cells = []
    for number in range(3):
        own = CORNERS + np.array([number, 0, 0])
        nodes = [*own, *((own[a] + own[b]) / 2 for a, b in EDGES)]
        cells.append([found.setdefault(tuple(node.tolist()), len(found)) for node in nodes])
    points = np.array(list(found))
    if angle:
        radius, turn = 1 + points[:, 2], angle * points[:, 0]
        points = np.stack([radius * np.sin(turn), points[:, 1], radius * np.cos(turn)], axis=1)
    return points, np.array(cells)


@pytest.mark.parametrize(("ending", "kind"), [("inp", "abaqus"), ("msh", "gmsh"), ("msh", "gmsh22"), ("vtu", "vtu")])
def test_bricks_of_20_nodes_are_read(tmp_path: Path, ending: str, kind: str) -> None:
    points, cells = bricks()
    path = tmp_path / f"bar.{ending}"
    meshio.write(path, meshio.Mesh(points, [("hexahedron20", cells)]), file_format=kind)
    bar = solid(path, STEEL)
    assert bar.size == 3 * len(points)
    np.testing.assert_allclose(bar.mass.sum() / 3, 3 * 7800.0)
    assert bar.nodes is not None
    np.testing.assert_allclose(np.unique(bar.nodes.places.round(9), axis=0), np.unique(points.round(9), axis=0))


def test_curved_edges_of_bricks_of_20_nodes_are_kept() -> None:
    points, cells = bricks(0.5)
    mesh = mesh_files._mesh(meshio.Mesh(points, [("hexahedron20", cells)]))
    volume = float(skfem.Basis(mesh, skfem.ElementHexS2(), intorder=6).dx.sum())
    # An arc of 0.5 rad by a parabola through three of its points: the area of a sector is 2e-4 too small.
    assert volume == pytest.approx(1.5 * (2**2 - 1) / 2, rel=3e-4)


@pytest.mark.parametrize("second", ["hexahedron20", "hexahedron27", "tetra10"])
def test_sets_of_meshes_of_second_order_are_those_of_the_same_mesh_of_first_order(second: str) -> None:
    kind = "tetra" if second == "tetra10" else "hexahedron"
    if kind == "tetra":
        points = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1], [1, 1, 1]], float)
        cells, edges = np.array([[0, 1, 2, 3], [1, 2, 3, 4]]), ((0, 1), (1, 2), (2, 0), (0, 3), (1, 3), (2, 3))
        middles = {tuple(sorted((c[a], c[b]))) for c in cells.tolist() for a, b in edges}
        place = {pair: len(points) + number for number, pair in enumerate(sorted(middles))}
        full = np.array([[*c, *(place[tuple(sorted((c[a], c[b])))] for a, b in edges)] for c in cells.tolist()])
        points = np.vstack([points, [points[list(pair)].mean(axis=0) for pair in sorted(middles)]])
        sides = np.array([[0, 1, 2]])
        faces, face, sides_kind = (
            np.array([[0, 1, 2, *(place[pair] for pair in ((0, 1), (1, 2), (0, 2)))]]),
            "triangle6",
            "triangle",
        )
    else:
        points, full = bricks()
        if second == "hexahedron27":
            points, full, _ = mesh_files._with_27_nodes(points, full)
        cells, sides = full[:, :8], full[:1, [0, 4, 7, 3]]
        faces, face, sides_kind = full[:1, [0, 4, 7, 3, 16, 15, 19, 11]], "quad8", "quad"
    count = len(cells)
    sets = {"held": [np.array([], int), np.array([0])], "steel": [np.arange(count), np.array([], int)]}
    own = mesh_files._mesh(meshio.Mesh(points, [(second, full), (face, faces)], cell_sets=sets))
    used = np.unique(cells)
    first = meshio.Mesh(
        points[used], [(kind, np.searchsorted(used, cells)), (sides_kind, np.searchsorted(used, sides))], cell_sets=sets
    )
    expected = mesh_files._mesh(first)
    assert own.subdomains["steel"].tolist() == expected.subdomains["steel"].tolist() == list(range(count))
    for mesh in (own, expected):
        corners = mesh.facets[:, mesh.boundaries["held"]]
        np.testing.assert_allclose(sorted(mesh.p[:, corners[:, 0]].T.tolist()), sorted(points[sides[0]].tolist()))


def test_nastran_without_begin_bulk_is_read(tmp_path: Path) -> None:
    lines = [f"GRID    {n:8d}        {x:8.1f}{y:8.1f}{z:8.1f}" for n, (x, y, z) in enumerate(CORNERS.tolist(), 1)]
    lines += ["CHEXA   " + "".join(f"{n:8d}" for n in (1, 1, 1, 2, 3, 4, 5, 6)) + "+       ", f"+       {7:8d}{8:8d}"]
    for name, text in (("part.bdf", lines), ("whole.bdf", ["BEGIN BULK", *lines, "ENDDATA"])):
        (tmp_path / name).write_text("\n".join(text) + "\n")
        np.testing.assert_allclose(solid(tmp_path / name, STEEL).mass.sum() / 3, 7800.0)


def test_what_meshio_prints_is_the_reason(tmp_path: Path, capsys) -> None:
    (tmp_path / "bad.msh").write_text("no mesh")
    with pytest.raises(DataError) as caught:
        solid(tmp_path / "bad.msh", STEEL)
    assert "SystemExit" not in str(caught.value)
    assert "Couldn't read file" in str(caught.value)
    assert capsys.readouterr().out == ""


def test_a_mesh_of_several_kinds_of_cells_is_refused(tmp_path: Path) -> None:
    points = np.vstack([CORNERS, [[2.0, 0.5, 0.5]]])
    cells = [("hexahedron", np.arange(8)[None]), ("tetra", np.array([[1, 2, 6, 8]]))]
    meshio.write(tmp_path / "both.vtu", meshio.Mesh(points, cells))
    with pytest.raises(DataError, match=r"cells of several kinds \(hexahedron, tetra\); expected one kind"):
        solid(tmp_path / "both.vtu", STEEL)


def test_pairs_are_plain_texts() -> None:
    names = np.array(["a", "b"])
    nodes = Nodes(tuple(names), np.zeros((2, 3)), {"upper": tuple(names[:1]), "lower": names[1:]})
    structure = Structure(np.eye(2), np.eye(2), Dofs(("a.x", "b.x")), nodes=nodes)
    assert repr(pairs(structure, "upper", "lower", 0.1)) == "(('a', 'b'),)"
