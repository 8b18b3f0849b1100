"""What samples lie along as a variable of a dataset, and back."""

from typing import TYPE_CHECKING, Any

from dalembert.forward.model import Coordinate

if TYPE_CHECKING:
    from xarray import DataArray


def stored_coordinate(along: Coordinate, over: str = "sample") -> tuple[str, Any, dict[str, str]]:
    """Variable over a dimension, labelled as other programs expect it."""
    return over, along.values, {"long_name": along.name, "units": along.unit}


def coordinate_of(stored: "DataArray") -> Coordinate:
    """The coordinate that is in a dataset."""
    return Coordinate(stored.attrs["long_name"], stored.attrs["units"], stored.values)
