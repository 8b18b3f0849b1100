"""Rigid mechanisms against published motions."""

import numpy as np
import pytest

import dalembert as da
from rigid_mechanisms import n_four_bar, two_link_arm

TOPIC = "Rigid mechanisms"


def fine(step: float) -> da.GeneralizedAlpha:
    return da.GeneralizedAlpha(step=step, spectral_radius=0.95)


def test_simple_pendulum(reference, record_evidence) -> None:
    data = reference("simple_pendulum")
    model, values = data["model"], data["values"]
    system = da.System(gravity=(0.0, -model["gravity"]))
    mass = system.add(da.PointMass("mass", model["mass"], position=tuple(model["start"])))
    system.add(da.DistanceJoint("rod", system.ground.point(0.0, 0.0), mass.centre, length=model["length"]))
    trajectory = da.simulate(system, 10.0, solver=fine(5e-5), times=np.array([0.0, *values["times"]]))
    position = trajectory.channels(["mass.centre.x", "mass.centre.y"])[1:]
    for time, expected, ours in zip(values["times"], values["position"], position, strict=True):
        record_evidence(
            f"simple pendulum (A01), x and y at {time:g} s",
            expected,
            ours,
            unit="m",
            tolerance=1e-6,
            relative=True,
            topic=TOPIC,
            kind=data["kind"],
            source=data["source"],
        )


@pytest.mark.parametrize(
    ("case", "step"), [(0, 8e-5), (1, 8e-5), pytest.param(2, 1e-4, marks=pytest.mark.slow)], ids=["N=1", "N=2", "N=40"]
)
def test_n_four_bar(reference, record_evidence, case: int, step: float) -> None:
    """The mechanism passes its singular position, flat, again and again, and only momentum keeps it on its branch.

    Rounding is magnified there: at spectral radii of 0.8 and less it leaves 1e-7 to 1e-5, however fine the step.
    """
    data = reference("n_four_bar")
    values = data["values"]
    windows = values["windows"][case]
    trajectory = da.simulate(
        n_four_bar(data["model"], windows), values["time"], solver=fine(step), times=np.array([0.0, values["time"]])
    )
    record_evidence(
        f"four-bar mechanism with {windows} {'window' if windows == 1 else 'windows'} (A02), x and y of B0 at 10 s",
        values["position"][case],
        trajectory.channels(["U0.end.x", "U0.end.y"])[-1],
        unit="m",
        tolerance=1e-6,
        relative=True,
        topic=TOPIC,
        kind=data["kind"],
        source=data["source"],
    )


def test_two_link_arm(reference, record_evidence) -> None:
    data = reference("two_link_arm")
    values = data["values"]
    trajectory = da.simulate(
        two_link_arm(data["model"]), 5.0, solver=fine(4.5e-5), times=np.array([0.0, *values["times"]])
    )
    angles = trajectory.channels(["upper.centre.angle", "lower.centre.angle"])
    common = {"topic": TOPIC, "kind": data["kind"], "source": data["source"], "relative": True}
    record_evidence(
        "two-link arm, energy at first",
        values["energy"],
        trajectory.energies["total"][0],
        unit="J",
        tolerance=1e-11,
        **common,
    )
    for time, expected, ours in zip(values["times"], values["angles"], angles[1:], strict=True):
        record_evidence(
            f"two-link arm, both angles at {time:g} s", expected, ours, unit="rad", tolerance=1e-6, **common
        )


def test_slider_crank(reference, record_evidence) -> None:
    data = reference("slider_crank")
    model, values = data["model"], data["values"]
    system = da.System(gravity=(0.0, 0.0))
    crank = system.add(da.RigidBar("crank", model["crank_length"], model["crank_mass"]))
    rod = system.add(da.RigidBar("rod", model["rod_length"], model["rod_mass"], start=crank.end))
    slider = system.add(da.RigidBody("slider", model["slider_mass"], inertia=1.0, position=rod.end))
    system.add(da.RevoluteJoint("O", system.ground, crank.start))
    system.add(da.RevoluteJoint("A", crank.end, rod.start))
    system.add(da.RevoluteJoint("B", rod.end, slider.centre))
    system.add(da.PrismaticJoint("guide", system.ground, slider.centre))
    system.add(da.Torque("motor", crank.centre, da.signals.Step(model["torque"], 0.0, model["torque_end"])))
    trajectory = da.simulate(system, 3.0, solver=fine(2e-5), times=np.array([0.0, *values["times"]]))
    record_evidence(
        "slider-crank, crank angle at 1, 2 and 3 s",
        values["crank_angle"],
        trajectory.channels(["crank.centre.angle"])[1:, 0],
        unit="rad",
        tolerance=1e-6,
        relative=True,
        topic=TOPIC,
        kind=data["kind"],
        source=data["source"],
    )
