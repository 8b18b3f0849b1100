"""Kinds of components between two markers: one for a body and the ground, one for two bodies."""

from typing import Any

from dalembert.multibody.components.spatial import pairs
from dalembert.multibody.components.spatial.markers import SLOTS
from dalembert.multibody.kernels.kind import Kind

Kinds = tuple[Kind, Kind]


def pair_kinds(
    name: str, home: str, numbers: tuple[str, ...] = (), integers: tuple[str, ...] = (), **properties: Any
) -> Kinds:
    """Kinds with the columns of two markers, then their own ones.

    Parameters
    ----------
    name : str
    home : str
        Module that holds them.
    numbers, integers : tuple of str
    properties : of the kinds
    """
    kind = pair_kind(name, home, 2 * SLOTS, numbers, integers, **properties)
    return kind, kind


def pair_kind(
    name: str, home: str, coordinates: int, numbers: tuple[str, ...] = (), integers: tuple[str, ...] = (),
    **properties: Any,
) -> Kind:  # fmt: skip
    """A kind with the columns of two markers, then its own ones."""
    return Kind(
        name,
        coordinates=coordinates,
        numbers=(*pairs.NUMBERS, *numbers),
        integers=(*pairs.INTEGERS, *integers),
        charts=pairs.charts(coordinates),
        home=home,
        **properties,
    )
