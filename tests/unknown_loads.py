"""A rope under an unknown history of forces, whose values are parameters."""

import numpy as np

import dalembert.multibody as mb
from dalembert.parameter import Parameter
from mechanisms import SECTION

BETWEEN = np.array([0.0, 0.02, 0.0333, 0.08])  # s; the third lies between steps


def pushed(*, kind: str, **values: complex) -> mb.System:
    """A cable under a table of forces."""
    system = mb.System()
    cable = system.add(mb.AncfCable("rope", 1.0, 2, 4e5, 900.0, **SECTION))
    system.add(mb.RevoluteJoint("pin", system.ground, cable.start))
    history = list(values.values())
    times = np.linspace(0.0, 0.07, len(history))
    table = mb.BSpline(history, 0.0, 0.07) if kind == "spline" else mb.Table(times, history, kind)
    system.add(mb.Force("push", cable.end, y=table))
    system.add(mb.Torque("twist", cable.end, table))
    return system


def pushed_model(kind: str, count: int, *, deviation: float | None = None, **changed) -> mb.TimeResponse:
    """Its response to the values of the table, which may have priors of a standard deviation."""

    def build(**values: complex) -> mb.System:
        return pushed(kind=kind, **values)

    box = [Parameter(f"c{k}", -90.0 + k, 99.0 + 2 * k, deviation=deviation) for k in range(count)]
    channels = ["rope.end.y", "rope.end.vx", "pin.force_x"]
    given = {"times": BETWEEN, "solver": mb.GeneralizedAlpha(1e-3)} | changed
    return mb.TimeResponse(build, box, channels, **given)
