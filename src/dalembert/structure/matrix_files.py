"""Matrices in the files of other programs, with the names of their rows where the files know them."""

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from scipy.sparse import coo_array, csc_array, issparse

from dalembert.data.formats.mat import version_5
from dalembert.data.guarded import guarded
from dalembert.data.opening import library, reading
from dalembert.errors import DataError
from dalembert.structure.dofs import DIRECTIONS


@dataclass(frozen=True, eq=False)
class NamedMatrix:
    """A matrix and, where its file says so, the degrees of freedom of its rows."""

    matrix: Any
    dofs: tuple[str, ...] | None = None


Matrices = dict[str, NamedMatrix]


def _named(matrix: Any) -> NamedMatrix:
    return NamedMatrix(csc_array(matrix) if issparse(matrix) else matrix)


def npz(path: Path) -> Matrices:
    """Arrays of an NPZ file; sparse ones are NAME.data, NAME.indices and NAME.indptr by columns; dofs names rows."""
    with np.load(path, allow_pickle=False) as file:
        arrays = dict(file)
    dofs = tuple(map(str, arrays.pop("dofs"))) if "dofs" in arrays else None
    dense = {name: NamedMatrix(array, dofs) for name, array in arrays.items() if array.ndim == 2 and "." not in name}
    sparse = {}
    for name in (key.removesuffix(".indptr") for key in arrays if key.endswith(".indptr")):
        size = len(arrays[f"{name}.indptr"]) - 1
        parts = tuple(arrays[f"{name}.{part}"] for part in ("data", "indices", "indptr"))
        sparse[name] = NamedMatrix(csc_array(parts, shape=(size, size)), dofs)
    return dense | sparse


def matrix_market(path: Path) -> Matrices:
    """The one matrix of a Matrix Market file, or of Abaqus' (node, direction, node, direction, value) by lines."""
    with path.open("rb") as stream:
        first = stream.readline()
    if not first.startswith(b"%%MatrixMarket"):
        # ``*MATRIX OUTPUT, FORMAT=MATRIX INPUT``: the lower or the upper triangle, or all.
        table = np.loadtxt(path, delimiter=",", comments=["*"], ndmin=2)
        rows, columns = ([_dof(*entry) for entry in table[:, at : at + 2].astype(int)] for at in (0, 2))
        dofs = tuple(dict.fromkeys(rows + columns))
        places = {name: place for place, name in enumerate(dofs)}
        row_places, other = ([places[name] for name in names] for names in (rows, columns))
        return {path.stem: NamedMatrix(completed(row_places, other, table[:, 4], len(dofs)), dofs)}
    matrix = guarded(path, "Matrix Market", "scipy.io", "mmread")
    return {path.stem: _named(matrix)}


def calculix(path: Path) -> Matrices:
    """``SOLVER=MATRIXSTORAGE``: lines of JOB.sti and .mas are row, column, value, those of JOB.dof NODE.DIRECTION."""
    names = path.with_suffix(".dof")
    if not names.is_file():
        raise DataError(f"{path}: beside it {names.name} is missing, in which CalculiX says which row is which")
    dofs = tuple(_dof(*map(int, line.split("."))) for line in names.read_text(encoding="utf-8").split())
    matrices_by_role = {}
    for role, suffix in (("stiffness", ".sti"), ("mass", ".mas")):
        file = path.with_suffix(suffix)
        if file.is_file():
            rows, columns, values = np.loadtxt(file, ndmin=2).T
            matrices_by_role[role] = NamedMatrix(
                completed(rows.astype(int) - 1, columns.astype(int) - 1, values, len(dofs)), dofs
            )
    return matrices_by_role


def mat(path: Path) -> Matrices:
    """Full and sparse matrices of a MAT file of MATLAB, up to version 7."""
    import h5py

    if h5py.is_hdf5(path):
        raise DataError(f"{path}: it is a MAT file of version 7.3; save it in MATLAB with save(..., '-v7')")
    variables = {name: value for name, value in version_5(path).items() if not name.startswith("__")}
    return {
        name: _named(value)
        for name, value in variables.items()
        if issparse(value) or (isinstance(value, np.ndarray) and value.ndim == 2)
    }


def op4(path: Path) -> Matrices:
    """Matrices of Nastran's OUTPUT4, by pyYeti; their rows have no names."""
    matrices_read = _pyyeti("op4", path, "OP4 files").load(str(path), sparse=None)
    return {name: _named(matrix) for name, (matrix, *_) in matrices_read.items()}


def dmig(path: Path) -> Matrices:
    """DMIG entries of Nastran's bulk data or punch file, by pyYeti; scalar points (component 0) count as x."""
    entries = _pyyeti("bulk", path, "DMIG entries").rddmig(str(path))
    matrices_read = {}
    for name, table in entries.items():
        dofs = tuple(_dof(int(node), max(int(component), 1)) for node, component in table.index)
        if table.shape[0] == table.shape[1] and list(table.index) == list(table.columns):
            matrices_read[name] = NamedMatrix(csc_array(table.to_numpy()), dofs)
    return matrices_read


def _pyyeti(module: str, path: Path, what: str) -> Any:
    with np.printoptions():  # its import changes how NumPy prints
        return library(f"pyyeti.nastran.{module}", path, what, "nastran")


def ansys_full(path: Path) -> Matrices:
    """Stiffness and mass of an ANSYS full file, by ansys-mapdl-reader, without the held rows, which are zero."""
    reader = library("ansys.mapdl.reader", path, "full files of ANSYS", "ansys", "ansys-mapdl-reader")
    file = reader.read_binary(str(path))
    dofs, stiffness, mass = file.load_km(as_sparse=True, sort=False)
    clamped = {tuple(pair) for pair in np.asarray(file.const).tolist()}
    kept = [row for row, pair in enumerate(np.asarray(dofs).tolist()) if tuple(pair) not in clamped]
    names = tuple(_dof(int(dofs[row, 0]), int(dofs[row, 1]) + 1) for row in kept)
    matrices_read = {}
    for role, triangle in (("stiffness", stiffness), ("mass", mass)):
        if triangle is not None:
            pair = coo_array(csc_array(triangle)[:, kept][kept])
            matrices_read[role] = NamedMatrix(completed(pair.row, pair.col, pair.data, len(names)), names)
    return matrices_read


READERS: dict[str, Callable[[Path], Matrices]] = {
    ".npz": npz,
    ".mtx": matrix_market,
    ".sti": calculix,
    ".mas": calculix,
    ".mat": mat,
    ".op4": op4,
    ".pch": dmig,
    ".bdf": dmig,
    ".dmig": dmig,
    ".full": ansys_full,
}


def matrices(path: Path) -> Matrices:
    """Return all square matrices of a file, by name; its suffix decides how it is read."""
    reader = READERS.get(path.suffix.lower())
    if reader is None:
        raise DataError(
            f"{path}: matrices are not read from {path.suffix or 'such'} files; known: {', '.join(READERS)}"
        )
    with reading(path, f"matrices ({path.suffix})"):
        matrices_read = reader(path)
    return {name: matrix for name, matrix in matrices_read.items() if matrix.matrix.shape[0] == matrix.matrix.shape[1]}


def completed(rows: Iterable[int], columns: Iterable[int], values: np.ndarray, size: int) -> csc_array:
    """A matrix from entries; where one of a pair (i, j), (j, i) is missing, it is that of a symmetric matrix."""
    where = (np.asarray(rows), np.asarray(columns))
    entries = csc_array(coo_array((values, where), shape=(size, size)))
    known = csc_array(coo_array((np.ones(len(values)), where), shape=(size, size)))
    known.data[:] = 1.0  # an entry that comes in parts counts once
    missing = csc_array(known.T - known.T * known)
    return csc_array(entries + entries.T * missing)


def _dof(node: int, direction: int) -> str:
    if not 1 <= direction <= 6:
        raise DataError(f"node {node} has the direction {direction}; expected 1 to 6")
    return f"{node}.{DIRECTIONS[direction - 1]}"
