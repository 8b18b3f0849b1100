"""Rotors behind the gears of joints: a coordinate with a constant inertia that is tied to the joint's.

T = inertia x u'^2 / 2 with the coordinate u, and u - angle = 0 or u - displacement = 0. So the mass is constant, where
that of the same inertia by the rates of the bodies changes with their orientation.
"""

from typing import Any

from dalembert.kernels.kernel import inlined
from dalembert.multibody.components.spatial import spatial_pairs as pairs
from dalembert.multibody.components.spatial.spatial_joint import joint_angle, joint_displacement
from dalembert.multibody.kernels.charts import flat
from dalembert.multibody.kernels.elementary import wrapped
from dalembert.multibody.kernels.kind import Kind

_OWN = pairs.COORDINATES


@inlined
def _residual(x, v, a, p, m, inputs, r):
    r[0] += p.inertia * a[0]


@inlined
def _energy(x, v, p, m, inputs):
    return 0.5 * p.inertia * v[0] * v[0], 0.0 * v[0], 0.0 * v[0]


@inlined
def _turning(x, p, m, inputs, g):
    """The angle of the joint, which counts no turns, less the coordinate, which does."""
    g[0] = wrapped(joint_angle(x, p, m) - x[_OWN])


@inlined
def _sliding(x, p, m, inputs, g):
    g[0] = joint_displacement(x, p, m) - x[_OWN]


def _tie(name: str, constraint: Any) -> Kind:
    return Kind(
        name,
        coordinates=pairs.COORDINATES + 1,
        multipliers=1,
        numbers=pairs.NUMBERS,
        integers=pairs.INTEGERS,
        constraint=constraint,
        charts=(*pairs.CHARTS, flat(1)),
        home=__name__,
    )


TURNING_TIE, SLIDING_TIE = _tie("turning_tie", _turning), _tie("sliding_tie", _sliding)
ROTOR = Kind("rotor", coordinates=1, numbers=("inertia",), residual=_residual, energy=_energy, home=__name__)
TURNING_ROTOR, SLIDING_ROTOR = (TURNING_TIE, ROTOR), (SLIDING_TIE, ROTOR)
