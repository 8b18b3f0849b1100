"""Models of which only combinations of parameters are identifiable, along curved valleys."""

import numpy as np

import dalembert as da
from dalembert.data import Measurements
from stepped_models import Stepped

PENDULUM_START = {"mass": 2.0, "centre": 0.1, "inertia": 0.02}
PENDULUM_TRUTH = np.array([0.8, 0.16, 0.008])
PENDULUM_TIMES = np.linspace(0, 1.5, 76)
STEPPED_TRUTH = {"rate": 1.5, "size": 1.5}


def double_pendulum(mass, centre, inertia):
    """A double pendulum, in whose motion mass and inertia of the first bar enter as m c and J + m c² alone."""
    system = da.System(gravity=(0, -9.81))
    points = {"pin": (-centre, 0.0), "tip": (0.3 - centre, 0.0)}
    place = system.ground.point(0, 0)
    upper = system.add(da.RigidBody("upper", mass, inertia, position=place, angle=0.9, anchor="pin", points=points))
    lower = system.add(da.RigidBar("lower", 0.25, 0.3, angle=0.3, start=upper.point("tip")))
    system.add(da.RevoluteJoint("O", system.ground.point(0, 0), upper.point("pin")))
    system.add(da.RevoluteJoint("A", upper.point("tip"), lower.start))
    return system


def pendulum_model():
    """Angles of both bars over 1.5 s, with an error of the integrator in which the parameters are separable."""
    bounds = {"mass": (0.2, 5.0), "centre": (0.05, 0.28), "inertia": (0.002, 0.1)}
    angles = ["upper.pin.angle", "lower.start.angle"]
    return da.TimeResponse(double_pendulum, bounds, angles, PENDULUM_TIMES, solver=da.GeneralizedAlpha(step=5e-3))


def pendulum_data(model, noise):
    values = model.evaluate(PENDULUM_TRUTH[None]).only()[0]
    noisy = [values[:, k] + noise * np.random.default_rng(k).standard_normal(76) for k in (0, 1)]
    names = (channel.name for channel in model.channels)
    return Measurements.of(PENDULUM_TIMES, dict(zip(names, noisy, strict=True)))


def product_in_steps(rate, size, step, times):
    """A response to a product of parameters; the error of its steps is proportional to one of them."""
    return np.sin(rate * size * times) + 1e-3 * step**2 * rate * times**2


def stepped_product():
    """The model, and data that were made with the same steps."""
    model = Stepped(method=product_in_steps)
    times = model.coordinate.values
    values = product_in_steps(**STEPPED_TRUTH, step=0.8, times=times)
    return model, Measurements.of(times, {"x": values + 1e-5 * np.random.default_rng(0).standard_normal(101)})


def product(rate, size, times, effect=1e-4):
    """A response to a product of parameters, with a small effect of one of them."""
    return np.sin(rate * size * times) + effect * np.sin(3 * rate * times)
