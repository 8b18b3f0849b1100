"""Sets of nodes of mesh files."""

from pathlib import Path

import numpy as np
import pytest

from dalembert.structure import Dofs, Material, Nodes, Structure, pairs, solid

pytest.importorskip("meshio")
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


def test_pairs_are_plain_texts() -> None:
    names = np.array(["a", "b"])
    nodes = Nodes(tuple(names), np.zeros((2, 3)), {"upper": tuple(names[:1]), "lower": names[1:]})
    structure = Structure(np.eye(2), np.eye(2), Dofs(("a.x", "b.x")), nodes=nodes)
    assert repr(pairs(structure, "upper", "lower", 0.1)) == "(('a', 'b'),)"
