"""Inertial sensors: accelerometer and gyroscope at a marker, in its axes."""

__all__ = ["InertialSensor"]

from dataclasses import dataclass, field
from typing import Any

import numpy as np

from dalembert.arguments import array_of
from dalembert.errors import InputError, shown
from dalembert.findings import Finding
from dalembert.kernels.kernel import inlined
from dalembert.multibody.components.fields import Number, number
from dalembert.multibody.components.points import Point, require_direction
from dalembert.multibody.components.spatial.kinds import sensor_kind
from dalembert.multibody.components.spatial.orientation import Vector
from dalembert.multibody.components.spatial.spatial_load import Load
from dalembert.multibody.components.spatial.spatial_markers import position_rate, spin
from dalembert.multibody.components.spatial.spatial_pairs import a_point, along_axes
from dalembert.multibody.components.spatial.spatial_rows import SpatialRows
from dalembert.multibody.components.spatial.vectors import combined, minus, plus

_GRAVITY = ("gravity_x", "gravity_y", "gravity_z")


def _columns(name: str) -> tuple[str, ...]:
    """Names of the columns of an instrument: its bias, and its gain column by column."""
    return (*(f"{name}_bias_{k}" for k in (1, 2, 3)), *(f"{name}_gain_{i}{k}" for k in (1, 2, 3) for i in (1, 2, 3)))


@inlined
def _observe(x, v, a, p, m, inputs, out):
    """Bias + gain R^T (a - g), and bias + gain R^T omega."""
    gravity = (p.gravity_x, p.gravity_y, p.gravity_z)
    force = along_axes(minus(position_rate(m.a_kind, 0, a, a_point(p)), gravity), x, p, m)
    first = (p.acceleration_gain_11, p.acceleration_gain_21, p.acceleration_gain_31)
    second = (p.acceleration_gain_12, p.acceleration_gain_22, p.acceleration_gain_32)
    third = (p.acceleration_gain_13, p.acceleration_gain_23, p.acceleration_gain_33)
    bias = (p.acceleration_bias_1, p.acceleration_bias_2, p.acceleration_bias_3)
    out[0], out[1], out[2] = plus(bias, combined(force, first, second, third))
    rate = along_axes(spin(m.a_kind, 0, x, v), x, p, m)
    first = (p.rate_gain_11, p.rate_gain_21, p.rate_gain_31)
    second = (p.rate_gain_12, p.rate_gain_22, p.rate_gain_32)
    third = (p.rate_gain_13, p.rate_gain_23, p.rate_gain_33)
    bias = (p.rate_bias_1, p.rate_bias_2, p.rate_bias_3)
    out[3], out[4], out[5] = plus(bias, combined(rate, first, second, third))


INERTIAL_SENSOR = sensor_kind(
    "inertial_sensor",
    __name__,
    numbers=(*_GRAVITY, *_columns("acceleration"), *_columns("rate")),
    outputs=(
        *((f"accelerometer_{axis}", "m/s**2") for axis in "xyz"),
        *((f"gyroscope_{axis}", "rad/s") for axis in "xyz"),
    ),
    observe=_observe,
)


@dataclass(frozen=True)
class InertialSensor(Load):
    """An accelerometer and a gyroscope at a marker of a rigid body, in the axes of the marker.

    Accelerometer = bias + gain R^T (a - g), gyroscope = bias + gain R^T omega, with the acceleration a of the marker,
    the gravity g, the angular velocity omega, and the axes of the marker as the columns of R. The pose of the sensor is
    that of the marker. The sensor exerts no force.

    Parameters
    ----------
    name : str
    at : Point
    acceleration_bias : (float, float, float)
        m/s^2.
    acceleration_gain : (float, float, float), or (3, 3)
        Of each axis, or a matrix with cross-sensitivities beside its diagonal.
    rate_bias : (float, float, float)
        rad/s.
    rate_gain : (float, float, float), or (3, 3)

    Raises
    ------
    InputError
        For gains that are neither three numbers nor a matrix (3, 3).

    Notes
    -----
    Outputs: ``accelerometer_x`` to ``accelerometer_z`` in m/s^2, ``gyroscope_x`` to ``gyroscope_z`` in rad/s. A delay
    of all of them is a parameter of :class:`~dalembert.forward.Sensors`, ``{"imu": Sensor(delay=(0.0, 0.05))}``. For
    the model of the errors see Titterton and Weston, Strapdown Inertial Navigation Technology (2004), chapter 4.

    Examples
    --------
    A sensor at rest reads the opposite of gravity:

    >>> import numpy as np
    >>> from dalembert.multibody import simulate
    >>> from dalembert.multibody.spatial import FixedJoint, Inertia, Orientation, RigidBody, SpatialSystem
    >>> system = SpatialSystem(gravity=(0.0, 0.0, -9.81))
    >>> tilted = Orientation.by_angles("y", [np.pi / 2])
    >>> box = system.add(RigidBody("box", Inertia.box(1.0, (0.1, 0.1, 0.1)), orientation=tilted))
    >>> _ = system.add(FixedJoint("glue", system.ground.point((0.0, 0.0, 0.0), tilted), box.point("origin")))
    >>> _ = system.add(InertialSensor("imu", box.point("origin"), acceleration_bias=(0.1, 0.0, 0.0)))
    >>> values = simulate(system, end=0.1).channels(["imu.accelerometer_x", "imu.accelerometer_z"])[-1]
    >>> (values.round(6) + 0.0).tolist()
    [-9.71, 0.0]
    """

    at: Point
    acceleration_bias: Vector = number("m/s**2", (0.0, 0.0, 0.0))
    acceleration_gain: Any = field(default=(1.0, 1.0, 1.0), metadata={"unit": "", "table": "SensorGain"})
    rate_bias: Vector = number("rad/s", (0.0, 0.0, 0.0))
    rate_gain: Any = field(default=(1.0, 1.0, 1.0), metadata={"unit": "", "table": "SensorGain"})

    kind = INERTIAL_SENSOR

    def __post_init__(self) -> None:
        for what in ("acceleration_gain", "rate_gain"):
            _gain(f"InertialSensor {self.name!r}", what, getattr(self, what))

    @property
    def findings(self) -> tuple[Finding, ...]:
        """Which gains leave an output without a signal; parameters may pass through such a gain."""
        return tuple(
            Finding(
                "zero-gain",
                "warning",
                {"sensor": self.name, "gain": what},
                f"InertialSensor {self.name!r}: an output has the gain 0 in {what}, so it shows nothing but its bias.",
                "Give a gain other than zero, or leave its channel out.",
            )
            for what in ("acceleration_gain", "rate_gain")
            if not np.all(np.any(np.reshape(np.real(_gain("", what, getattr(self, what))), (3, 3)) != 0, axis=0))
        )

    def lower(self, lowering: SpatialRows) -> None:
        owner = f"InertialSensor {self.name!r}"
        require_direction(owner, "the channels ax, ay and az of the point, or a rigid body", self.at)
        pair = lowering.pair(self.at, None, self.name)
        numbers = [
            *pair.data, *lowering.gravity,
            *self.acceleration_bias, *_gain(owner, "acceleration_gain", self.acceleration_gain),
            *self.rate_bias, *_gain(owner, "rate_gain", self.rate_gain),
        ]  # fmt: skip
        lowering.add(INERTIAL_SENSOR, pair.slots, numbers, pair.integers, self.name)


def _gain(owner: str, what: str, given: Any) -> list[Number]:
    """Entries of a gain, column by column."""
    array = array_of(given)
    if array.shape not in ((3,), (3, 3)):
        raise InputError(f"{owner}: {what} is {shown(given)}; expected three numbers, or a matrix (3, 3)")
    matrix = np.diag(array) if array.ndim == 1 else array
    return matrix.T.ravel().tolist()
