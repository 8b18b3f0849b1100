import numpy as np
import pytest

from dalembert.errors import InputError
from dalembert.structure import Material, Nodes, Structure, box, combine, eigenmodes, lumped, pairs, solid, tie
from support import says

STEEL = Material(210e9, 0.3, 7800.0)
NEAR, FAR = (solid(box((0.2, 0.1, 0.02), (2, 2, 1), corner=(start, 0.0, 0.0)), STEEL) for start in (0.0, 0.2))


def test_two_halves_tied_are_the_whole() -> None:
    halves = combine({"near": NEAR, "far": FAR})
    assert halves.size == NEAR.size + FAR.size
    joined = tie(halves, pairs(halves, "near/right", "far/left", 1e-9))
    whole = solid(box((0.4, 0.1, 0.02), (4, 2, 1)), STEEL)
    assert joined.size == whole.size
    np.testing.assert_allclose(
        eigenmodes(joined.fixed("near/left"), 8).frequencies, eigenmodes(whole.fixed("left"), 8).frequencies, rtol=1e-8
    )
    assert joined.nodes is not None
    assert set(joined.nodes.members("far/left")) == set(joined.nodes.members("near/right"))
    assert joined.rows("far/left") == joined.rows("near/right")
    assert joined.nodes.faces is not None
    assert joined.nodes.faces.max() == len(NEAR.nodes.names) + FAR.nodes.faces.max()  # type: ignore[union-attr]


def test_damping_comes_along_where_a_part_has_some() -> None:
    damped, plain = lumped({"a": 1.0}, [("a", None, 2.0, 0.5)]), lumped({"b": 1.0, "c": 3.0}, [("b", "c", 1.0, 0.0)])
    bare = Structure(plain.mass, plain.stiffness, plain.dofs)
    both = combine({"one": damped, "two": bare})
    assert both.damping is not None
    np.testing.assert_array_equal(both.damping.toarray(), np.diag([0.5, 0.0, 0.0]))
    tied = tie(both, [("one/a", "two/b")])
    assert tied.dofs.names == ("one/a.x", "two/c.x")
    np.testing.assert_array_equal(tied.mass.toarray(), np.diag([2.0, 3.0]))
    np.testing.assert_array_equal(tied.stiffness.toarray(), [[3.0, -1.0], [-1.0, 1.0]])
    assert combine({"two": bare}).damping is None


SQUARE = Structure(
    np.eye(4),
    np.eye(4),
    lumped(dict.fromkeys("abcd", 1.0), []).dofs,
    nodes=Nodes(
        ("a", "b", "c", "d"),
        np.array([[0.0, 0, 0], [0.1, 0, 0], [0.0, 0, 0.01], [0.4, 0, 0.01]]),
        {"low": ("a", "b"), "high": ("c", "d"), "corner": ("a",)},
    ),
)


def test_pairs_are_the_nearest_within_the_tolerance() -> None:
    assert pairs(SQUARE, "corner", "high", 0.02) == (("a", "c"),)


@pytest.mark.parametrize(
    ("make", "sentence"),
    [
        (
            lambda: pairs(SQUARE, "low", "high", 0.02),
            "pairs: 1 of the 2 nodes of 'low' have no node of 'high' within 0.02 m, node 'b' is 0.1 m from the "
            "nearest; raise the tolerance, or use a set of fewer nodes",
        ),
        (
            lambda: pairs(SQUARE, "low", "high", 0.2),
            "pairs: the node 'c' of 'high' is nearest to 2 nodes of 'low'; expected one each; lower the tolerance, "
            "or swap the sets",
        ),
        (
            lambda: pairs(lumped({"a": 1.0}, []), "low", "high", 0.2),
            "pairs: the structure does not say where its nodes are; give it nodes=Nodes(...)",
        ),
        (
            lambda: tie(SQUARE, [("a", "b"), ("c", "b")]),
            "tie: a node is the second of two pairs, or the second of one and the first of another",
        ),
        (lambda: tie(SQUARE, [("a", "e")]), "unknown degree of freedom 'e'; known: a.x, b.x, c.x, d.x"),
    ],
)
def test_what_does_not_fit_is_told(make, sentence: str) -> None:
    with pytest.raises(InputError, match=says(sentence)):
        make()
