"""Mechanisms, settings and requests that cannot be meant: one sentence each that says where and what to do."""

from collections.abc import Callable

import numpy as np
import pytest

import dalembert.multibody as mb
from dalembert.errors import InputError, ModelError, SolveError
from support import says


def bar(name: str = "bar", **placed) -> mb.RigidBar:
    return mb.RigidBar(name, length=1.0, mass=1.0, **placed)


def pendulum() -> mb.System:
    system = mb.System()
    system.add(mb.RevoluteJoint("pin", system.ground, system.add(bar()).start))
    return system


def with_mass(make: Callable) -> mb.System:
    """A bar, a mass at its end and what ``make`` gives for the system, the bar and the mass."""
    system = mb.System()
    own = system.add(bar())
    mass = system.add(mb.PointMass("mass", 1.0, own.end))
    system.add(make(system, own, mass))
    return system


def too_short() -> mb.System:
    system = mb.System(driving=["bar.x", "bar.y"])
    own = system.add(bar())
    system.add(mb.RevoluteJoint("O", system.ground.point(0.0, 0.0), own.start))
    system.add(mb.RevoluteJoint("A", system.ground.point(3.0, 0.0), own.end))
    return system


def locked() -> mb.System:
    system = mb.System()
    own = system.add(bar())
    system.add(mb.FixedJoint("weld", system.ground, own.start))
    system.add(mb.RevoluteJoint("pin", system.ground, own.end))
    return system


def redundant() -> mb.System:
    """A bar with two pins at the same point."""
    system = mb.System()
    own = system.add(bar())
    for name in ("pin", "other pin"):
        system.add(mb.RevoluteJoint(name, system.ground, own.start))
    return system


def contradictory() -> mb.System:
    """A wheel on a bar that turns, whose velocity is stated as that of a bar at rest."""
    system = mb.System()
    own = system.add(bar(angular_velocity=12.0))
    wheel = system.add(mb.PointMass("wheel", 1.0, own.end, velocity=(0.0, 0.0)))
    system.add(mb.RevoluteJoint("pin", system.ground, own.start))
    system.add(mb.RevoluteJoint("axle", own.end, wheel.centre))
    return system


def driven_apart() -> mb.System:
    system = mb.System()
    own = system.add(bar())
    for name, rate in (("slow", 1.0), ("fast", 2.0)):
        course = mb.Polynomial([0.0, rate])
        system.add(mb.PrescribedMotion(name, system.ground, own.start, "angle", course))
    return system


def not_added() -> mb.System:
    system = mb.System()
    system.add(mb.RevoluteJoint("pin", system.ground, bar().start))
    system.add(bar("other"))
    return system


def placed_at_a_stranger() -> mb.System:
    system = mb.System()
    system.add(bar("arm", start=bar("stranger").end))
    return system


def sides(joint: type, *names: str) -> Callable:
    """A joint between named points, ``ground`` the ground."""

    def make(system: mb.System, own: mb.RigidBar, mass: mb.PointMass) -> object:
        points = {"ground": system.ground, "start": own.start, "end": own.end, "mass": mass.centre}
        return joint("link", *(points[name] for name in names))

    return lambda: with_mass(make)


MECHANISMS = {
    "no body": (mb.System, "the system has no body; add one"),
    "a loop that cannot close": (
        too_short,
        "the mechanism cannot be assembled: joint 'A' has a gap of 2 (m or rad). Check lengths and places of the "
        "bodies that it connects; a first placement nearer to the closed position may be needed, or fewer driving "
        "coordinates",
    ),
    "no freedom": (
        locked,
        "the mechanism cannot move: its joints have 5 constraints, its bodies 3 degrees of freedom, and none is left. "
        "Take joint 'weld' out, or replace it by one that holds less.",
    ),
    "redundant constraints": (
        redundant,
        "the constraints are redundant: 4 were given, 2 are independent at the start; those of 'other pin' follow from the "
        "others. Take a joint out or replace one by a joint that holds less (a revolute joint instead of a fixed one), "
        "or start from a position that is not singular; RungeKutta4 and OdeSolver take redundant constraints as they "
        "are",
    ),
    "velocities against a joint": (
        contradictory,
        "the stated initial velocities contradict joint 'axle', 'pin' by 6 (m/s or rad/s): bar.angular_velocity is "
        "12 rad/s (nearest possible: 6), wheel.velocity is (0, 0) m/s (nearest possible: (0, 6)). Correct them, or "
        "leave out those that follow from the joints",
    ),
    "prescribed motions of different velocities": (
        driven_apart,
        "no initial velocities satisfy joint 'slow': 0.5 (m/s or rad/s) remain. Check the prescribed motions at the "
        "start",
    ),
    "a joint on a body that was not added": (
        not_added,
        "'pin': its point bar.start belongs to a body that is not in the system (or not yet); add 'bar' first",
    ),
    "a body placed at a body that was not added": (
        placed_at_a_stranger,
        "'arm': its point stranger.end belongs to a body that is not in the system (or not yet); add 'stranger' first",
    ),
    "a point mass in a fixed joint": (
        sides(mb.FixedJoint, "mass", "end"),
        "FixedJoint 'link': mass.centre has no direction; use a revolute or distance joint, or a rigid body",
    ),
    "a point mass in a slide": (
        sides(mb.PrismaticJoint, "ground", "mass"),
        "PrismaticJoint 'link': mass.centre has no direction; use a revolute or distance joint, or a rigid body",
    ),
    "an angle of a point mass": (
        sides(mb.PrescribedMotion, "ground", "mass"),
        "PrescribedMotion 'link': mass.centre has no direction; use a revolute or distance joint, or a rigid body",
    ),
    "friction on a point mass": (
        lambda: with_mass(lambda system, own, mass: mb.RevoluteJoint("link", own.end, mass.centre, viscous=0.1)),
        "RevoluteJoint 'link': mass.centre has no direction; use a rigid body where a joint has friction",
    ),
    "a torque on a point mass": (
        lambda: with_mass(lambda system, own, mass: mb.Torque("motor", mass.centre, 1.0)),
        "torque 'motor': mass.centre has no direction; use a force, or a rigid body",
    ),
    "a torque against a point mass": (
        lambda: with_mass(lambda system, own, mass: mb.Torque("motor", own.end, 1.0, against=mass.centre)),
        "torque 'motor': mass.centre has no direction; use a force, or a rigid body",
    ),
    "a torsion spring on a point mass": (
        lambda: with_mass(lambda system, own, mass: mb.TorsionSpring("coil", own.end, mass.centre, 1.0)),
        "torsion spring 'coil': mass.centre has no direction; use a spring, or a rigid body",
    ),
    "a force that follows a point mass": (
        lambda: with_mass(lambda system, own, mass: mb.Force("jet", mass.centre, x=1.0, follower=True)),
        "follower force 'jet': mass.centre has no direction; use a force that does not follow, or a rigid body",
    ),
    "a rod of no length": (
        sides(mb.DistanceJoint, "end", "mass"),
        "distance joint 'link': its points bar.end and mass.centre coincide and no length is given; give a length, or "
        "use a revolute joint",
    ),
    "a joint of the ground with itself": (
        sides(mb.RevoluteJoint, "ground", "ground"),
        "'link': it acts on the ground only; give it a point of a body",
    ),
    "a force on a place of the ground": (
        lambda: with_mass(lambda system, own, mass: mb.Force("push", system.ground.point(1.0, 0.0), x=1.0)),
        "'push': it acts on the ground only; give it a point of a body",
    ),
    "a joint of a body with itself": (
        sides(mb.RevoluteJoint, "start", "end"),
        "'link': both its points, bar.start and bar.end, belong to the same rigid body, so it does nothing; give it "
        "points of two bodies, or of a body and the ground",
    ),
}


@pytest.mark.parametrize("defect", MECHANISMS)
def test_a_mechanism_that_is_not_well_posed_is_told(defect: str) -> None:
    make, sentence = MECHANISMS[defect]
    with pytest.raises(ModelError, match=says(sentence)):
        mb.simulate(make(), 1.0)


@pytest.mark.parametrize("name", ["pin", "bar", "ground", "system"])
def test_a_name_that_is_taken_is_told(name: str) -> None:
    with pytest.raises(ModelError, match=says(f"RigidBar {name!r}: the name is taken; give each component its own")):
        pendulum().add(bar(name))


SECTION = {"density": 1.0, "height": 0.1, "width": 0.1}
INPUTS = {
    "an angle that is not a number": (
        lambda: bar("arm", angle=np.nan),
        "RigidBar 'arm': angle is nan; expected a finite number in rad",
    ),
    "a velocity that is not a number": (
        lambda: bar("arm", velocity=(0.0, np.nan)),
        "RigidBar 'arm': velocity is (0.0, nan); expected two finite numbers in m/s, such as (0.0, 0.0)",
    ),
    "a stiffness that is not a number": (
        lambda: mb.Spring("coil", mb.System().ground, bar().end, np.nan),
        "Spring 'coil': stiffness is nan; expected a finite number in N/m",
    ),
    "a load that is not a number": (
        lambda: mb.Force("push", bar().end, x=mb.Harmonic(np.nan, 1.0)),
        "Harmonic: amplitude is nan; expected a finite number",
    ),
    "a place of the ground that is not a number": (
        lambda: mb.System().ground.point(np.nan, 0.0),
        "GroundPoint: x is nan; expected a finite number",
    ),
    "gravity that is not a number": (
        lambda: mb.System((0.0, np.nan)),
        "System: gravity is (0.0, nan); expected two finite numbers in m/s^2, along x and y, such as (0.0, -9.81)",
    ),
    "what is no component": (
        lambda: mb.System().add("bar"),
        "'bar' was added to a system; expected a body, a joint or a load",
    ),
    "a body that is not there": (lambda: pendulum().body("baer"), "unknown body 'baer'; did you mean 'bar'?"),
    "a point that is not there": (
        lambda: bar().point("stat"),
        "body 'bar': unknown point 'stat'; did you mean 'start'?",
    ),
    "a length of zero": (
        lambda: mb.RigidBar("bar", length=0.0, mass=1.0),
        "RigidBar 'bar': length is 0 m; expected a positive number",
    ),
    "a mass that is negative": (
        lambda: mb.PointMass("bob", mass=-1.0),
        "PointMass 'bob': mass is -1 kg; expected a positive number",
    ),
    "an inertia that is not a number": (
        lambda: mb.RigidBody("plate", 1.0, np.nan),
        "RigidBody 'plate': inertia is nan; expected a finite number in kg*m**2",
    ),
    "an anchor that is no point": (
        lambda: mb.RigidBody("plate", 1.0, 1.0, anchor="center"),
        "rigid body 'plate': unknown anchor 'center'; did you mean 'centre'?",
    ),
    "a point named as the centre": (
        lambda: mb.RigidBody("plate", 1.0, 1.0, points={"centre": (0.0, 1.0)}),
        "rigid body 'plate': the point name 'centre' is taken by the centre of mass",
    ),
    "more elements than a memory holds": (
        lambda: mb.AncfCable("rope", 1.0, 2**62, 1e6, **SECTION),
        "beam 'rope': elements is 4611686018427387904; expected a whole number, from 1 to 100000",
    ),
    "no elements": (
        lambda: mb.AncfCable("rope", 1.0, 0, 1e6, **SECTION),
        "beam 'rope': elements is 0; expected a whole number, from 1 to 100000",
    ),
    "a Poisson ratio of one half": (
        lambda: mb.AncfBeam("bar", 1.0, 1, 1e6, poisson_ratio=0.5, **SECTION),
        "AncfBeam 'bar': poisson_ratio is 0.5; expected a number between -1 and 0.5",
    ),
    "a law that is not there": (
        lambda: mb.AncfBeam("bar", 1.0, 1, 1e6, poisson_ratio=0.3, **SECTION, law="plane stress"),
        "beam 'bar': unknown law 'plane stress'; did you mean 'plane-stress' or 'plane-strain'?",
    ),
    "a formulation that is not there": (
        lambda: mb.AncfBeam("bar", 1.0, 1, 1e6, poisson_ratio=0.3, **SECTION, formulation="continua"),
        "beam 'bar': unknown formulation 'continua'; did you mean 'continuum'?",
    ),
    "damping that is negative": (
        lambda: mb.AncfCable("rope", 1.0, 1, 1e6, **SECTION, damping=-1e-3),
        "AncfCable 'rope': damping is -0.001 s; expected zero or a positive number",
    ),
    "friction that is negative": (
        lambda: mb.RevoluteJoint("pin", mb.Ground(), bar().start, coulomb=-0.1),
        "RevoluteJoint 'pin': coulomb is -0.1 N*m; expected zero or a positive number",
    ),
    "a slip rate of zero": (
        lambda: mb.RevoluteJoint("pin", mb.Ground(), bar().start, slip_rate=0.0),
        "RevoluteJoint 'pin': slip_rate is 0 rad/s; expected a positive number",
    ),
    "a friction coefficient without a lever": (
        lambda: mb.RevoluteJoint("pin", mb.Ground(), bar().start, friction_coefficient=0.3),
        "revolute joint 'pin': a friction_coefficient was given without a pin_radius, so it would have no lever; give "
        "the pin's radius in m",
    ),
    "a slip velocity of zero": (
        lambda: mb.PrismaticJoint("slide", mb.Ground(), bar().start, slip_velocity=0.0),
        "PrismaticJoint 'slide': slip_velocity is 0 m/s; expected a positive number",
    ),
    "a rod of negative length": (
        lambda: mb.DistanceJoint("rod", mb.Ground(), bar().start, length=-1.0),
        "DistanceJoint 'rod': length is -1 m; expected a positive number",
    ),
    "a coordinate that is not there": (
        lambda: mb.PrescribedMotion("drive", mb.Ground(), bar().start, coordinate="angel"),
        "prescribed motion 'drive': unknown coordinate 'angel'; did you mean 'angle'?",
    ),
    "a free length that is negative": (
        lambda: mb.Spring("coil", mb.Ground(), bar().start, 1.0, free_length=-1.0),
        "Spring 'coil': free_length is -1 m; expected zero or a positive number",
    ),
    "a step of zero": (
        lambda: mb.GeneralizedAlpha(step=0.0),
        "GeneralizedAlpha: step is 0 s; expected a positive number",
    ),
    "a spectral radius above one": (
        lambda: mb.GeneralizedAlpha(1e-3, spectral_radius=1.1),
        "GeneralizedAlpha: spectral_radius is 1.1; expected a number from 0 to 1",
    ),
    "a start that is not there": (
        lambda: mb.GeneralizedAlpha(1e-3, initial_acceleration="consistant"),
        "GeneralizedAlpha: unknown initial_acceleration 'consistant'; did you mean 'consistent'?",
    ),
    "a tolerance of zero": (
        lambda: mb.GeneralizedAlpha(1e-3, adaptive=True, tolerance=0.0),
        "GeneralizedAlpha: tolerance is 0; expected a positive number",
    ),
    "a Newton tolerance that is not a number": (
        lambda: mb.GeneralizedAlpha(1e-3, newton_tolerance=np.nan),
        "GeneralizedAlpha: newton_tolerance is nan; expected a positive number",
    ),
    "an end that is infinite": (
        lambda: mb.simulate(pendulum(), np.inf),
        "simulate: end is inf; expected a positive number of seconds",
    ),
    "times that do not increase": (
        lambda: mb.simulate(pendulum(), 1.0, times=np.array([0.0, 0.5, 0.5])),
        "times: expected a list of increasing numbers of seconds",
    ),
    "times that are not numbers": (
        lambda: mb.simulate(pendulum(), 1.0, times=np.array([0.0, np.nan])),
        "times: expected a list of increasing numbers of seconds",
    ),
    "times after the end": (
        lambda: mb.simulate(pendulum(), 1.0, times=np.array([0.0, 2.0])),
        "times: they reach from 0 to 2 s, but the motion ends at 1 s; expected times within",
    ),
    "no channels": (
        lambda: mb.TimeResponse(pendulum, {}, [], np.array([0.0, 1.0])),
        "TimeResponse: no channels were given; name at least one, such as 'AB.end.x'",
    ),
    "no duration": (
        lambda: mb.TimeResponse(pendulum, {}, ["bar.end.x"], np.array([0.0])),
        "TimeResponse: the last of the times is 0 s; expected a motion of some duration",
    ),
    "a channel that is not there": (
        lambda: mb.simulate(pendulum(), 0.01).channels(["bar.end.z"]),
        "unknown channel 'bar.end.z'; did you mean 'bar.end.y' or 'bar.end.x'?",
    ),
    "a channel of a response that is not there": (
        lambda: mb.TimeResponse(pendulum, {}, ["pin.force"], np.array([0.0, 1.0])).channels,
        "unknown channel 'pin.force'; did you mean 'pin.force_y' or 'pin.force_x'?",
    ),
}


@pytest.mark.parametrize("defect", INPUTS)
def test_an_input_that_cannot_be_meant_is_told(defect: str) -> None:
    make, sentence = INPUTS[defect]
    with pytest.raises(InputError, match=says(sentence)):
        make()


def test_a_step_that_is_too_large_is_cut_down_and_then_told() -> None:
    """A beam under a load that turns it inside out within a step."""
    system = mb.System()
    beam = system.add(mb.AncfBeam("beam", 1.0, 2, 1e3, poisson_ratio=0.3, **SECTION))
    system.add(mb.FixedJoint("weld", system.ground, beam.start))
    system.add(mb.Force("blow", beam.end, x=-1e9))
    with pytest.raises(SolveError) as told:
        mb.simulate(system, 1.0, mb.GeneralizedAlpha(step=0.5))
    start, end = str(told.value).split(" s, ", 1)
    assert start.startswith("Newton's iteration did not converge at t = 0")
    assert end == (
        "worst at component 'beam', though the step of 0.5 s was cut down to 1/256 for it; take a smaller step, or "
        "check the component's stiffness, loads and dimensions"
    )


def test_an_adaptive_run_that_takes_too_many_steps_is_told() -> None:
    solver = mb.GeneralizedAlpha(step=1e-3, adaptive=True, tolerance=1e-12, most_steps=20)
    with pytest.raises(SolveError, match=r"^the adaptive step reached most_steps = 20 at t = 0\..*") as told:
        mb.simulate(pendulum(), 1.0, solver)
    assert str(told.value).endswith(" s; raise tolerance or most_steps")


def test_a_number_too_large_to_compute_with_is_refused():
    with pytest.raises(
        InputError, match=says("RigidBar 'bar': length is 1e+300; expected a number below 1e+100 in size")
    ):
        mb.RigidBar("bar", 1e300, 1.0)
