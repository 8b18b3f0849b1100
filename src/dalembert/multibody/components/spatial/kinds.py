"""Kinds of components between two markers."""

from typing import Any

from dalembert.kernels.kernel import inlined
from dalembert.multibody.components.spatial import spatial_pairs as pairs
from dalembert.multibody.kernels.kind import Kind


def pair_kind(
    name: str, home: str, numbers: tuple[str, ...] = (), integers: tuple[str, ...] = (), **properties: Any
) -> Kind:
    """A kind with the columns of two markers, then its own ones.

    ``home``: module that holds it.
    """
    return Kind(
        name,
        coordinates=pairs.COORDINATES,
        numbers=(*pairs.NUMBERS, *numbers),
        integers=(*pairs.INTEGERS, *integers),
        charts=pairs.CHARTS,
        home=home,
        **properties,
    )


def sensor_kind(name: str, home: str, **properties: Any) -> Kind:
    """A kind with the columns of two markers, then its own ones, that exerts no force.

    ``home``: module that holds it.
    """
    return pair_kind(name, home, residual=no_residual, energy=no_energy, **properties)


@inlined
def no_residual(x, v, a, p, m, inputs, r):
    """No force."""


@inlined
def no_energy(x, v, p, m, inputs):
    return 0.0 * x[0], 0.0 * x[0], 0.0 * x[0]
