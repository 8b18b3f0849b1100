"""Labelled arrays, and the NetCDF-4 file of them.

`xarray` reads such files, and has everything that users do with labelled arrays. To write one does without it, since
loading it takes as long as a small study.
"""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    from xarray import Dataset


@dataclass(frozen=True, eq=False)
class Contents:
    """Arrays with named dimensions, and attributes: what a result consists of. ``variables`` and ``coordinates`` have
    the name of the dimension (or a tuple of names), the values and, if there are any, attributes:
    ``{"x": ("time", [0.0, 1.0], {"units": "m"})}``. Values of ``attributes`` are str, int or float.
    """

    variables: Mapping[str, tuple]
    coordinates: Mapping[str, tuple] = field(default_factory=dict)
    attributes: Mapping[str, Any] = field(default_factory=dict)

    def to_xarray(self) -> "Dataset":
        """Return the same as an :class:`xarray.Dataset`."""
        from xarray import Dataset

        return Dataset(self.variables, self.coordinates, self.attributes)

    def write(self, path: Path) -> None:
        """Write a NetCDF-4 file, which `xarray.load_dataset` reads as :meth:`to_xarray` makes it."""
        import h5netcdf

        coordinates = {name: set(over) for name, over, *_ in _entries(self.coordinates) if over != (name,)}
        with h5netcdf.File(path, "w") as file:
            for entries, are_variables in ((self.coordinates, False), (self.variables, True)):
                for name, over, values, attributes in _entries(entries):
                    labels = [label for label, needed in coordinates.items() if are_variables and needed <= set(over)]
                    _write(file, name, over, values, attributes | ({"coordinates": " ".join(labels)} if labels else {}))
            file.attrs.update(self.attributes)


def _entries(variables: Mapping[str, tuple]) -> Iterator[tuple[str, tuple[str, ...], np.ndarray, dict[str, Any]]]:
    """Name, dimensions, values and attributes of each variable."""
    for name, (over, values, *attributes) in variables.items():
        yield name, (over,) if isinstance(over, str) else tuple(over), np.asarray(values), dict(*attributes)


def _write(file: Any, name: str, over: tuple[str, ...], values: np.ndarray, attributes: dict[str, Any]) -> None:
    """Write one variable, and the dimensions that it is the first to have."""
    import h5py

    for dimension, size in zip(over, values.shape, strict=True):
        if dimension not in file.dimensions:
            file.dimensions[dimension] = size
    form = values.dtype
    if form.kind == "b":  # NetCDF has no truth values: xarray marks them in this way
        form, attributes = np.dtype(np.int8), {**attributes, "dtype": "bool"}
    elif form.kind in "UO":
        form, values = h5py.string_dtype(), values.astype(object)
    variable = file.create_variable(name, over, form)
    if values.size:
        variable[...] = values
    variable.attrs.update(attributes)
