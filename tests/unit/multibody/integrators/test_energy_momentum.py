"""The energy-momentum integrator: settings, derivatives of its discrete solution, the rigid motions that it leaves."""

import numpy as np
import pytest

import dalembert.multibody as mb
import dalembert.multibody.spatial as sp
from dalembert.errors import InputError
from dalembert.multibody.integrators.midpoint.symmetries import rigid_motions
from dalembert.multibody.start.assemble import assembled
from mechanisms import cable, plate
from momenta import momenta
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
        ((0.0, 0.0), (), [0.0, 0.0, 1.0]),
        ((0.0, -9.81), (), [0.0]),
        ((1.0, -9.81), (), []),
        ((0.0, 0.0), ("pin",), [1.0]),
        ((0.0, 0.0), ("pin", "spring"), [1.0]),
        ((0.0, 0.0), ("spring", "other"), []),
        ((0.0, 0.0), ("torsion",), []),
        ((0.0, -9.81), ("pin",), []),
    ],
)
def test_free_rigid_motions(gravity: tuple[float, float], holds: tuple[str, ...], spins: list[float]) -> None:
    assert rigid_motions(assembled(scene(gravity, *holds)), ()).spin.tolist() == spins


@pytest.mark.parametrize(
    ("gravity", "is_held", "axes"),
    [
        ((0.0, 0.0, 0.0), False, [0, 1, 2]),
        ((0.0, 0.0, -9.81), False, [0, 1]),
        ((1.0, 0.0, -9.81), False, [1]),
        ((0.0, 0.0, 0.0), True, []),
    ],
)
def test_free_translations_in_space(gravity: tuple[float, ...], is_held: bool, axes: list[int]) -> None:
    system = sp.SpatialSystem(gravity=gravity)
    body = system.add(sp.RigidBody("body", sp.Inertia.box(2.0, (0.1, 0.2, 0.3))))
    if is_held:
        system.add(sp.SphericalJoint("ball", system.ground, body.point("origin")))
    rigid = rigid_motions(assembled(system), ())
    assert not np.any(rigid.spin)
    assert [int(np.argmax(shift)) for shift in rigid.shift] == axes


def test_a_mass_that_turns_about_a_point_has_no_other_motion() -> None:
    """All that it does is the rigid motion that is left, and nothing needs a correction."""
    system = mb.System(gravity=(0.0, 0.0))
    mass = system.add(mb.PointMass("mass", 2.0, (1.0, 0.0), velocity=(0.0, 3.0)))
    system.add(mb.DistanceJoint("rod", system.ground.point(0.0, 0.0), mass.centre))
    total = mb.simulate(system, 2.0, mb.EnergyMomentum(step=1e-2)).energies["total"]
    np.testing.assert_allclose(total, 9.0, rtol=1e-13)


@pytest.mark.parametrize(("side", "damping"), [(1e-2, 0.0), (1e-3, 0.0), (1e-2, 1e-2)])
def test_slender_and_damped_beams_need_no_shorter_steps(side: float, damping: float) -> None:
    section = sp.Section.rectangle(side, side, youngs_modulus=2e11, poisson_ratio=0.3, density=7800.0)
    system = sp.SpatialSystem(gravity=(0.0, 0.0, 0.0))
    system.add(sp.Beam("b", section, 1.0, 4, damping=damping, angular_velocity=(0.3, -0.2, 5.0)))
    motion = mb.simulate(system, 0.1, mb.EnergyMomentum(step=1e-3))
    assert len(motion.newton_iterations) == 100
    conserved = momenta(motion)
    np.testing.assert_allclose(conserved, np.tile(conserved[0], (101, 1)), atol=1e-13 * np.abs(conserved).max())
    total = motion.energies["total"]
    if damping:
        assert np.all(np.diff(total) < 1e-12 * total[0])
    else:
        np.testing.assert_allclose(total, total[0], rtol=1e-13)


def test_the_energy_in_space_is_kept_with_few_steps() -> None:
    """A beam that tumbles and vibrates: its stretch is stiff, and no step is cut."""
    section = sp.Section.rectangle(0.02, 0.01, youngs_modulus=2e9, poisson_ratio=0.3, density=1200.0)
    system = sp.SpatialSystem(gravity=(0.0, 0.0, 0.0))
    fields = {"angular_velocity": (1.0, 4.0, 3.0), "curvature": (0.0, 0.0, 0.3)}
    system.add(sp.Beam("b", section, 1.0, 1, **fields))
    motion = mb.simulate(system, 0.2, mb.EnergyMomentum(step=1e-3))
    assert len(motion.newton_iterations) == 200
    total = motion.energies["total"]
    np.testing.assert_allclose(total, total[0], rtol=1e-12)
