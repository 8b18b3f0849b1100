import numpy as np
import pytest
from scipy.sparse import csc_array, eye_array

from dalembert.errors import InputError
from dalembert.structure import Dofs, Modal, Rayleigh, Structure, eigenmodes
from support import says

MASS = np.array([[2.0, 0.3, 0.0], [0.3, 1.0, 0.1], [0.0, 0.1, 3.0]])
STIFFNESS = np.array([[3.0, -1.0, 0.0], [-1.0, 4.0, -2.0], [0.0, -2.0, 5.0]])
TRIPLE = Structure(MASS, STIFFNESS, Dofs(("a.x", "b.x", "c.x")))


def test_every_mode_gets_the_ratio() -> None:
    modes = eigenmodes(TRIPLE, 3)
    damping = TRIPLE.with_damping(Modal(0.02)).damping
    np.testing.assert_allclose(
        modes.shapes.T @ damping @ modes.shapes, np.diag(2 * 0.02 * 2 * np.pi * modes.frequencies), atol=1e-12
    )


def test_rayleigh_damping_stays_sparse() -> None:
    sparse = Structure(csc_array(MASS), csc_array(STIFFNESS), TRIPLE.dofs).with_damping(Rayleigh(0.1, 0.02))
    np.testing.assert_allclose(sparse.damping.toarray(), 0.1 * MASS + 0.02 * STIFFNESS)


def test_derivatives_of_modal_damping_are_exact() -> None:
    turn = np.array([[0.5, 0.2, 0.0], [0.2, -0.3, 0.4], [0.0, 0.4, 0.1]])

    def damping(p: complex) -> np.ndarray:
        return Modal(0.02 + 0.1 * p).matrix(MASS + p * turn, STIFFNESS + 2 * p * turn @ turn)

    step = 1e-5
    np.testing.assert_allclose(damping(1e-30j).imag / 1e-30, (damping(step) - damping(-step)) / (2 * step), atol=1e-8)


def test_rigid_motions_are_not_damped() -> None:
    spring = np.array([[1.0, -1.0], [-1.0, 1.0]])
    np.testing.assert_allclose(Modal(0.1).matrix(np.eye(2), spring) @ np.ones(2), 0, atol=1e-15)


def test_a_ratio_for_a_large_model_is_refused() -> None:
    sentence = (
        "Modal: one ratio for all modes of 5001 degrees of freedom is a full matrix; expected at most 5000; "
        "reduce the structure first with craig_bampton, or use Rayleigh"
    )
    with pytest.raises(InputError, match=says(sentence)):
        Modal(0.1).matrix(eye_array(5001), eye_array(5001))


def test_a_ratio_needs_mass_everywhere() -> None:
    sentence = (
        "Modal: the mass matrix is not positive definite, so some modes have no frequency; "
        "give all degrees of freedom a mass, or use Rayleigh"
    )
    with pytest.raises(InputError, match=says(sentence)):
        Modal(0.1).matrix(np.diag([1.0, 0.0]), np.eye(2))
