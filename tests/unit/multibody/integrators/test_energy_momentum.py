"""The energy-momentum integrator: settings, derivatives of its discrete solution, the rigid motions that it leaves."""

import numpy as np
import pytest

import dalembert.multibody as mb
import dalembert.multibody.spatial as sp
from dalembert.errors import InputError
from dalembert.multibody.integrators.midpoint.symmetries import rigid_motions
from dalembert.multibody.model.evaluate import tangent
from dalembert.multibody.start.assemble import assembled
from mechanisms import cable, plate
from slopes import errors
from support import says


def test_settings_that_cannot_be_meant() -> None:
    with pytest.raises(InputError, match=says("EnergyMomentum: step is -1 s; expected a positive number")):
        mb.EnergyMomentum(step=-1.0)


def spun(x: float, mass: float, stiffness: float, rate: float) -> mb.System:
    """Turns about a pin that is not in the origin; its angular momentum is left."""
    system = mb.System(gravity=(0.0, 0.0))
    pin = system.ground.point(x, 0.3)
    bar = system.add(mb.RigidBar("bar", 1.0, mass, start=pin, angle=0.2, angular_velocity=rate))
    bob = system.add(mb.PointMass("bob", 2.0, (x + 1.5, 1.0)))
    system.add(mb.RevoluteJoint("pin", pin, bar.start))
    system.add(mb.Spring("spring", bar.end, bob.centre, stiffness))
    return system


def flown(x: float, mass: float, stiffness: float, rate: float) -> mb.System:
    """The same without a pin."""
    system = spun(x, mass, stiffness, rate)
    system.joints.clear()
    return system


@pytest.mark.parametrize("build", [spun, flown])
def test_derivatives_where_rigid_motions_are_free(build) -> None:
    bounds = {"x": (0.2, 0.6), "mass": (1.0, 3.0), "stiffness": (20.0, 60.0), "rate": (2.0, 6.0)}
    times = np.array([0.0, 0.2, 0.45, 0.6])
    channels = ("bob.centre.x", "bob.centre.vy", "bar.end.ax", "system.kinetic_energy")
    error, size = errors(mb.TimeResponse(build, bounds, channels, times, mb.EnergyMomentum(step=2e-2)))
    assert min(size.values()) > 1e-5
    assert max(error.values()) < 1e-6


def scene(gravity: tuple[float, float], *holds: str) -> mb.System:
    system = mb.System(gravity=gravity)
    body = system.add(plate(position=(0.1, 0.2)))
    soft = system.add(cable("soft", start=(1.0, 0.0)))
    system.add(mb.DistanceJoint("rod", body.point("grip"), soft.start))
    if "pin" in holds:
        system.add(mb.RevoluteJoint("pin", system.ground.point(0.1, 0.2), body.point("grip")))
    if "spring" in holds:
        system.add(mb.Spring("spring", system.ground.point(0.1, 0.2), soft.end, 5.0))
    if "other" in holds:
        system.add(mb.Spring("other", system.ground.point(3.0, 0.2), soft.end, 5.0))
    if "torsion" in holds:
        system.add(mb.TorsionSpring("torsion", system.ground, body.point("grip"), 5.0))
    return system


@pytest.mark.parametrize(
    ("gravity", "holds", "spins"),
    [
        ((0.0, 0.0), (), [False, False, True]),
        ((0.0, -9.81), (), [False]),
        ((1.0, -9.81), (), []),
        ((0.0, 0.0), ("pin",), [True]),
        ((0.0, 0.0), ("pin", "spring"), [True]),
        ((0.0, 0.0), ("spring", "other"), []),
        ((0.0, 0.0), ("torsion",), []),
        ((0.0, -9.81), ("pin",), []),
    ],
)
def test_free_rigid_motions(gravity: tuple[float, float], holds: tuple[str, ...], spins: list[bool]) -> None:
    assert rigid_motions(assembled(scene(gravity, *holds)), ()).sign.any(axis=1).tolist() == spins


def test_a_mass_that_turns_about_a_point_has_no_other_motion() -> None:
    """All that it does is the rigid motion that is left, and nothing needs a correction."""
    system = mb.System(gravity=(0.0, 0.0))
    mass = system.add(mb.PointMass("mass", 2.0, (1.0, 0.0), velocity=(0.0, 3.0)))
    system.add(mb.DistanceJoint("rod", system.ground.point(0.0, 0.0), mass.centre))
    total = mb.simulate(system, 2.0, mb.EnergyMomentum(step=1e-2)).energies["total"]
    np.testing.assert_allclose(total, 9.0, rtol=1e-13)


def in_space(gravity: tuple[float, float, float], *holds: str) -> sp.SpatialSystem:
    system = sp.SpatialSystem(gravity=gravity)
    box = system.add(sp.RigidBody("box", sp.Inertia.box(1.0, (0.1, 0.2, 0.3)), angular_velocity=(3.0, 1.0, -2.0)))
    rope = system.add(sp.Cable("rope", 1.0, 2, axial_stiffness=1e3, mass_per_length=0.2, position=box.point("centre")))
    system.add(sp.SphericalJoint("eye", box.point("centre"), rope.start))
    if "ball" in holds:
        system.add(sp.SphericalJoint("ball", system.ground.point((0.0, 0.0, 0.0)), box.point("origin")))
    if "spring" in holds:
        system.add(sp.Spring("spring", system.ground.point((0.3, 0.2, 0.1)), rope.end, 50.0))
    return system


@pytest.mark.parametrize(
    ("gravity", "holds", "turns"),
    [
        ((0.0, 0.0, 0.0), (), [False] * 3 + [True] * 3),
        ((0.0, 0.0, -9.81), (), [False] * 2 + [True]),
        ((0.0, 0.0, -9.81), ("ball",), [True]),
        ((0.0, 3.0, -9.81), (), [False]),
        ((0.0, 0.0, 0.0), ("ball",), [True] * 3),
        ((0.0, 0.0, 0.0), ("ball", "spring"), []),
    ],
)
def test_free_rigid_motions_in_space(gravity, holds, turns) -> None:
    assert rigid_motions(assembled(in_space(gravity, *holds)), ()).sign.any(axis=1).tolist() == turns


def angular_momentum(motion: mb.Trajectory) -> np.ndarray:
    """Sum of x x (M v) over all vectors, about the origin, (times, 3)."""
    lowered, states = motion.lowered, motion.states
    n = lowered.structure.n
    still = np.zeros(n)
    mass = tangent(lowered, lowered.x, np.zeros_like(lowered.x), (0.0, 0.0, 1.0)).toarray()[:n, :n]
    momenta = states.v[:, :n] @ mass + still
    vectors, momenta = (part.reshape(len(motion.times), -1, 3) for part in (states.x[:, :n], momenta))
    return np.cross(vectors, momenta).sum(axis=1)


@pytest.mark.parametrize("holds", [(), ("ball",)])
def test_the_angular_momentum_in_space_is_kept(holds) -> None:
    """Of a rigid body with a cable, free, and held at the origin."""
    motion = mb.simulate(in_space((0.0, 0.0, 0.0), *holds), 1.0, mb.EnergyMomentum(step=5e-3))
    momenta, total = angular_momentum(motion), motion.energies["total"]
    np.testing.assert_allclose(momenta, np.tile(momenta[0], (len(momenta), 1)), atol=1e-11 * np.abs(momenta).max())
    np.testing.assert_allclose(total, total[0], rtol=1e-12)


@pytest.mark.slow
def test_damping_leaves_a_rigid_rotation() -> None:
    """A damped beam that spins steadily loses nothing, once its vibrations have died."""
    section = sp.Section.rectangle(0.02, 0.01, youngs_modulus=2e9, poisson_ratio=0.3, density=1200.0)
    system = sp.SpatialSystem(gravity=(0.0, 0.0, 0.0))
    system.add(sp.Beam("b", section, 0.5, 1, angular_velocity=(0.0, 0.0, 50.0), damping=2e-3))
    motion = mb.simulate(system, 3.0, mb.EnergyMomentum(step=2e-3))
    total = motion.energies["total"][motion.times > 2.0]
    np.testing.assert_allclose(total, total[0], rtol=1e-9)
    momenta = angular_momentum(motion)
    np.testing.assert_allclose(momenta[:, 2], momenta[0, 2], rtol=1e-11)
