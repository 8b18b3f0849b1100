from pathlib import Path

import numpy as np
import pytest
import xarray as xr

from dalembert.contents import Contents
from dalembert.files import write_contents


def contents(steps: int) -> Contents:
    """Arrays of every kind that a result may hold."""
    return Contents(
        {
            "positions": (("time", "axis"), np.arange(6.0).reshape(3, 2), {"units": "m", "count": 2}),
            "gaps": ("time", [1.0, np.nan, np.inf]),
            "counts": ("step", np.arange(steps)),
            "failed": ("time", [True, False, True]),
            "small": ("time", np.array([1, -1, 0], dtype=np.int8)),
            "mass": ((), 2.5),
            "what": ("time", ["", "Grüße", "x"]),
        },
        {
            "time": ("time", [0.0, 0.5, 1.0], {"units": "s"}),
            "axis": ("axis", ["x", "y"]),
            "label": ("axis", ["along", "across"]),
            "place": (("time", "axis"), np.ones((3, 2))),
        },
        {"format": "test 1", "text": "ü" * 100_000, "number": 3, "size": 0.1},
    )


@pytest.mark.parametrize("steps", [0, 4])
def test_xarray_reads_the_file_as_the_dataset(tmp_path: Path, steps: int) -> None:
    write_contents(tmp_path / "a.nc", contents(steps))
    read, expected = xr.load_dataset(tmp_path / "a.nc", engine="h5netcdf"), contents(steps).to_xarray()
    xr.testing.assert_identical(read, expected)
    for name in expected.variables:  # texts are objects to some versions of xarray
        assert read[name].dtype.kind.replace("O", "U") == expected[name].dtype.kind
