"""Loss matrices of structures: how they are given, carried along and refused."""

import re
from pathlib import Path

import numpy as np
import pytest
from scipy.io import mmwrite, savemat
from scipy.sparse import csc_array, issparse

from dalembert.errors import DataError, InputError
from dalembert.structure import Dofs, Structure, combine, craig_bampton, lumped, read_structure, tie, write_structure

CHAIN = lumped({"a": 1.0, "b": 2.0}, [("a", None, 3.0, 0.1, 0.1), ("a", "b", 1.0, 0.0, 0.02), ("b", None, 2.0, 0.0)])
LOSS = np.array([[0.32, -0.02], [-0.02, 0.02]])


def dense(matrix) -> np.ndarray:
    return matrix.toarray() if issparse(matrix) else matrix


def test_springs_have_loss_factors() -> None:
    np.testing.assert_allclose(CHAIN.loss, LOSS)
    assert lumped({"a": 1.0}, [("a", None, 3.0, 0.1)]).loss is None


def test_a_loss_factor_is_a_part_of_the_stiffness() -> None:
    np.testing.assert_allclose(CHAIN.with_loss(0.05).loss, 0.05 * CHAIN.stiffness)
    np.testing.assert_allclose(CHAIN.with_loss(LOSS).loss, LOSS)
    assert CHAIN.with_loss(0.05 + 1e-30j).loss.imag[0, 0] == 1e-30 * 4.0


def test_parts_ties_and_clamps_keep_the_loss() -> None:
    both = combine({"left": CHAIN, "right": lumped({"a": 1.0}, [])})
    expected = np.zeros((3, 3))
    expected[:2, :2] = LOSS
    np.testing.assert_allclose(dense(both.loss), expected)
    np.testing.assert_allclose(dense(tie(both, [("left/b", "right/a")]).loss), LOSS)
    np.testing.assert_allclose(CHAIN.fixed("a").loss, [[0.02]])


def test_a_reduction_projects_the_loss() -> None:
    small = craig_bampton(CHAIN, ["a"], modes=0)
    np.testing.assert_allclose(small.loss, small.basis.T @ LOSS @ small.basis)


def test_files_keep_the_loss(tmp_path: Path) -> None:
    write_structure(CHAIN, tmp_path / "chain.npz")
    np.testing.assert_allclose(read_structure(tmp_path / "chain.npz").loss, LOSS)
    sparse = combine({"p": CHAIN})
    write_structure(sparse, tmp_path / "sparse.npz")
    np.testing.assert_allclose(dense(read_structure(tmp_path / "sparse.npz").loss), LOSS)


def test_the_imaginary_part_of_a_stiffness_in_a_file_is_the_loss(tmp_path: Path) -> None:
    for name, matrix in (("k", CHAIN.stiffness + 1j * LOSS), ("m", CHAIN.mass)):
        mmwrite(tmp_path / f"{name}.mtx", csc_array(matrix))
    read = read_structure({"mass": tmp_path / "m.mtx", "stiffness": tmp_path / "k.mtx"})
    np.testing.assert_allclose(dense(read.loss), LOSS)
    np.testing.assert_allclose(dense(read.stiffness), CHAIN.stiffness)
    savemat(tmp_path / "all.mat", {"K": CHAIN.stiffness + 0j, "M": CHAIN.mass})
    plain = read_structure(tmp_path / "all.mat")
    assert plain.loss is None
    assert not np.iscomplexobj(plain.stiffness)


def test_other_complex_matrices_in_a_file_are_refused(tmp_path: Path) -> None:
    savemat(tmp_path / "all.mat", {"K": CHAIN.stiffness, "M": CHAIN.mass * (1 + 0.1j)})
    with pytest.raises(
        DataError,
        match=re.escape("read_structure: the mass matrix has imaginary parts up to 0.2; expected a real one. Only a"),
    ):
        read_structure(tmp_path / "all.mat")
    savemat(tmp_path / "two.mat", {"K": CHAIN.stiffness * (1 + 0.1j), "M": CHAIN.mass, "K4AA": LOSS})
    with pytest.raises(DataError, match=re.escape("the stiffness matrix has imaginary parts")):
        read_structure(tmp_path / "two.mat")


def test_a_complex_stiffness_names_the_loss() -> None:
    dofs = Dofs(("m.x",))
    with pytest.raises(
        InputError, match=re.escape("the stiffness matrix has imaginary parts up to 0.02, 0.02 of its largest entry")
    ) as caught:
        Structure(np.eye(1), np.array([[1.0 + 0.02j]]), dofs)
    assert "stiffness=K.real, loss=K.imag" in str(caught.value)
    with pytest.raises(InputError, match=re.escape("Structure: the stiffness matrix has imaginary parts")):
        lumped({"m": 1.0}, [("m", None, 1.0 + 0.02j, 0.0)])
    with pytest.raises(InputError, match=re.escape("Structure: the mass matrix has imaginary parts")):
        Structure(csc_array(np.eye(1) * (1 + 1e-3j)), np.eye(1), dofs)
    Structure(np.eye(1), np.array([[1.0 + 1e-30j]]), dofs)  # a complex step


@pytest.mark.parametrize("factor", [-0.1, np.nan, "2 %", 0.1 + 0.1j, None])
def test_loss_factors_are_checked(factor) -> None:
    with pytest.raises(InputError, match=re.escape("the loss factor is")):
        CHAIN.with_loss(factor)
    with pytest.raises(InputError, match=re.escape("spring 1: the loss factor is")):
        lumped({"m": 1.0}, [("m", None, 1.0, 0.0, factor)])


def test_a_loss_matrix_is_checked() -> None:
    with pytest.raises(InputError, match=re.escape("Structure: the loss of 'b.x' is -1 N/m")):
        CHAIN.with_loss(np.diag([1.0, -1.0]))
    with pytest.raises(InputError, match=re.escape("the loss matrix is not symmetric")):
        CHAIN.with_loss(np.array([[1.0, 0.5], [0.0, 1.0]]))
