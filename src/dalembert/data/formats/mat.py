"""Columns of a MAT file of MATLAB: version 5 (and older), or 7.3, which is HDF5."""

from collections.abc import Iterable, Iterator, Mapping
from pathlib import Path
from typing import Any

import numpy as np

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
        arrays = _held(path)
        samples = max(map(np.size, (array for array in arrays.values() if array.ndim == 1)), default=0)
        parts = {label: part for name, array in arrays.items() for label, part in _parts(name, array, samples)}
        return {name: (array, "") for name, array in of_numbers(parts).items()}


def mat_columns(path: Path, time: str | None, names: Iterable[str] | None, missing: str) -> Columns:
    """Times and columns: vectors by name, fields of structs as ``run.x``, columns of a matrix as ``q(:,1)``.

    A matrix with a row a channel gives ``q(1,:)``. Text, cells and objects (tables, timeseries) are passed over.
    """
    held = _held(path)
    samples = len(held[time]) if time in held and held[time].ndim == 1 else 0
    spread = {label: part for name, array in held.items() for label, part in _parts(name, array, samples)}
    return Columns(path, time or "sample", *chosen(path, spread, time, names, missing))


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
    """Arrays of numbers among variables, and in the structs among them."""
    for name, value in held.items():
        if name.startswith("__"):
            continue
        if isinstance(value, Mapping):
            yield from _fields(f"{front}{name}.", value)
            continue
        array = np.asarray(value) if isinstance(value, (np.ndarray, int, float, complex)) else np.empty(0, dtype=object)
        if array.dtype.kind in "fiubc":
            yield f"{front}{name}", np.atleast_1d(array)


def _version_73(path: Path) -> list[tuple[str, np.ndarray]]:
    import h5py

    found: list[tuple[str, np.ndarray]] = []

    def look(name: str, item: Any) -> None:
        if not isinstance(item, h5py.Dataset) or name.startswith("#"):
            return
        if item.attrs.get("MATLAB_class", b"double") in (b"char", b"cell") or item.attrs.get("MATLAB_empty", 0):
            return
        array = item[()]
        if array.dtype.names == ("real", "imag"):
            array = array["real"] + 1j * array["imag"]
        if array.dtype.kind in "fiubc":
            found.append((name.replace("/", "."), np.atleast_1d(np.squeeze(array.T))))

    with h5py.File(path, "r") as file:
        file.visititems(look)
    return found


def _parts(name: str, array: np.ndarray, samples: int) -> Iterator[tuple[str, np.ndarray]]:
    """A vector as it is; a matrix as its columns, or as its rows if those are as long as the times."""
    if array.ndim != 2:
        yield name, array
    elif array.shape[1] == samples != array.shape[0]:
        yield from ((f"{name}({row},:)", part) for row, part in enumerate(array, start=1))
    else:
        yield from ((f"{name}(:,{column})", part) for column, part in enumerate(array.T, start=1))
