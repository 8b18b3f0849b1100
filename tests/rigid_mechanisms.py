"""Rigid mechanisms of the reference files, which several test files integrate."""

import numpy as np
from numpy.typing import ArrayLike

import dalembert as da


def two_link_arm(model: dict) -> da.System:
    system = da.System(gravity=(0.0, -model["gravity"]))
    upper, lower = zip(model["length"], model["mass"], model["angle"], strict=True)
    first = system.add(da.RigidBar("upper", upper[0], upper[1], angle=upper[2]))
    second = system.add(da.RigidBar("lower", lower[0], lower[1], angle=lower[2], start=first.end))
    system.add(da.RevoluteJoint("O", system.ground, first.start))
    system.add(da.RevoluteJoint("A", first.end, second.start))
    return system


def n_four_bar(model: dict, windows: int) -> da.System:
    """N windows: uprights U0 ... UN on the ground, rods C1 ... CN across their upper ends."""
    length, mass, angle = model["length"], model["mass"], model["angle"]
    spin = -model["velocity"] / length
    system = da.System(gravity=(0.0, -model["gravity"]))
    before = None
    for number in range(windows + 1):
        foot = system.ground.point(number * length, 0.0)
        upright = system.add(da.RigidBar(f"U{number}", length, mass, angle=angle, start=foot, angular_velocity=spin))
        system.add(da.RevoluteJoint(f"foot{number}", foot, upright.start))
        if before is not None:
            across = system.add(
                da.RigidBar(f"C{number}", length, mass, start=before.end, velocity=(model["velocity"], 0.0))
            )
            system.add(da.RevoluteJoint(f"left{number}", before.end, across.start))
            system.add(da.RevoluteJoint(f"right{number}", upright.end, across.end))
        before = upright
    return system


def factors(data: dict) -> np.ndarray:
    """What makes the bodies' angles of the seven coordinates of the test set."""
    return np.array([body["angle"] for body in data["bodies"]], dtype=float)


def andrews(data: dict, q: ArrayLike, rates: ArrayLike = (0.0,) * 7) -> da.System:
    """The mechanism where its seven coordinates are ``q`` and change by ``rates``."""
    system = da.System(gravity=(0.0, 0.0))
    points = {f"ground.{name}": system.ground.point(*place) for name, place in data["ground"].items()}
    speeds = dict.fromkeys(points, 0j)
    for body, angle, rate in zip(data["bodies"], factors(data) @ q, factors(data) @ rates, strict=True):
        own, carrier = body["anchor"]
        places = {name: tuple(np.subtract(place, body["centre"])) for name, place in body["points"].items()}
        added = system.add(
            da.RigidBody(
                body["name"],
                body["mass"],
                body["inertia"],
                position=points[carrier],
                angle=angle,
                anchor=own,
                points=places,
                velocity=(speeds[carrier].real, speeds[carrier].imag),
                angular_velocity=rate,
            )
        )
        for name, place in places.items():
            arm = np.exp(1j * angle) * complex(*np.subtract(place, places[own]))
            points[f"{body['name']}.{name}"] = added.point(name)
            speeds[f"{body['name']}.{name}"] = speeds[carrier] + 1j * rate * arm
    for name, (first, second) in data["joints"].items():
        system.add(da.RevoluteJoint(name, points[first], points[second]))
    load = data["load"]
    first, second = (points[name] for name in load["spring"])
    system.add(da.Spring("spring", first, second, load["stiffness"], free_length=load["free_length"]))
    system.add(da.Torque("motor", points["K1.O"], load["torque"]))
    return system


def channels(data: dict) -> list[str]:
    """Angles, rates and accelerations of the bodies, then forces of the joints at E."""
    names = [body["name"] for body in data["bodies"]]
    motion = [f"{name}.centre.{entry}" for entry in ("angle", "rate", "acceleration") for name in names]
    return motion + [f"{joint}.force_{axis}" for joint in ("E3", "E4", "E6") for axis in "xy"]


def read(data: dict, trajectory: da.Trajectory, sample: int) -> dict[str, np.ndarray]:
    """Coordinates, their rates and accelerations, and joint forces of a sample, in the test set's terms."""
    values = trajectory.channels(channels(data))[sample]
    q, velocity, acceleration = np.linalg.solve(factors(data), values[:21].reshape(3, 7).T).T
    return {"q": q, "velocity": velocity, "acceleration": acceleration, "multipliers": values[21:]}
