from itertools import pairwise

import numpy as np
import pytest
from inline_snapshot import snapshot
from scipy.sparse import csc_array

from dalembert.errors import InputError, SolveError
from dalembert.structure import Material, Rayleigh, Structure, box, craig_bampton, eigenmodes, lumped, solid
from refusals import refused
from support import says

ALUMINIUM = Material(70e9, 0.33, 2700.0)
BEAM = solid(box((0.5, 0.04, 0.02), (20, 2, 1)), ALUMINIUM).fixed("left")
TIP = BEAM.nodes.nearest((0.5, 0.0, 0.0)) if BEAM.nodes else ""
MIDDLE = BEAM.nodes.nearest((0.25, 0.04, 0.02)) if BEAM.nodes else ""


def test_ten_modes_of_a_beam_are_kept() -> None:
    small = craig_bampton(BEAM, [TIP, MIDDLE], modes=20)
    assert small.dofs.names[:4] == (f"{TIP}.x", f"{TIP}.y", f"{TIP}.z", f"{MIDDLE}.x")
    assert small.size == 26
    errors = small.errors(BEAM)
    assert len(errors.relative) == 10
    assert np.all(errors.relative > -1e-9)
    assert np.all(errors.relative < 1e-3)
    np.testing.assert_allclose(errors.similarity, 1, atol=1e-3)


def test_static_answers_to_forces_on_masters_are_exact() -> None:
    small = craig_bampton(BEAM, [TIP], modes=3)
    force = np.array([1.0, 2.0, 3.0])
    full = np.zeros(BEAM.size)
    full[BEAM.rows(TIP)] = force
    exact = np.linalg.solve(BEAM.stiffness.toarray(), full)
    ours = small.expand(np.linalg.solve(small.stiffness, np.append(force, np.zeros(3))))
    np.testing.assert_allclose(ours, exact, atol=1e-8 * np.abs(exact).max())


def test_dense_and_sparse_structures_reduce_alike() -> None:
    names = [f"m{number}" for number in range(900)]
    springs = [("m0", None, 1.0, 0.0), *((a, b, 1.0, 0.1) for a, b in pairwise(names))]
    dense = lumped(dict.fromkeys(names, 1.0), springs)
    sparse = Structure(csc_array(dense.mass), csc_array(dense.stiffness), dense.dofs, csc_array(dense.damping))
    first, second = (craig_bampton(one, ["m10", "m899"], modes=4) for one in (dense, sparse))
    np.testing.assert_allclose(eigenmodes(first, 5).frequencies, eigenmodes(second, 5).frequencies, rtol=1e-8)
    assert second.damping is not None
    np.testing.assert_allclose(np.diag(first.damping), np.diag(second.damping), rtol=1e-6)


def test_with_all_modes_nothing_is_lost_and_damping_comes_along() -> None:
    chain = lumped({"a": 1.0, "b": 2.0, "c": 3.0}, [("a", None, 4.0, 0.1), ("a", "b", 2.0, 0.2), ("b", "c", 5.0, 0.3)])
    small = craig_bampton(chain.with_damping(Rayleigh(0.1, 0.2)), ["b"])
    assert small.size == 3
    np.testing.assert_allclose(eigenmodes(small, 3).frequencies, eigenmodes(chain, 3).frequencies)
    np.testing.assert_allclose(small.damping, 0.1 * small.mass + 0.2 * small.stiffness, atol=1e-12)


def test_clamping_a_reduced_structure_keeps_its_basis_in_step() -> None:
    small = craig_bampton(BEAM, [TIP, MIDDLE], modes=5)
    held = small.fixed(f"{TIP}.z")
    assert held.basis.shape == (BEAM.size, 10)
    motion = np.arange(10.0)
    full = np.insert(motion, 2, 0.0)
    np.testing.assert_allclose(held.expand(motion), small.expand(full))


def test_complex_steps_go_through_the_basis_of_the_real_part() -> None:
    turned = Structure(BEAM.mass, BEAM.stiffness * (1 + 1e-30j), BEAM.dofs)
    small, plain = craig_bampton(turned, [TIP], modes=2), craig_bampton(BEAM, [TIP], modes=2)
    np.testing.assert_allclose(small.stiffness.imag, 1e-30 * plain.stiffness, atol=1e-36 * plain.stiffness.max())


def test_what_does_not_fit_is_told() -> None:
    free = lumped({"a": 1.0, "b": 1.0, "c": 1.0}, [("a", "b", 1.0, 0.0)])
    sentence = (
        "craig_bampton: the stiffness with the masters held is singular: the structure, or a part of it, moves without "
        "being held; clamp it or add masters"
    )
    with pytest.raises(SolveError, match=says(sentence)):
        craig_bampton(free, ["a"])
    with refused(InputError, snapshot("craig_bampton: modes is -1; expected 0 or more")):
        craig_bampton(free, ["a"], modes=-1)
    sentence = (
        "errors: the structure given has 3 degrees of freedom, which are not those of the structure that was reduced, "
        f"with {BEAM.size}; give the one that craig_bampton was given"
    )
    with pytest.raises(InputError, match=says(sentence)):
        craig_bampton(BEAM, [TIP], modes=1).errors(free)
