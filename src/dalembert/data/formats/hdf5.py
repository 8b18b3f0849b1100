"""Columns of an HDF5 file of any program."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

from dalembert.data.array_parts import parts, spread
from dalembert.data.columns import Columns, chosen, of_numbers
from dalembert.data.format import Format, Request
from dalembert.data.opening import reading


class Hdf5(Format):
    """HDF5: datasets by path, ``run/x``; columns of a matrix as ``run/q[:,0]``, fields of records as ``run/log.x``."""

    name = "hdf5"
    suffixes = (".h5", ".hdf5", ".hdf", ".he5")

    def columns(self, path: Path, request: Request) -> Columns:
        arrays, units = _columns(path)
        table = spread(arrays, request.along)
        along, columns, dated = chosen(path, table, request.along, request.labels, request.missing)
        named = {label: units[_array(label)] for label in (*columns, request.along or "") if _array(label) in units}
        return Columns(path, request.along or "sample", along, columns, named | dated)

    def all_columns(self, path: Path) -> dict[str, tuple[np.ndarray, str]]:
        arrays, units = _columns(path)
        return {name: (array, units.get(_array(name), "")) for name, array in of_numbers(parts(arrays)).items()}


def _array(label: str) -> str:
    return label.partition("[")[0]


def _columns(path: Path) -> tuple[dict[str, np.ndarray], dict[str, str]]:
    import h5py

    arrays: dict[str, np.ndarray] = {}
    units: dict[str, str] = {}

    def look(name: str, item: Any) -> None:
        if not isinstance(item, h5py.Dataset) or item.shape is None:
            return
        array = np.asarray(item[()])
        fields = (
            {f"{name}.{field}": array[field] for field in array.dtype.names} if array.dtype.names else {name: array}
        )
        for label, part in fields.items():
            if part.dtype.kind in "fiubc" and part.ndim:
                arrays[label] = np.squeeze(part) if part.ndim > 1 and part.size > 1 else part
                if unit := _unit(item.attrs):
                    units[label] = unit

    with reading(path, "HDF5"), h5py.File(path, "r") as file:
        file.visititems(look)
    return arrays, units


def _unit(attributes: Mapping[str, Any]) -> str:
    unit = next((attributes[key] for key in ("units", "unit", "Unit", "Units") if key in attributes), "")
    return unit.decode(errors="replace") if isinstance(unit, bytes) else unit if isinstance(unit, str) else ""
