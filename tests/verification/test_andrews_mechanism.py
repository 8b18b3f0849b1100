"""Andrews' squeezing mechanism: seven bodies, ten joints, thousands of radians a second."""

import numpy as np

import dalembert as da


def andrews(data: dict) -> tuple[da.System, np.ndarray]:
    """The mechanism, and the factors that make the bodies' angles of the seven coordinates of the test set."""
    system = da.System(gravity=(0.0, 0.0))
    points = {f"ground.{name}": system.ground.point(*place) for name, place in data["ground"].items()}
    factors = np.array([body["angle"] for body in data["bodies"]], dtype=float)
    for body, angle in zip(data["bodies"], factors @ data["initial"]["q"], strict=True):
        own, carrier = body["anchor"]
        added = system.add(
            da.RigidBody(
                body["name"],
                body["mass"],
                body["inertia"],
                position=points[carrier],
                angle=angle,
                anchor=own,
                points={name: tuple(np.subtract(place, body["centre"])) for name, place in body["points"].items()},
            )
        )
        points |= {f"{body['name']}.{name}": added.point(name) for name in body["points"]}
    for name, (first, second) in data["joints"].items():
        system.add(da.RevoluteJoint(name, points[first], points[second]))
    load = data["load"]
    first, second = (points[name] for name in load["spring"])
    system.add(da.Spring("spring", first, second, load["stiffness"], free_length=load["free_length"]))
    system.add(da.Torque("motor", points["K1.O"], load["torque"]))
    return system, factors


def channels(data: dict) -> list[str]:
    """Angles, rates and accelerations of the bodies, then forces of the joints at E."""
    names = [body["name"] for body in data["bodies"]]
    motion = [f"{name}.centre.{entry}" for entry in ("angle", "rate", "acceleration") for name in names]
    return motion + [f"{joint}.force_{axis}" for joint in ("E3", "E4", "E6") for axis in "xy"]


def test_end_values_of_the_test_set(reference, record_evidence) -> None:
    data = reference("andrews")
    end = data["end"]
    system, factors = andrews(data)
    # Accelerations of index 3 carry the rounding of positions over the step squared: a finer step would not help them.
    solver = da.GeneralizedAlpha(step=5e-7, spectral_radius=0.5, newton_tolerance=1e-15)
    trajectory = da.simulate(system, end["time"], solver=solver, times=np.array([0.0, end["time"]]))
    values = trajectory.channels(channels(data))[-1]
    coordinates = np.linalg.solve(factors, values[:21].reshape(3, 7).T).T
    rows = {
        "q": ("seven angles", "rad", coordinates[0]),
        "velocity": ("seven angular velocities", "rad/s", coordinates[1]),
        "acceleration": ("seven angular accelerations", "rad/s²", coordinates[2]),
        "multipliers": ("six joint forces", "N", values[21:]),
    }
    for name, (quantity, unit, ours) in rows.items():
        record_evidence(
            f"Andrews' mechanism, {quantity} at 0.03 s",
            end[name],
            ours,
            unit=unit,
            tolerance=1e-6,
            relative=True,
            topic="Rigid mechanisms",
            source=data["source"],
        )


def test_initial_accelerations_and_joint_forces(reference, record_evidence) -> None:
    data = reference("andrews")
    initial = data["initial"]
    system, factors = andrews(data)
    trajectory = da.simulate(system, 1e-6, solver=da.GeneralizedAlpha(step=1e-6))
    values = trajectory.channels(channels(data))[0]
    acceleration = np.linalg.solve(factors, values[14:21])
    common = {"topic": "Rigid mechanisms", "source": data["source"], "relative": True, "tolerance": 1e-10}
    record_evidence(
        "Andrews' mechanism, angular accelerations at first",
        initial["acceleration"],
        acceleration,
        unit="rad/s²",
        **common,
    )
    record_evidence(
        "Andrews' mechanism, joint forces at first", initial["multipliers"], values[21:], unit="N", **common
    )
