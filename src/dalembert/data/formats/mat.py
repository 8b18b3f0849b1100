"""Columns of a MAT file of MATLAB: version 5 (and older), or 7.3, which is HDF5."""

from collections.abc import Iterable, Iterator, Mapping
from pathlib import Path
from typing import Any

import numpy as np

from dalembert.data.array_parts import parts, spread
from dalembert.data.columns import Columns, chosen, of_numbers
from dalembert.data.format import Format, Request
from dalembert.data.guarded import guarded
from dalembert.data.opening import reading


class Mat(Format):
    """MAT of MATLAB, version 5 or 7.3."""

    name = "mat"
    suffixes = (".mat",)

    def columns(self, path: Path, request: Request) -> Columns:
        return mat_columns(path, request.along, request.labels, request.missing)

    def held(self, path: Path) -> dict[str, tuple[np.ndarray, str]]:
        return {name: (array, "") for name, array in of_numbers(parts(_held(path), 1, "()")).items()}


def mat_columns(path: Path, time: str | None, names: Iterable[str] | None, missing: str) -> Columns:
    """Times and columns: vectors by name, fields of structs as ``run.x``, columns of a matrix as ``q(:,1)``.

    A matrix with a row a channel gives ``q(1,:)``; an array of structs gives ``run(1).x``, a cell ``q{1}``. Text and
    objects (tables, timeseries, datasets of Simulink) are passed over.
    """
    return Columns(path, time or "sample", *chosen(path, spread(_held(path), time, 1, "()"), time, names, missing))


def _held(path: Path) -> dict[str, np.ndarray]:
    with reading(path, "MAT"):
        import h5py

        return dict(_version_73(path) if h5py.is_hdf5(path) else _version_5(path))


def _version_5(path: Path) -> Iterator[tuple[str, np.ndarray]]:
    yield from _fields("", version_5(path))


def version_5(path: Path) -> dict[str, Any]:
    """All variables of a MAT file of version 5 or older, as SciPy gives them."""
    return guarded(path, "MAT", "scipy.io", "loadmat", simplify_cells=True)


def _fields(front: str, held: Mapping[str, Any]) -> Iterator[tuple[str, np.ndarray]]:
    """Arrays of numbers among variables, and in the structs and cells among them."""
    for name, value in held.items():
        if not name.startswith("__"):
            yield from _entries(f"{front}{name}", value)


def _entries(name: str, value: Any) -> Iterator[tuple[str, np.ndarray]]:
    """Arrays of numbers in a variable: fields of structs ``run.x``, of arrays of them ``run(1).x``, cells ``q{1}``."""
    if isinstance(value, Mapping):
        yield from _fields(f"{name}.", value)
        return
    entries = value if isinstance(value, list) else []
    if isinstance(value, np.ndarray) and value.dtype.kind == "O":
        entries = list(value.ravel(order="F"))
    if entries and not all(isinstance(entry, int | float) for entry in entries):
        for number, entry in enumerate(entries, start=1):
            yield from _entries(f"{name}({number})" if isinstance(entry, Mapping) else f"{name}{{{number}}}", entry)
        return
    array = np.asarray(value) if isinstance(value, (np.ndarray, list, int, float, complex)) else np.empty(0, dtype="O")
    if array.dtype.kind in "fiubc":
        yield name, np.atleast_1d(array)


def _version_73(path: Path) -> list[tuple[str, np.ndarray]]:
    """Arrays of numbers in the variables of a file of version 7.3; cells and arrays of structs are references there."""
    import h5py

    found: list[tuple[str, np.ndarray]] = []
    with h5py.File(path, "r") as file:

        def look(name: str, item: Any) -> None:
            if isinstance(item, h5py.Group):
                for key in map(str, item):
                    if not key.startswith("#"):
                        look(f"{name}.{key}" if name else key, item[key])
                return
            kind = item.attrs.get("MATLAB_class", b"double")
            kind = kind.decode() if isinstance(kind, bytes) else str(kind)
            if kind == "char" or item.attrs.get("MATLAB_empty", 0):
                return
            array = item[()]
            if array.dtype.kind == "O" and h5py.check_ref_dtype(item.dtype) is h5py.Reference:
                front, _, field = name.rpartition(".")
                for number, reference in enumerate(array.T.ravel(order="F"), start=1):
                    look(f"{name}{{{number}}}" if kind == "cell" else f"{front}({number}).{field}", file[reference])
                return
            if array.dtype.names == ("real", "imag"):
                array = array["real"] + 1j * array["imag"]
            if array.dtype.kind in "fiubc":
                found.append((name, np.atleast_1d(np.squeeze(array.T))))

        look("", file)
    return found
