import sys
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
from scipy.io import mmwrite, savemat
from scipy.sparse import coo_matrix, csc_array

from dalembert.errors import DataError, InputError
from dalembert.structure import Dofs, Structure, eigenmodes, read_structure, write_structure
from support import says

MASS = np.diag([2.0, 3.0, 4.0])
STIFFNESS = np.array([[3.0, -1.0, 0.5], [-1.0, 4.0, -2.0], [0.5, -2.0, 5.0]])
NAMES = ("4.x", "4.z", "7.ry")


def same(structure: Structure, names: tuple[str, ...] = NAMES, damping: np.ndarray | None = None) -> None:
    assert structure.dofs.names == names
    np.testing.assert_allclose(full(structure.mass), MASS)
    np.testing.assert_allclose(full(structure.stiffness), STIFFNESS)
    if damping is None:
        assert structure.damping is None
    else:
        np.testing.assert_allclose(full(structure.damping), damping)


def full(matrix) -> np.ndarray:
    return matrix if isinstance(matrix, np.ndarray) else matrix.toarray()


@pytest.mark.parametrize("form", [np.array, csc_array], ids=["dense", "sparse"])
def test_what_is_written_is_read(tmp_path: Path, form) -> None:
    write_structure(Structure(form(MASS), form(STIFFNESS), Dofs(NAMES), form(0.1 * MASS)), tmp_path / "a.npz")
    same(read_structure(tmp_path / "a.npz"), damping=0.1 * MASS)


def test_arrays_of_numpy_with_other_names(tmp_path: Path) -> None:
    np.savez(tmp_path / "a.npz", M=MASS, stiff=STIFFNESS)
    same(read_structure(tmp_path / "a.npz", {"stiffness": "stiff"}, directions=("x", "y", "z")), ("1.x", "1.y", "1.z"))


def test_matrix_market_files(tmp_path: Path) -> None:
    mmwrite(tmp_path / "one.mtx", coo_matrix(MASS))
    mmwrite(tmp_path / "two.mtx", STIFFNESS)
    files = {"mass": tmp_path / "one.mtx", "stiffness": tmp_path / "two.mtx"}
    same(read_structure(files, dofs=NAMES))


@pytest.mark.parametrize("half", [np.tril, np.triu, np.array], ids=["lower", "upper", "all"])
def test_abaqus_matrix_input(tmp_path: Path, half) -> None:
    numbers = [(4, 1), (4, 3), (7, 5)]
    for name, matrix in (("job_STIF2", STIFFNESS), ("job_MASS2", MASS)):
        entries = [
            f"{numbers[i][0]},{numbers[i][1]}, {numbers[j][0]},{numbers[j][1]},  {value:.16e}"
            for (i, j), value in np.ndenumerate(half(matrix))
            if value
        ]
        (tmp_path / f"{name}.mtx").write_text("\n".join(entries) + "\n")
    files = {"stiffness": tmp_path / "job_STIF2.mtx", "mass": tmp_path / "job_MASS2.mtx"}
    same(read_structure(files))


def test_abaqus_nodes_without_mass(tmp_path: Path) -> None:
    (tmp_path / "k.mtx").write_text("1,1,1,1,2.0\n2,1,1,1,-1.0\n2,1,2,1,3.0\n")
    (tmp_path / "m.mtx").write_text("2,1,2,1,7.0\n")
    structure = read_structure({"stiffness": tmp_path / "k.mtx", "mass": tmp_path / "m.mtx"})
    assert structure.dofs.names == ("1.x", "2.x")
    np.testing.assert_array_equal(full(structure.mass), np.diag([0.0, 7.0]))
    np.testing.assert_array_equal(full(structure.stiffness), [[2.0, -1.0], [-1.0, 3.0]])


def calculix(folder: Path) -> Path:
    for suffix, matrix in ((".sti", STIFFNESS), (".mas", MASS)):
        upper = [f"{i + 1} {j + 1} {value:.13e}" for (i, j), value in np.ndenumerate(np.triu(matrix)) if value]
        (folder / f"job{suffix}").write_text("\n".join(upper))
    (folder / "job.dof").write_text("4.1\n4.3\n7.5\n")
    return folder / "job.sti"


def test_calculix_matrix_storage(tmp_path: Path) -> None:
    same(read_structure(calculix(tmp_path)))
    (tmp_path / "job.dof").unlink()
    sentence = f"{tmp_path / 'job.sti'}: beside it job.dof is missing, in which CalculiX says which row is which"
    with pytest.raises(DataError, match=says(sentence)):
        read_structure(tmp_path / "job.sti")


def test_mat_files(tmp_path: Path) -> None:
    savemat(tmp_path / "a.mat", {"M": MASS, "K": coo_matrix(STIFFNESS), "C": 0.2 * MASS, "title": "a bracket"})
    same(read_structure(tmp_path / "a.mat", dofs=NAMES), damping=0.2 * MASS)


@pytest.mark.parametrize("binary", [True, False], ids=["binary", "text"])
def test_nastran_output4(tmp_path: Path, binary: bool) -> None:
    with np.printoptions():  # its import changes how NumPy prints
        from pyyeti.nastran import op4
    op4.write(str(tmp_path / "a.op4"), {"MAA": MASS, "KAA": STIFFNESS}, binary=binary)
    same(read_structure(tmp_path / "a.op4", dofs=NAMES))


def test_nastran_dmig(tmp_path: Path) -> None:
    numbers = [(4, 1), (4, 3), (7, 5)]
    lines = []
    for name, matrix in (("KAA", STIFFNESS), ("MAA", MASS)):
        lines.append(f"DMIG    {name:<8}{0:>8}{6:>8}{2:>8}{0:>8}")
        for column, (node, component) in enumerate(numbers):
            lines.append(
                f"DMIG*   {name:<16s}        {node:>16}{component:>16}".replace(" " * 8 + f"{node:>16}", f"{node:>16}")
            )
            lines += [
                f"*       {numbers[row][0]:>16}{numbers[row][1]:>16}{matrix[row, column]:>16.9E}"
                for row in range(column, 3)
                if matrix[row, column]
            ]
    (tmp_path / "a.pch").write_text("\n".join(lines) + "\n")
    same(read_structure(tmp_path / "a.pch"))


def test_ansys_full_files(tmp_path: Path, monkeypatch) -> None:
    """The library gives upper triangles, nodes with directions from 0, and zeros where a node is held."""

    def upper(matrix: np.ndarray) -> csc_array:
        return csc_array(np.insert(np.insert(np.triu(matrix), 1, 0.0, axis=0), 1, 0.0, axis=1))

    file = SimpleNamespace(
        const=np.array([[4, 1]]),
        load_km=lambda as_sparse, sort: (np.array([[4, 0], [4, 1], [4, 2], [7, 4]]), upper(STIFFNESS), upper(MASS)),
    )
    (tmp_path / "file.full").write_bytes(b"")
    monkeypatch.setitem(sys.modules, "ansys", SimpleNamespace(__path__=[]))
    monkeypatch.setitem(sys.modules, "ansys.mapdl", SimpleNamespace(__path__=[]))
    monkeypatch.setitem(sys.modules, "ansys.mapdl.reader", SimpleNamespace(read_binary=lambda path: file))
    same(read_structure(tmp_path / "file.full"))


def test_the_full_file_that_comes_with_the_library_of_ansys() -> None:
    """A clamped beam of 63 held and 900 free degrees of freedom."""
    reader = pytest.importorskip("ansys.mapdl.reader")
    beam = read_structure(Path(reader.__file__).parent / "examples" / "file.full")
    assert beam.size == 900
    assert np.all(np.diff(eigenmodes(beam, 6).frequencies) >= 0)


@pytest.mark.parametrize(
    ("suffix", "module", "package", "what", "extra"),
    [
        (".op4", "pyyeti.nastran.op4", "pyyeti", "OP4 files", "nastran"),
        (".pch", "pyyeti.nastran.bulk", "pyyeti", "DMIG entries", "nastran"),
        (".full", "ansys.mapdl.reader", "ansys-mapdl-reader", "full files of ANSYS", "ansys"),
    ],
)
def test_a_missing_library_is_told(tmp_path: Path, monkeypatch, suffix, module, package, what, extra) -> None:
    path = tmp_path / f"a{suffix}"
    path.write_bytes(b"")
    monkeypatch.setitem(sys.modules, module, None)
    sentence = (
        f"{path}: {package} is needed to read {what}, and is not installed; run: pip install 'dalembert[{extra}]'"
    )
    with pytest.raises(DataError, match=says(sentence)):
        read_structure(path)


def test_files_that_do_not_fit_are_told(tmp_path: Path) -> None:
    np.savez(tmp_path / "a.npz", M=MASS, stiff=STIFFNESS)
    path = tmp_path / "a.npz"
    sentence = (
        f"{path}: no stiffness matrix is found; name it, such as names={{'stiffness': NAME}}; the file has M, stiff"
    )
    with pytest.raises(DataError, match=says(sentence)):
        read_structure(path)
    with pytest.raises(
        DataError, match=says("read_structure: stiffness: unknown matrix 'stif'; did you mean 'stiff'?")
    ):
        read_structure(path, {"stiffness": "stif"})
    with pytest.raises(
        InputError, match=says("read_structure: unknown role of a matrix 'stif'; did you mean 'stiffness'?")
    ):
        read_structure(path, {"stif": "stiff"})
    with pytest.raises(
        InputError,
        match=says("read_structure: no file is given for the mass; expected files for mass and stiffness"),
    ):
        read_structure({"stiffness": path}, {"stiffness": "stiff"})
    sentence = "read_structure: the matrices have 3 rows, which is no multiple of the 2 directions x, y of each node"
    with pytest.raises(InputError, match=says(sentence)):
        read_structure(path, {"stiffness": "stiff"}, directions=("x", "y"))
    with pytest.raises(InputError, match=says("write_structure: a.txt does not end in .npz, which is what is written")):
        write_structure(Structure(MASS, STIFFNESS, Dofs(NAMES)), "a.txt")


def test_files_of_no_known_kind_and_damaged_ones_are_told(tmp_path: Path) -> None:
    (tmp_path / "a.xls").write_bytes(b"")
    sentence = (
        f"{tmp_path / 'a.xls'}: matrices are not read from .xls files; known: "
        ".npz, .mtx, .sti, .mas, .mat, .op4, .pch, .bdf, .dmig, .full"
    )
    with pytest.raises(DataError, match=says(sentence)):
        read_structure(tmp_path / "a.xls")
    (tmp_path / "b.mtx").write_text("1,1,1,1,2.0\n1,9,1,1,1.0\n")
    with pytest.raises(DataError, match=says(f"{tmp_path / 'b.mtx'}: node 1 has the direction 9; expected 1 to 6")):
        read_structure({"mass": tmp_path / "b.mtx"})
    (tmp_path / "c.npz").write_bytes(b"nonsense")
    with pytest.raises(DataError, match=r"c\.npz: cannot be read as matrices \(\.npz\) \("):
        read_structure(tmp_path / "c.npz")
    with pytest.raises(DataError, match=says(f"folder {tmp_path}: unknown file 'd.npz'; did you mean 'c.npz'?")):
        read_structure(tmp_path / "d.npz")
    import h5py

    with h5py.File(tmp_path / "e.mat", "w") as file:
        file["M"] = MASS
    sentence = f"{tmp_path / 'e.mat'}: it is a MAT file of version 7.3; save it in MATLAB with save(..., '-v7')"
    with pytest.raises(DataError, match=says(sentence)):
        read_structure(tmp_path / "e.mat")


def test_a_damping_matrix_named_d_is_read_and_others_are_not_dropped_silently(tmp_path: Path) -> None:
    mass, stiffness, damping = np.eye(2), 3 * np.eye(2), 0.1 * np.eye(2)
    path = tmp_path / "own.npz"
    np.savez(path, M=mass, K=stiffness, D=damping)
    np.testing.assert_array_equal(read_structure(path).damping, damping)
    for further in ({"C": mass, "D": damping}, {"DD": damping}):
        np.savez(path, M=mass, K=stiffness, **further)
        with pytest.raises(DataError, match=r"it is not known what the matrix '[CD]+' is\. Name the matrices to read"):
            read_structure(path)
        left = read_structure(path, names={"mass": "M", "stiffness": "K"})
        if "DD" in further:
            assert left.damping is None
    np.testing.assert_array_equal(read_structure(path, names={"damping": "DD"}).damping, damping)
