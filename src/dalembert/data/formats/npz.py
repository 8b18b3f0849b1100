"""Columns of NumPy files: arrays by name (NPZ), or one array (NPY)."""

from pathlib import Path

import numpy as np

from dalembert.data.array_parts import parts, spread
from dalembert.data.columns import Columns, chosen, of_numbers
from dalembert.data.format import Format, Request
from dalembert.data.opening import reading


class Npz(Format):
    """NPZ and NPY of NumPy: vectors by name, columns of a matrix as ``q[:,0]``, fields of records as ``run.x``."""

    name = "npz"
    suffixes = (".npz", ".npy")

    def columns(self, path: Path, request: Request) -> Columns:
        table, time = spread(_columns(path), request.along), request.along
        return Columns(path, time or "sample", *chosen(path, table, time, request.labels, request.missing))

    def all_columns(self, path: Path) -> dict[str, tuple[np.ndarray, str]]:
        return {name: (array, "") for name, array in of_numbers(parts(_columns(path))).items()}


def _columns(path: Path) -> dict[str, np.ndarray]:
    with reading(path, "NPZ"), path.open("rb") as stream:
        loaded = np.load(stream, allow_pickle=False)
        arrays = {"array": loaded} if isinstance(loaded, np.ndarray) else {name: loaded[name] for name in loaded.files}
    columns: dict[str, np.ndarray] = {}
    for name, array in arrays.items():
        fields = array.dtype.names
        columns |= {f"{name}.{field}": array[field] for field in fields} if fields else {name: np.squeeze(array)}
    return {name: array for name, array in columns.items() if array.ndim}
