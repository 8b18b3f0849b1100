"""Findings on limits, motors, armatures and torsion springs that do not suit the joints that they act on."""

import numpy as np
import pytest

from dalembert.multibody import GeneralizedAlpha, System, TimeResponse, simulate
from dalembert.multibody import PointMass as PlanarMass
from dalembert.multibody import Spring as PlanarSpring
from dalembert.multibody.spatial import (
    AngleLimit,
    Armature,
    DisplacementLimit,
    Inertia,
    Motor,
    Orientation,
    PrismaticJoint,
    RevoluteJoint,
    RigidBody,
    SpatialSystem,
    SphericalJoint,
    Spring,
    TorsionSpring,
)

DISC = Inertia.cylinder(mass=1.0, radius=0.1, length=0.02)


def driven(add, joint=RevoluteJoint, axis=(0.0, 0.0, 1.0), **placed) -> SpatialSystem:
    """A disc on a joint with one more component, on the same sides."""
    system = SpatialSystem(gravity=(0.0, 0.0, 0.0))
    disc = system.add(RigidBody("disc", DISC, **placed))
    sides = system.ground.point((0.0, 0.0, 0.0)), disc.point("origin")
    pin = system.add(joint("pin", *sides, axis=axis) if joint is not SphericalJoint else joint("pin", *sides))
    system.add(add(pin, *sides))
    return system


def found(system: SpatialSystem) -> list[tuple]:
    return [(item.code, item.severity, item.values) for item in simulate(system, 1e-3, GeneralizedAlpha(1e-3)).findings]


def motor(axis=(0.0, 0.0, 1.0)):
    return lambda pin, *sides: Motor("motor", *sides, torque_constant=1.0, current=0.1, axis=axis)


def armature(slides: bool, axis=(0.0, 0.0, 1.0)):
    return lambda pin, *sides: Armature("rotor", *sides, 1.0, axis=axis, slides=slides)


def coil(axis):
    return lambda pin, *sides: TorsionSpring("coil", *sides, stiffness=1.0, axis=axis)


@pytest.mark.parametrize(
    ("system", "name", "coordinate", "angle"),
    [
        (driven(motor((1.0, 0.0, 0.0))), "motor", "angle", 90.0),
        (driven(motor((0.0, 1.0, 1.0))), "motor", "angle", 45.0),
        (driven(motor(), PrismaticJoint), "motor", "angle", 0.0),
        (driven(armature(True)), "rotor", "displacement", 0.0),
        (driven(armature(False), PrismaticJoint), "rotor", "angle", 0.0),
        (driven(armature(False, (1.0, 0.0, 0.0))), "rotor", "angle", 90.0),
        (driven(coil((1.0, 0.0, 1.0))), "coil", "angle", 45.0),
    ],
    ids=lambda one: one if isinstance(one, str) else "",
)
def test_another_axis_or_coordinate_than_the_joint_has_is_named(
    system, name: str, coordinate: str, angle: float
) -> None:
    ((code, severity, values),) = found(system)
    assert (code, severity) == ("other-axis", "warning")
    assert (values["component"], values["joint"], values["coordinate"]) == (name, "pin", coordinate)
    assert values["angle"] == pytest.approx(angle, abs=1e-6)


@pytest.mark.parametrize(
    "system",
    [
        driven(motor()),
        driven(motor((0.0, 0.0, -2.0))),
        driven(
            motor((1.0, 2.0, 3.0)), axis=(1.0, 2.0, 3.0), orientation=Orientation.by_rotation_vector([0.1, 0.2, 0.3])
        ),
        driven(armature(True), PrismaticJoint),
        driven(armature(False)),
        driven(coil((0.0, 0.0, 1.0))),
        driven(motor((1.0, 0.0, 0.0)), SphericalJoint),
    ],
    ids=["same", "opposite", "turned", "slides", "turns", "spring", "no axis"],
)
def test_the_axis_of_the_joint_is_no_finding(system) -> None:
    assert found(system) == []


def stop(**ends):
    return lambda pin, *sides: AngleLimit("stop", pin, stiffness=1e3, near=0.0, **ends)


@pytest.mark.parametrize(("start", "side"), [(1.5, "upper"), (-1.5, "lower")])
def test_a_limit_that_the_start_violates_is_named_with_its_torque(start: float, side: str) -> None:
    turned = Orientation.by_angles("z", start)
    ((code, severity, values),) = found(driven(stop(lower_limit=-0.5, upper_limit=0.5), orientation=turned))
    assert (code, severity, values["limit"], values["joint"]) == ("limit-violated", "warning", "stop", "pin")
    assert values["angle"] == pytest.approx(start)
    assert values[side] == np.sign(start) * 0.5
    assert values["torque"] == pytest.approx(1e3)  # of 1 rad beyond the limit


def test_a_displacement_beyond_its_limit_is_named() -> None:
    system = driven(
        lambda slide, *sides: DisplacementLimit("end", slide, stiffness=8.0, upper_limit=0.0), PrismaticJoint,
        position=(0.0, 0.0, 0.25),
    )  # fmt: skip
    ((code, _, values),) = found(system)
    assert (code, values["displacement"], values["upper"]) == ("limit-violated", 0.25, 0.0)
    assert values["force"] == pytest.approx(1.0)


@pytest.mark.parametrize("start", [0.0, 0.5, -0.5])
def test_a_start_within_or_at_the_limits_is_no_finding(start: float) -> None:
    turned = Orientation.by_angles("z", start)
    assert found(driven(stop(lower_limit=-0.5, upper_limit=0.5), orientation=turned)) == []


def test_a_model_of_measurements_has_these_findings_without_a_motion() -> None:
    def build(start: float) -> SpatialSystem:
        return driven(stop(upper_limit=0.5), orientation=Orientation.by_angles("z", start))

    model = TimeResponse(build, {"start": (0.0, 2.0)}, ["pin.angle"], np.linspace(0.0, 0.1, 3))
    assert [item.code for item in model.findings(np.array([1.0]))] == ["limit-violated"]
    assert model.findings(np.array([0.2])) == ()


def test_negative_damping_is_named_in_the_plane_and_in_space() -> None:
    planar, spatial = System(), SpatialSystem()
    mass = planar.add(PlanarMass("mass", 1.0, (1.0, 0.0)))
    planar.add(PlanarSpring("spring", planar.ground.point(0.0, 0.0), mass.centre, 1.0, damping=-0.5))
    body = spatial.add(RigidBody("body", DISC, (1.0, 0.0, 0.0)))
    spatial.add(Spring("spring", spatial.ground.point((0.0, 0.0, 0.0)), body.point("origin"), 1.0, damping=-0.5))
    for system in (planar, spatial):
        (finding,) = system.findings
        assert (finding.code, finding.severity) == ("negative-damping", "warning")
        assert finding.values == {"component": "spring", "damping": -0.5}
