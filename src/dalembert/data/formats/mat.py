"""Columns of a MAT file of MATLAB: version 5 (and older), or 7.3, which is HDF5."""

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, field
from importlib.util import find_spec
from pathlib import Path
from typing import Any

import numpy as np

from dalembert.data.array_parts import parts, spread
from dalembert.data.columns import Columns, chosen, of_numbers
from dalembert.data.format import Format, Request
from dalembert.data.guarded import guarded
from dalembert.data.matlab_objects import array_of
from dalembert.data.opening import reading
from dalembert.errors import DataError


class Mat(Format):
    """MAT of MATLAB, version 5 or 7.3."""

    name = "mat"
    suffixes = (".mat",)

    def columns(self, path: Path, request: Request) -> Columns:
        return mat_columns(path, request.along, request.labels, request.missing)

    def all_columns(self, path: Path) -> dict[str, tuple[np.ndarray, str]]:
        content = _content(path)
        columns = of_numbers(parts(content.arrays, 1, "()"))
        if not columns and content.unread:
            raise DataError(f"{path}: the file has no numbers{_unread(content)}")
        return {name: (array, content.units.get(array_of(name), "")) for name, array in columns.items()}


def mat_columns(path: Path, time: str | None, names: Iterable[str] | None, missing: str) -> Columns:
    """Times and columns: vectors by name, fields of structs as ``run.x``, columns of a matrix as ``q(:,1)``. A matrix
    with a row a channel gives ``q(1,:)``; an array of structs gives ``run(1).x``, a cell ``q{1}``. Objects (tables,
    timeseries, datasets of Simulink) are read with mat-io if it is installed. Text is passed over.
    """
    content = _content(path)
    table = spread(content.arrays, time, 1, "()")
    names = None if names is None else list(names)
    if content.unread and any(name not in table for name in (*([] if time is None else [time]), *(names or ()))):
        missed = next(name for name in (time, *(names or ())) if name is not None and name not in table)
        raise DataError(f"{path}: no column {missed!r} outside of objects{_unread(content)}")
    along, columns, dated = chosen(path, table, time, names, missing)
    units = {name: content.units.get(array_of(name), "") for name in (*columns, time or "")}
    layout = "without its objects of MATLAB" if content.unread else ""
    return Columns(
        path,
        time or "sample",
        along,
        columns,
        {name: unit for name, unit in units.items() if unit} | dated,
        layout=layout,
    )


def _unread(content: "_Content") -> str:
    return (
        "; it has objects of MATLAB, such as a table, a timeseries or a dataset of Simulink, which were not read: "
        f"{content.unread}; or save vectors in MATLAB: t = logsout{{1}}.Values.Time; x = logsout{{1}}.Values.Data; "
        "save('run.mat', 't', 'x')"
    )


@dataclass(frozen=True, eq=False)
class _Content:
    """Arrays of a file and their units, and why its objects were not read; empty if they were, or if it has none."""

    arrays: Mapping[str, np.ndarray]
    units: Mapping[str, str] = field(default_factory=dict)
    unread: str = ""


def _content(path: Path) -> _Content:
    with reading(path, "MAT"):
        import h5py

        if h5py.is_hdf5(path):
            arrays, has_objects = dict(_version_73(path)), _has_subsystem(path)
        else:
            variables = version_5(path)
            arrays, has_objects = dict(_fields("", variables)), "__function_workspace__" in variables
        if not has_objects:
            return _Content(arrays)
        if find_spec("matio") is None:
            return _Content(arrays, unread="run: pip install 'dalembert[matlab]'")
        try:
            entries = guarded(path, "MAT", "dalembert.data.matlab_objects", "object_arrays")
        except (DataError, ValueError) as error:  # what is outside of objects can be read all the same
            return _Content(arrays, unread=f"mat-io cannot read them ({error})")
        new = [entry for entry in entries if entry[0] not in arrays]
        return _Content(arrays | {name: array for name, array, _ in new}, {name: unit for name, _, unit in new if unit})


def _has_subsystem(path: Path) -> bool:
    import h5py

    with h5py.File(path, "r") as file:
        return "#subsystem#" in file


def version_5(path: Path) -> dict[str, Any]:
    """All variables of a MAT file of version 5 or older, as SciPy gives them."""
    return guarded(path, "MAT", "scipy.io", "loadmat", simplify_cells=True)


def _fields(front: str, contents: Mapping[str, Any]) -> Iterator[tuple[str, np.ndarray]]:
    for name, value in contents.items():
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

    arrays: list[tuple[str, np.ndarray]] = []
    with h5py.File(path, "r") as file:

        def look(name: str, item: Any) -> None:
            if isinstance(item, h5py.Group):
                for key in map(str, item):
                    if not key.startswith("#"):
                        look(f"{name}.{key}" if name else key, item[key])
                return
            kind = item.attrs.get("MATLAB_class", b"double")
            kind = kind.decode() if isinstance(kind, bytes) else str(kind)
            if kind == "char" or item.attrs.get("MATLAB_empty", 0) or "MATLAB_object_decode" in item.attrs:
                return  # an object is saved as numbers of places elsewhere in the file
            array = item[()]
            if array.dtype.kind == "O" and h5py.check_ref_dtype(item.dtype) is h5py.Reference:
                front, _, field = name.rpartition(".")
                for number, reference in enumerate(array.T.ravel(order="F"), start=1):
                    look(f"{name}{{{number}}}" if kind == "cell" else f"{front}({number}).{field}", file[reference])
                return
            if array.dtype.names == ("real", "imag"):
                array = array["real"] + 1j * array["imag"]
            if array.dtype.kind in "fiubc":
                arrays.append((name, np.atleast_1d(np.squeeze(array.T))))

        look("", file)
    return arrays
