import numpy as np
import pytest

from dalembert.errors import InputError
from dalembert.structure import Dofs, Nodes, Structure
from support import says

PLACES = np.array([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [2.0, 0.0, 1.0]])


def test_nodes_are_found_by_place_and_by_set() -> None:
    nodes = Nodes(("a", "b", "c"), PLACES, {"end": ("c", "a")})
    assert (nodes.nearest((1.9, 0.0)), nodes.nearest((0.6, 0, 0.1)), nodes.members("end")) == ("c", "b", ("c", "a"))
    np.testing.assert_array_equal(nodes.rows(["c", "a"]), [2, 0])


def test_a_set_of_nodes_is_clamped() -> None:
    nodes = Nodes(("a", "b", "c"), PLACES, {"end": ("c", "a")})
    names = Dofs(("a.x", "a.z", "b.x", "c.x"))
    held = Structure(np.eye(4), np.diag([1.0, 2.0, 3.0, 4.0]), names, nodes=nodes).fixed("end")
    assert held.dofs.names == ("b.x",)
    assert held.stiffness.tolist() == [[3.0]]


@pytest.mark.parametrize(
    ("make", "sentence"),
    [
        (
            lambda: Nodes(("a", "b"), PLACES),
            "Nodes: the places have shape (3, 3); expected (2, 3), x, y and z of each of the 2 nodes",
        ),
        (
            lambda: Nodes(("a", "b", "c"), PLACES, {"end": ("d",)}),
            "Nodes: set 'end': unknown node 'd'; known: a, b, c",
        ),
        (
            lambda: Nodes(("a", "b", "c"), PLACES, {"end": ()}).members("ends"),
            "unknown node set 'ends'; did you mean 'end'?",
        ),
        (lambda: Nodes(("a", "b", "c"), PLACES).rows(["d"]), "unknown node 'd'; known: a, b, c"),
        (
            lambda: Nodes(("a", "b", "c"), PLACES, elements=np.array([[0, 1, 2]])),
            "Nodes: the elements have shape (1, 3); expected 10, 20 or 27 nodes of each. Leave out elements of other "
            "kinds",
        ),
    ],
)
def test_what_does_not_fit_is_told(make, sentence: str) -> None:
    with pytest.raises(InputError, match=says(sentence)):
        make()
