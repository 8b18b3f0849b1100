"""Columns of a NetCDF file, version 3 or 4."""

import re
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from dalembert.data.columns import Columns, chosen, of_numbers
from dalembert.data.format import Format, Request
from dalembert.data.opening import reading
from dalembert.errors import DataError, unknown

if TYPE_CHECKING:
    from xarray import Dataset


class Netcdf(Format):
    """NetCDF, version 3 or 4."""

    name = "netcdf"
    suffixes = (".nc", ".nc4", ".cdf")

    def columns(self, path: Path, request: Request) -> Columns:
        return netcdf_columns(path, request.along, request.labels, request.missing)

    def all_columns(self, path: Path) -> dict[str, tuple[np.ndarray, str]]:
        dataset = _dataset(path)
        along = next((str(name) for name, variable in dataset.variables.items() if variable.dims == (name,)), "")
        parts = [part for name in dataset.variables for part in _parts(dataset, name, along)]
        kept = of_numbers({label: array for label, array, _ in parts})
        return {label: (array, unit) for label, array, unit in parts if label in kept}


def netcdf_columns(path: Path, time: str | None, names: Iterable[str] | None, missing: str) -> Columns:
    """Times and columns: variables along the times' dimension, each with the unit that its ``units`` attribute names. A
    variable over another dimension too gives a column an entry: ``response[AB.end.x]`` where that dimension has labels,
    else ``q[0]``.
    """
    dataset = _dataset(path)
    arrays = [(label, array, unit) for name in dataset.variables for label, array, unit in _parts(dataset, name, time)]
    if time is not None and time not in dataset.variables:
        raise DataError(unknown("column", time, map(str, dataset.variables), str(path)))
    along, table, dated = chosen(path, {label: array for label, array, _ in arrays}, time, names, missing)
    units = {label: unit for label, _, unit in arrays if unit and (label in table or label == time)}
    return Columns(path, time or "sample", along, table, units | dated)


def _dataset(path: Path) -> "Dataset":
    with reading(path, "NetCDF"):
        import h5py
        from xarray import load_dataset

        engine = "h5netcdf" if h5py.is_hdf5(path) else "scipy"
        if engine == "h5netcdf":
            h5py.File(path, "r").close()  # what fails here would leave h5netcdf half made
        return load_dataset(path, engine=engine, decode_times=False)


def _parts(dataset: "Dataset", name: object, time: str | None) -> Iterator[tuple[str, np.ndarray, str]]:
    variable = dataset.variables[name]  # pyright: ignore[reportArgumentType]
    along = dataset.variables[time].dims[:1] if time in dataset.variables else ()
    unit = _unit(str(variable.attrs.get("units", "")))
    if variable.ndim == 2 and along and along[0] in variable.dims:
        (other,) = (dimension for dimension in variable.dims if dimension != along[0])
        labels = dataset.variables[other].values if other in dataset.variables else range(variable.sizes[other])
        for label, part in zip(labels, variable.transpose(other, along[0]).values, strict=True):
            yield f"{name}[{label}]", part, unit
    else:
        yield str(name), np.atleast_1d(variable.values), unit


def _unit(text: str) -> str:
    """A unit as the convention for NetCDF writes it, ``m s-2`` or ``seconds since 2020-01-01``, as we do.

    >>> _unit("m s-2"), _unit("seconds since 2020-01-01"), _unit("kg m^2"), _unit("degrees")
    ('m s^-2', 'seconds', 'kg m^2', 'degrees')
    """
    return re.sub(r"(?<=[A-Za-z])(-?\d)", r"^\1", text.partition(" since ")[0].strip())
