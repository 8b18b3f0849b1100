from itertools import pairwise

import numpy as np
import pytest
from scipy.sparse import csc_array

from dalembert.errors import InputError, SolveError
from dalembert.structure import Dofs, Structure, eigenmodes, lumped, similarity
from support import says


def chain(size: int, wall: bool = True) -> Structure:
    """Masses of 1 kg on springs of 1 N/m, sparse, held by walls at both ends or free."""
    names = [f"m{number}" for number in range(size)]
    springs = [(first, second, 1.0, 0.0) for first, second in pairwise(names)]
    held = [(names[0], None, 1.0, 0.0), (names[-1], None, 1.0, 0.0)] if wall else []
    full = lumped(dict.fromkeys(names, 1.0), springs + held)
    return Structure(csc_array(full.mass), csc_array(full.stiffness), full.dofs)


@pytest.mark.parametrize("size", [60, 900], ids=["dense", "Lanczos"])
def test_frequencies_and_shapes_of_a_chain_are_the_closed_form(size: int) -> None:
    modes = eigenmodes(chain(size), 6)
    number = np.arange(1, 7)
    np.testing.assert_allclose(modes.frequencies, np.sin(number * np.pi / 2 / (size + 1)) / np.pi, rtol=1e-9)
    exact = np.sin(np.outer(np.arange(1, size + 1), number) * np.pi / (size + 1))
    np.testing.assert_allclose(similarity(modes.shapes, exact, np.eye(size)), np.eye(6), atol=1e-9)
    np.testing.assert_allclose(modes.shapes.T @ modes.shapes, np.eye(6), atol=1e-9)


def test_a_shift_finds_the_modes_around_it() -> None:
    every = np.sin(np.arange(1, 451) * np.pi / 902) / np.pi
    np.testing.assert_allclose(
        eigenmodes(chain(450), 4, shift=0.2).frequencies,
        np.sort(every[np.argsort(abs(every**2 - 0.04))[:4]]),
        rtol=1e-9,
    )


def test_results_repeat_bit_for_bit() -> None:
    np.testing.assert_array_equal(eigenmodes(chain(450), 3).shapes, eigenmodes(chain(450), 3).shapes)


def test_a_free_structure_asks_for_a_clamp_or_a_shift() -> None:
    sentence = (
        "eigenmodes: the stiffness, less the mass at the shift, is singular: the structure, or a part of it, moves "
        "without being held, or the shift is a frequency of it; clamp it, or choose another shift"
    )
    with pytest.raises(SolveError, match=says(sentence)):
        eigenmodes(chain(900, wall=False), 3)
    free = eigenmodes(chain(900, wall=False), 3, shift=5e-5).frequencies
    np.testing.assert_allclose(free, np.sin(np.arange(3) * np.pi / 1800) / np.pi, atol=1e-9)


def test_more_modes_than_degrees_of_freedom_are_refused() -> None:
    sentence = "eigenmodes: 4 modes are asked for; expected 1 to 3, as many as the structure has degrees of freedom"
    with pytest.raises(InputError, match=says(sentence)):
        eigenmodes(chain(3), 4)


def test_a_node_without_mass_is_told() -> None:
    sentence = "eigenmodes: the mass matrix is not positive definite; give all degrees of freedom a mass"
    with pytest.raises(InputError, match=says(sentence)):
        eigenmodes(Structure(np.diag([1.0, 0.0]), np.eye(2), Dofs(("a.x", "b.x"))), 1)
