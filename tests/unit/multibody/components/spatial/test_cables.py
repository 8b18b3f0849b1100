"""Cables in space: their placement, forces, clamps and sensors, and messages for input that cannot work."""

import numpy as np
import pytest

import dalembert.multibody as mb
import dalembert.multibody.spatial as sp
from dalembert.errors import InputError, ModelError
from dalembert.multibody.components.spatial.spatial_cable_element import CABLE, stretches
from dalembert.multibody.kernels.elementary import STEP
from dalembert.multibody.model.evaluate import energies, residual
from dalembert.multibody.model.lowering import lower
from dalembert.report import Animation
from spatial_scenes import SCENES
from support import says

WIND_AND_RAIN = "CableSensor 'load': the line forces 'wind' and 'rain' act on 'rope', and the sensor takes one; add them into one force"
ALPHA = mb.GeneralizedAlpha(step=1e-3)


def rope(**fields) -> sp.Cable:
    """A rope of 2 m."""
    fields = {"length": 2.0, "elements": 4, "axial_stiffness": 1e4, "mass_per_length": 0.5} | fields
    return sp.Cable("rope", **fields)


def between(cable: sp.Cable, end: tuple[float, float, float]) -> sp.SpatialSystem:
    """A cable between two points."""
    system = sp.SpatialSystem()
    system.add(cable)
    system.add(sp.SphericalJoint("left", system.ground.point((0.0, 0.0, 0.0)), cable.start))
    system.add(sp.SphericalJoint("right", system.ground.point(end), cable.end))
    system.add(sp.CableSensor("load", cable.node(2)))
    return system


def test_a_slack_cable_is_placed_as_an_arc_of_its_length():
    nodes = rope(span=1.0, elements=40).placed(rope().frame((1.0, 2.0, 3.0))).reshape(-1, 2, 3)
    assert nodes[-1, 0] == pytest.approx([2.0, 2.0, 3.0])
    assert nodes[:, 0, 2].min() < 2.5
    np.testing.assert_allclose(np.linalg.norm(nodes[:, 1], axis=1), 1.0)
    np.testing.assert_allclose(np.linalg.norm(np.diff(nodes[:, 0], axis=0), axis=1), 0.05, rtol=2e-3)
    assert np.abs(stretches(nodes.reshape(-1, 6)[[0, 1]].reshape(1, 12), np.array([0.05]))).max() < 1e-6


def test_the_arc_follows_its_length():
    slope = np.imag(rope(length=2.0 + 1j * STEP, span=1.0).placed(rope().frame((0.0, 0.0, 0.0)))) / STEP
    near = [rope(length=2.0 + h, span=1.0).placed(rope().frame((0.0, 0.0, 0.0))) for h in (-1e-5, 1e-5)]
    np.testing.assert_allclose(slope, (near[1] - near[0]) / 2e-5, atol=1e-8)


def test_a_longer_span_and_a_prestrain_pull_alike():
    pulled = mb.equilibrium(between(rope(span=2.002), (2.002, 0.0, 0.0))).channels(["load.tension"])
    strained = mb.equilibrium(between(rope(prestrain=-1e-3, length=2.002), (2.002, 0.0, 0.0)))
    assert pulled[0] > 10.0  # E A 1e-3, and what its sag adds
    assert strained.channels(["load.tension"])[0] == pytest.approx(pulled[0], rel=1e-2)


def test_forces_are_the_gradient_of_the_energy():
    build, fields = SCENES["cable"]
    own = lower(build(**fields | {"damping": 0.0, "mass_damping": 0.0, "push": (0.0, 0.0, 0.0)}))
    n = own.structure.n
    x, still = own.x + 0.05 * np.random.default_rng(1).normal(size=len(own.x)), np.zeros_like(own.x)
    x[n:] = 0.0
    times, slopes = np.zeros(1), np.zeros(n)
    index = np.unique(own.structure.index[CABLE])
    for i in index:
        moved = x + 0j
        moved[i] += 1j * STEP
        slopes[i] = energies(own.complex_model, moved[None], still[None] + 0j, times, times)[0, 1].imag / STEP
    forces = residual(own, own.real, x, still, still, only=CABLE)[:n]
    np.testing.assert_allclose(forces[index], slopes[index], atol=1e-12 * np.abs(slopes).max())


def test_a_rigid_motion_is_not_damped():
    cable = rope(bending_stiffness=2.0, damping=0.1, span=1.5, angular_velocity=(0.0, 3.0, 0.0), elements=2)
    system = sp.SpatialSystem(gravity=(0.0, 0.0, 0.0))
    system.add(cable)
    start = lower(system)
    power = energies(start.real, start.x[None], start.v[None], np.zeros(1), np.zeros(1))[0, 2]
    assert abs(power) < 1e-12  # it turns about an axis across its line


@pytest.mark.parametrize("flipped", [False, True])
def test_a_clamp_holds_the_direction_and_measures_its_moment(flipped):
    system = sp.SpatialSystem(gravity=(0.0, 0.0, 0.0))
    cable = system.add(rope(bending_stiffness=50.0, axial_stiffness=1e6, elements=2))
    sides = (cable.start, system.ground) if flipped else (system.ground, cable.start)
    system.add(sp.FixedJoint("clamp", *sides))
    system.add(sp.Force("push", cable.end, y=0.02, z=0.03))
    system.add(sp.CableSensor("gauge", cable.start))
    rest = mb.equilibrium(system)
    deflection = rest.channels(["rope.end.y", "rope.end.z"])
    np.testing.assert_allclose(deflection, np.array([0.02, 0.03]) * 8 / 150, rtol=1e-4)  # F L^3 / (3 E I)
    sign = -1.0 if flipped else 1.0
    clamp = rest.channels(["clamp.force_2", "clamp.force_z", "clamp.torque_y", "clamp.torque_3"])
    np.testing.assert_allclose(sign * clamp, [-0.02, -0.03, 0.06, -0.04], atol=1e-5)
    gauge = rest.channels(["gauge.force_y", "gauge.force_z", "gauge.moment_y", "gauge.moment_z", "gauge.direction_x"])
    np.testing.assert_allclose(gauge, [0.02, 0.03, -0.06, 0.04, 1.0], atol=1e-5)


def test_forces_along_a_cable_are_as_its_weight():
    ends = []
    for gravity, push in ((-9.81, 0.0), (0.0, -0.5 * 9.81)):
        system = between(rope(span=1.8), (1.8, 0.0, 0.0))
        system.gravity = (0.0, 0.0, gravity)
        system.add(sp.LineForce("wind", system.bodies[0].point("end"), z=push))
        ends.append(mb.equilibrium(system).channels(["rope.node1.z", "rope.node2.z"]))
    np.testing.assert_allclose(*ends, rtol=1e-9)


def test_a_sensor_takes_the_force_along_the_line_into_account():
    system = between(rope(span=1.8), (1.8, 0.0, 0.0))
    system.add(sp.LineForce("wind", system.bodies[0].end, y=3.0, z=-1.0))
    for name, node in (("first", 0), ("last", 4)):
        system.add(sp.CableSensor(name, system.bodies[0].node(node)))
    rest = mb.equilibrium(system)
    forces = {
        owner: rest.channels([f"{owner}.force_{axis}" for axis in "xyz"])
        for owner in ("first", "last", "left", "right")
    }
    np.testing.assert_allclose(forces["first"], -forces["left"], atol=1e-9)
    np.testing.assert_allclose(forces["last"], forces["right"], atol=1e-9)
    system.add(sp.LineForce("rain", system.bodies[0].end, z=-1.0))
    with pytest.raises(ModelError, match=says(WIND_AND_RAIN)):
        mb.equilibrium(system)


def test_a_cable_is_drawn_along_its_line():
    arc = rope(span=4.0 / np.pi)  # half of a circle
    nodes = arc.placed(arc.frame((0.0, 0.0, 0.0)))[None]
    drawn = arc.outline(nodes, 8)[0]
    assert len(drawn) == 4 * 8 + 1
    np.testing.assert_allclose(np.linalg.norm(drawn - [2.0 / np.pi, 0.0, 0.0], axis=1), 2.0 / np.pi, rtol=2e-3)
    motion = mb.simulate(between(arc, (4.0 / np.pi, 0.0, 0.0)), 0.01, ALPHA)
    assert any(shape.points.shape[1] == len(drawn) for shape in Animation.of(motion.drawing()).scene.primitives)


@pytest.mark.parametrize(("angle", "codes"), [(80.0, []), (120.0, ["beam-turn"])])
def test_a_line_that_turns_far_in_an_element_is_a_finding(angle, codes):
    cable = rope(elements=2)
    nodes = cable.placed(cable.frame((0.0, 0.0, 0.0))).reshape(3, 2, 3)
    nodes[1, 1] = np.cos(np.radians(angle)), 0.0, np.sin(np.radians(angle))
    findings = cable.motion_findings(np.zeros(1), nodes.reshape(1, -1), np.zeros((1, 18)))
    assert [finding.code for finding in findings] == codes
    assert all(finding.values["angle"] == pytest.approx(angle) for finding in findings)


def other_body() -> sp.SpatialSystem:
    """A sensor of cables at a rigid body."""
    system = sp.SpatialSystem()
    box = system.add(sp.RigidBody("box", sp.Inertia.box(1.0, (0.1, 0.1, 0.1))))
    system.add(sp.CableSensor("load", box.point("origin")))
    return system


def jointed(joint: type, other: bool = False, mass: bool = False) -> sp.SpatialSystem:
    """A cable on a joint to the ground, to another cable, or to a point mass."""
    system = sp.SpatialSystem()
    cable = system.add(rope())
    side = system.add(sp.Cable("other", 1.0, 1, 1e4, 0.5)).end if other else system.ground
    side = system.add(sp.PointMass("ball", 1.0)).point("centre") if mass else side
    system.add(joint("pin", side, cable.start))
    mb.simulate(system, 0.01, ALPHA)
    return system


@pytest.mark.parametrize(
    ("make", "kind", "message"),
    [
        (
            lambda: rope(elements=0),
            InputError,
            "cable 'rope': elements is 0; expected a whole number, from 1 to 100000",
        ),
        (
            lambda: rope(elements=2, span=0.1),
            InputError,
            "cable 'rope': with a span of 0.1 m it is an arc of 343 degrees at the start, more than 90 degrees an "
            "element; use more elements",
        ),
        (
            lambda: jointed(sp.FixedJoint, mass=True),
            ModelError,
            "FixedJoint 'pin': ball.centre has no direction; use a spherical or distance joint, or a rigid body",
        ),
        (
            other_body,
            InputError,
            "CableSensor 'load': box.origin belongs to another body than a cable. Give a point of a Cable",
        ),
        (
            lambda: sp.LineForce("wind", rope().end, y=1.0, follower=True),
            InputError,
            "LineForce 'wind': a cable has no sections that the force can turn with; leave out follower",
        ),
        (
            lambda: jointed(sp.RevoluteJoint),
            ModelError,
            "RevoluteJoint 'pin': rope.start has no direction; use a spherical or distance joint, or a rigid body",
        ),
        (
            lambda: jointed(sp.FixedJoint, other=True),
            ModelError,
            "FixedJoint 'pin': both sides are points of cables. Put a rigid body between them",
        ),
    ],
)
def test_what_cannot_work_is_refused(make, kind, message):
    with pytest.raises(kind, match=says(message)):
        make()


def test_a_clamp_against_the_line_is_refused():
    system = sp.SpatialSystem()
    cable = system.add(rope(orientation=sp.Orientation.by_angles("z", [3.0])))
    system.add(sp.FixedJoint("clamp", system.ground, cable.start))
    with pytest.raises(ModelError, match="the line of the cable runs against the x axis of the other side"):
        mb.simulate(system, 0.01, ALPHA)
