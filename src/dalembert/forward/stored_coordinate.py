"""What samples lie along as a variable of a dataset, and back."""

from collections.abc import Mapping
from typing import TYPE_CHECKING, Annotated, Any

from dalembert.forward.model import Coordinate
from dalembert.stored_fields import Source, Store

if TYPE_CHECKING:
    from xarray import DataArray


def stored_coordinate(along: Coordinate, over: str = "sample") -> tuple[str, Any, dict[str, str]]:
    """Variable over a dimension, labelled as other programs expect it."""
    return over, along.values, {"long_name": along.name, "units": along.unit}


def coordinate_of(stored: "DataArray") -> Coordinate:
    """The coordinate that is in a dataset."""
    return Coordinate(stored.attrs["long_name"], stored.attrs["units"], stored.values)


class _Along:
    """A coordinate of samples as the coordinate ``coordinate`` of a dataset."""

    def store(self, to: Store, settings: dict[str, Any], name: str, value: Coordinate) -> None:
        to.coordinates["coordinate"] = stored_coordinate(value)

    def load(self, source: Source, settings: Mapping[str, Any], name: str) -> Coordinate:
        return coordinate_of(source.dataset["coordinate"])


StoredCoordinate = Annotated[Coordinate, _Along()]
