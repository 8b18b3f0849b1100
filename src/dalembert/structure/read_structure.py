"""Read and write structures."""

from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np
from scipy.sparse import csc_array, issparse

from dalembert.errors import DataError, InputError, require_known, shown, unknown
from dalembert.files import replacing
from dalembert.structure.dofs import Dofs
from dalembert.structure.matrix_files import NamedMatrix, matrices
from dalembert.structure.structure import OPTIONAL, Matrix, Structure

ROLES = {
    "mass": ("mass", "m", "maa", "mgg"),
    "stiffness": ("stiffness", "k", "kaa", "kgg"),
    "damping": ("damping", "c", "d", "baa", "bgg"),
    "loss": ("loss", "k4aa", "k4gg"),
    "gyroscopic": ("gyroscopic",),
    "circulatory": ("circulatory",),
}
"""What matrices are usually called in files, in small letters; the last ones are Nastran's."""


def read_structure(
    path: str | Path | Mapping[str, str | Path],
    names: Mapping[str, str] | None = None,
    dofs: Sequence[str] | None = None,
    directions: Sequence[str] = ("x",),
) -> Structure:
    """Read a structure whose matrices another program has written.

    ========================  ======================================================================================
    file                      what is read
    ========================  ======================================================================================
    ``.npz``                  arrays of NumPy; what :func:`write_structure` wrote, with the names of its rows
    ``.mtx``                  Matrix Market, or ``*MATRIX OUTPUT, FORMAT=MATRIX INPUT`` of Abaqus; one matrix a file
    ``.mat``                  full or sparse matrices of MATLAB, up to version 7
    ``.op4``                  OUTPUT4 of Nastran (extra ``nastran``)
    ``.pch`` ``.bdf``         DMIG entries of Nastran (extra ``nastran``); also ``.dmig``
    ``.sti`` ``.mas``         ``SOLVER=MATRIXSTORAGE`` of CalculiX, both and the ``.dof`` beside them
    ``.full``                 full files of ANSYS (extra ``ansys``)
    ========================  ======================================================================================

    Parameters
    ----------
    path : path, or mapping of str to path
        One file with all matrices, or files for "mass", "stiffness" and, if there are, "damping", "loss" (hysteretic
        damping), "gyroscopic" and "circulatory" (of a rotor, with all entries). The imaginary part of a complex
        stiffness becomes the loss matrix.
    names : mapping of str to str, optional
        Which matrix of the file is which, such as ``{"mass": "MXX"}``; the usual ones (mass, M, MAA, …) are found.
        Without it, a matrix of the same size that is none of these is an error; with it, such a matrix is left out.
    dofs : sequence of str, optional
        Names of the rows, where the file has none.
    directions : sequence of str
        Where neither has any: the directions of each node, and nodes are numbered from 1.

    Returns
    -------
    Structure

    Raises
    ------
    DataError
        For a file that is missing, damaged, of no known kind, without a mass or stiffness matrix, with further matrices
        of the same size, or whose library is not installed.
    InputError
        For names that are no roles, and matrices that make no structure.

    Examples
    --------
    >>> import tempfile
    >>> from dalembert.structure import lumped, write_structure
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     write_structure(lumped({"a": 2.0}, [("a", None, 8.0, 0.0)]), Path(folder) / "bob.npz")
    ...     read_structure(Path(folder) / "bob.npz").dofs.names
    ('a.x',)
    """
    if not isinstance(path, str | Path | Mapping):
        raise InputError(f"read_structure: path is {shown(path)}; expected a path, or a mapping from matrices to paths")
    files = path if isinstance(path, Mapping) else dict.fromkeys(ROLES, path)
    names = names or {}
    for role in (*files, *names):
        require_known("role of a matrix", role, ROLES, "read_structure")
    single_file = not isinstance(path, Mapping)
    read = {file: matrices(Path(file)) for file in dict.fromkeys(files.values())}
    matrices_by_role = {}
    for role, file in files.items():
        matrix = _of_role(role, read[file], names.get(role), alone=not single_file)
        if matrix is not None:
            matrices_by_role[role] = matrix
        elif role not in OPTIONAL or not single_file:
            raise DataError(
                f"{file}: no {role} matrix is found; name it, such as names={{{role!r}: NAME}}; the file has "
                f"{', '.join(read[file]) or 'no square matrices'}"
            )
    if single_file and not names:
        _require_all_read(path, read[path], matrices_by_role)  # pyright: ignore[reportArgumentType]
    rows = _rows(matrices_by_role, dofs, directions)
    aligned = {role: _aligned(matrix, rows) for role, matrix in matrices_by_role.items()}
    for role in ("mass", "stiffness"):
        if role not in aligned:
            raise InputError(f"read_structure: no file is given for the {role}; expected files for mass and stiffness")
    return Structure(dofs=Dofs(rows), **_split(aligned))


def write_structure(structure: Structure, path: str | Path) -> None:
    """Matrices and names of degrees of freedom in an NPZ file, for :func:`read_structure`; nodes are not kept.

    Parameters
    ----------
    structure : Structure
    path : path
        Ends in .npz.

    Raises
    ------
    InputError
        For another ending, or where there is no folder to write to.
    """
    arrays: dict[str, np.ndarray] = {"dofs": np.array(structure.dofs.names)}
    for role in ROLES:
        matrix = getattr(structure, role)
        if issparse(matrix):
            columns = csc_array(matrix)
            arrays |= {f"{role}.{part}": getattr(columns, part) for part in ("data", "indices", "indptr")}
        elif matrix is not None:
            arrays[role] = matrix
    if Path(path).suffix != ".npz":
        raise InputError(f"write_structure: {path} does not end in .npz, which is what is written")
    with replacing(path) as temporary:
        np.savez(temporary, **arrays)  # type: ignore[arg-type]


def _of_role(role: str, matrices: Mapping[str, NamedMatrix], name: str | None, alone: bool) -> NamedMatrix | None:
    """The matrix of a file for a role: the named one, the only one of a separate file, or one with a usual name."""
    if name is not None:
        if name not in matrices:
            raise DataError(unknown("matrix", name, matrices, f"read_structure: {role}"))
        return matrices[name]
    if alone and len(matrices) == 1:
        return next(iter(matrices.values()))
    usual = [matrix for key, matrix in matrices.items() if key.lower() in ROLES[role]]
    return usual[0] if len(usual) == 1 else None


def _require_all_read(file: str | Path, matrices: Mapping[str, NamedMatrix], chosen: Mapping[str, NamedMatrix]) -> None:
    sizes, read = {matrix.matrix.shape for matrix in chosen.values()}, list(chosen.values())
    left = [
        name
        for name, matrix in matrices.items()
        if matrix.matrix.shape in sizes and not any(matrix is used for used in read)
    ]
    if left:
        known = {
            role: next(name for name, matrix in matrices.items() if matrix is used) for role, used in chosen.items()
        }
        raise DataError(
            f"{file}: it is not known what the matrix {left[0]!r} is. Name the matrices to read, such as "
            f"names={known | {'damping': left[0]}}, or names={known} to leave it out"
        )


def _rows(chosen: Mapping[str, NamedMatrix], dofs: Sequence[str] | None, directions: Sequence[str]) -> tuple[str, ...]:
    if dofs is not None:
        return tuple(dofs)
    named = [name for matrix in chosen.values() for name in matrix.dofs or ()]
    if named:
        return tuple(dict.fromkeys(named))
    size = next(iter(chosen.values())).matrix.shape[0]
    if size % len(directions):
        raise InputError(
            f"read_structure: the matrices have {size} rows, which is no multiple of the {len(directions)} directions "
            f"{', '.join(directions)} of each node"
        )
    return tuple(f"{node}.{direction}" for node in range(1, size // len(directions) + 1) for direction in directions)


def _split(aligned: Mapping[str, Matrix]) -> dict[str, Matrix]:
    """Real matrices, the imaginary part of the stiffness as the loss."""
    real = dict(aligned)
    for role, matrix in aligned.items():
        if not np.iscomplexobj(matrix):
            continue
        real[role], imaginary = matrix.real, matrix.imag
        if not abs(imaginary).max():
            continue
        if role != "stiffness" or "loss" in aligned:
            raise DataError(
                f"read_structure: the {role} matrix has imaginary parts up to {abs(imaginary).max():.3g}; expected a "
                "real one. Only a stiffness may be complex, if there is no loss matrix: its imaginary part is the loss"
            )
        real["loss"] = imaginary
    return real


def _aligned(matrix: NamedMatrix, rows: tuple[str, ...]) -> Matrix:
    """The matrix in the order of all rows, with zeros where its file does not name them."""
    if matrix.dofs is None or matrix.dofs == rows or set(matrix.dofs) - set(rows):
        return matrix.matrix
    place = {name: row for row, name in enumerate(rows)}
    spread = csc_array(
        (np.ones(len(matrix.dofs)), ([place[name] for name in matrix.dofs], np.arange(len(matrix.dofs)))),
        shape=(len(rows), len(matrix.dofs)),
    )
    return csc_array(spread @ csc_array(matrix.matrix) @ spread.T)
