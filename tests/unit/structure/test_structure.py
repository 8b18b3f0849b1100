import numpy as np
import pytest
from inline_snapshot import snapshot
from scipy.sparse import csc_array

from dalembert.errors import InputError
from dalembert.structure import Dofs, Structure, lumped
from refusals import refused
from support import says

DOFS = Dofs(("a.x", "a.y", "b.x"))


def test_a_node_with_one_direction_may_be_named_alone() -> None:
    assert (DOFS.index("b"), DOFS.index("a.y"), DOFS.rows(["a", "b.x"])) == (2, 1, [0, 1, 2])


def test_a_node_with_several_directions_asks_for_one() -> None:
    with refused(InputError, snapshot("the node 'a' has the degrees of freedom a.x, a.y; name one")):
        DOFS.index("a")


def test_an_unknown_name_lists_near_ones() -> None:
    with refused(InputError, snapshot("unknown degree of freedom 'b.y'; did you mean 'a.y' or 'b.x'?")):
        DOFS.index("b.y")


@pytest.mark.parametrize(
    ("names", "sentence"),
    [
        (
            ("a.w",),
            "Dofs: a degree of freedom is called 'a.w'; expected NODE.DIRECTION with one of the directions "
            "x, y, z, rx, ry, rz, rxy, q, such as 'A.x'",
        ),
        (
            ("a.x", "a.x"),
            "Dofs: the name 'a.x' is given twice; expected a name for each degree of freedom",
        ),
    ],
)
def test_names_must_be_of_the_form_and_differ(names: tuple[str, ...], sentence: str) -> None:
    with pytest.raises(InputError, match=says(sentence)):
        Dofs(names)


def test_matrices_must_fit_the_names() -> None:
    sentence = (
        "Structure: the stiffness matrix has shape (2, 2); expected (3, 3), a row for each of the 3 degrees of freedom"
    )
    with pytest.raises(InputError, match=says(sentence)):
        Structure(np.eye(3), np.eye(2), DOFS)


@pytest.mark.parametrize("form", [np.array, csc_array])
def test_matrices_must_be_symmetric(form) -> None:
    lopsided = np.eye(3)
    lopsided[0, 1] = 0.5
    sentence = (
        "Structure: the mass matrix is not symmetric, it differs from its transpose by up to 0.5; "
        "expected a symmetric one"
    )
    with pytest.raises(InputError, match=says(sentence)):
        Structure(form(lopsided), np.eye(3), DOFS)


def test_matrices_must_be_finite() -> None:
    sentence = "Structure: the damping matrix has entries that are not finite numbers"
    with pytest.raises(InputError, match=says(sentence)):
        Structure(np.eye(3), np.eye(3), DOFS, np.diag([1.0, np.nan, 1.0]))


@pytest.mark.parametrize("form", [np.array, csc_array])
def test_clamping_takes_rows_and_columns_out(form) -> None:
    stiffness = np.array([[3.0, 1.0, 0.5], [1.0, 4.0, 2.0], [0.5, 2.0, 5.0]])
    held = Structure(form(np.eye(3)), form(stiffness), DOFS, form(0.1 * stiffness)).fixed(["b"])
    assert held.dofs.names == ("a.x", "a.y")
    np.testing.assert_array_equal(np.asarray(held.stiffness @ np.eye(2)), stiffness[:2, :2])
    np.testing.assert_array_equal(np.asarray(held.damping @ np.eye(2)), 0.1 * stiffness[:2, :2])


def test_springs_assemble_with_their_dampers_and_carry_complex_steps() -> None:
    chain = lumped({"a": 1.0, "b": 2.0}, [("a", None, 3.0 + 1e-30j, 0.1), ("a", "b", 1.0, 0.2)])
    np.testing.assert_allclose(chain.stiffness.real, [[4, -1], [-1, 1]])
    np.testing.assert_allclose(chain.stiffness.imag, [[1e-30, 0], [0, 0]])
    np.testing.assert_allclose(chain.damping.real, [[0.3, -0.2], [-0.2, 0.2]])


def test_a_spring_on_a_missing_mass_is_told() -> None:
    with refused(InputError, snapshot("lumped: spring 1: unknown mass 'c'; known: a, b")):
        lumped({"a": 1.0, "b": 1.0}, [("a", "c", 1.0, 0.0)])
