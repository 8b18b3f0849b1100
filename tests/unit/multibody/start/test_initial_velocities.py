"""Initial velocities: stated ones are kept, the others follow from points and joints, with exact derivatives."""

import numpy as np
import pytest

import dalembert.multibody as mb
from dalembert.errors import ModelError
from dalembert.multibody.start.assemble import assembled
from dalembert.parameter import Parameter

AT_START = np.array([0.0, 1e-3])


def first(system: mb.System, *names: str) -> np.ndarray:
    return mb.simulate(system, 1e-3).channels(names)[0]


def linked(upper: float = 2.0, lower: float = 1.0, **motion) -> mb.System:
    """Two bars on pins."""
    system = mb.System()
    one = system.add(mb.RigidBar("one", 1.0, 1.0, angle=0.3, angular_velocity=upper))
    two = system.add(mb.RigidBar("two", 0.7, 1.0, angle=-0.8, start=one.end, angular_velocity=lower, **motion))
    system.add(mb.RevoluteJoint("O", system.ground, one.start))
    system.add(mb.RevoluteJoint("A", one.end, two.start))
    return system


def crank(
    rate: float | None = 12.0, rod: str = "rigid", length: float = 0.3, slider_velocity: tuple | None = None, **motion
) -> mb.System:
    """A slider-crank that is closed, whose crank turns."""
    system = mb.System()
    arm = system.add(mb.RigidBar("crank", 0.1, 1.0, angle=1.0, angular_velocity=rate))
    placed = {"start": arm.end, "angle": -np.arcsin(0.1 * np.sin(1.0) / length), **motion}
    if rod == "rigid":
        link = system.add(mb.RigidBar("rod", length, 1.0, **placed))
    else:
        link = system.add(mb.AncfCable("rod", length, 2, 2e9, 2000.0, 0.02, 0.02, **placed))
    slider = system.add(mb.RigidBody("slider", 0.5, 0.1, position=link.end, velocity=slider_velocity))
    system.add(mb.RevoluteJoint("O", system.ground, arm.start))
    system.add(mb.RevoluteJoint("A", arm.end, link.start))
    system.add(mb.RevoluteJoint("B", link.end, slider.centre))
    system.add(mb.PrismaticJoint("guide", system.ground, slider.centre))
    return system


def test_rates_of_linked_bars_are_kept() -> None:
    assert first(linked(), "one.end.rate", "two.end.rate").tolist() == [2.0, 1.0]
    along = first(linked(), "one.end.vx", "one.end.vy", "two.start.vx", "two.start.vy")
    np.testing.assert_array_equal(along[:2], along[2:])


def test_the_velocity_of_the_point_may_be_stated_too() -> None:
    velocity = (-2.0 * np.sin(0.3), 2.0 * np.cos(0.3))
    assert first(linked(velocity=velocity), "one.end.rate", "two.end.rate").tolist() == [2.0, 1.0]


@pytest.mark.parametrize("rod", ["rigid", "flexible"])
def test_what_is_not_stated_follows_from_the_joints(rod: str) -> None:
    """By the derivative of the slider's place r cos a + sqrt(l^2 - r^2 sin^2 a)."""
    turn, speed = first(crank(rod=rod), "crank.end.rate", "slider.centre.vx")
    sine, cosine = np.sin(1.0), np.cos(1.0)
    slope = -0.1 * sine - 0.1**2 * sine * cosine / np.sqrt(0.3**2 - (0.1 * sine) ** 2)
    assert turn == 12.0
    assert speed == pytest.approx(12.0 * slope, rel=1e-12)


def test_a_stated_velocity_behind_the_joints_drives_the_others() -> None:
    given = first(crank(rate=None, angular_velocity=5.0), "rod.end.rate", "crank.end.rate")
    tilt = -np.arcsin(0.1 * np.sin(1.0) / 0.3)
    np.testing.assert_allclose(given, [5.0, -5.0 * 0.3 * np.cos(tilt) / (0.1 * np.cos(1.0))], rtol=1e-12)


def test_a_velocity_against_the_joints_is_refused_with_the_possible_one() -> None:
    """A rod that is stated not to turn, on a crank that does."""
    with pytest.raises(
        ModelError, match=r"contradict joint .*: crank\.angular_velocity is 12 rad/s \(nearest possible"
    ):
        mb.simulate(crank(angular_velocity=0.0), 1e-3)


def test_zero_is_a_stated_velocity() -> None:
    system = mb.System()
    mass = system.add(mb.PointMass("mass", 1.0, (1.0, 0.0), velocity=(0.0, 0.0)))
    system.add(
        mb.PrescribedMotion("perturb", system.ground.point(0.0, 0.0), mass.centre, "y", mb.Polynomial([0.0, 3.0]))
    )
    with pytest.raises(
        ModelError, match=r"joint 'perturb' by 3 .*mass\.velocity is \(0, 0\) m/s \(nearest possible: \(0, 3\)\)"
    ):
        mb.simulate(system, 1e-3)
    free = mb.PointMass("mass", 1.0, (1.0, 0.0))
    system.bodies[:] = [free]
    system.joints[:] = []
    system.add(mb.PrescribedMotion("rail", system.ground.point(0.0, 0.0), free.centre, "y", mb.Polynomial([0.0, 3.0])))
    assert first(system, "mass.centre.vy").tolist() == [3.0]


def test_a_body_at_a_point_moves_with_it_without_a_joint() -> None:
    """On a spring and at a point of a beam, and a mass at the end of that body."""
    system = mb.System(gravity=(0.0, 0.0))
    beam = system.add(mb.AncfCable("beam", 1.0, 2, 2e6, 900.0, 0.05, 0.05, angle=0.4, angular_velocity=3.0))
    bar = system.add(mb.RigidBar("bar", 0.5, 1.0, start=beam.end, angle=1.0, angular_velocity=-2.0))
    mass = system.add(mb.PointMass("mass", 1.0, bar.end))
    system.add(mb.Spring("spring", beam.end, bar.end, 10.0))
    given = first(system, "bar.start.vx", "bar.start.vy", "mass.centre.vx", "mass.centre.vy", "bar.end.rate")
    start = 3.0 * np.array([-np.sin(0.4), np.cos(0.4)])
    end = start - 2.0 * 0.5 * np.array([-np.sin(1.0), np.cos(1.0)])
    np.testing.assert_allclose(given, [*start, *end, -2.0], rtol=1e-14)
    assert mass.motion == (None, None, None)


def test_the_nearest_bodies_follow_a_moved_one() -> None:
    """A wheel that hangs by a spring at a rod that follows from its loop moves with the rod's point."""
    system = crank()
    wheel = system.add(mb.RigidBody("wheel", 1.0, 0.1, position=system.body("rod").point("centre")))
    system.add(mb.Spring("spring", system.ground.point(0.0, 1.0), wheel.centre, 10.0))
    given = first(system, "wheel.centre.vx", "wheel.centre.vy", "rod.centre.vx", "rod.centre.vy", "wheel.centre.rate")
    np.testing.assert_allclose(given[:2], given[2:4], rtol=1e-12)
    assert given[4] == 0.0


def test_stated_velocities_keep_their_bits() -> None:
    """Those that the joints allow are not touched, however they are rounded."""
    rates = 0.1 + 0.2, 1.0 / 3.0
    lowered = assembled(linked(*rates))
    assert [lowered.v[2], lowered.v[5]] == list(rates)


ALLOWED = {"rigid": 1e-7, "flexible": 1e-4}  # differences of stiff beams are rough
NAMES = ["slider.centre.x", "slider.centre.vx", "rod.centre.rate", "guide.force_y"]


@pytest.mark.parametrize("rod", ["rigid", "flexible"])
def test_derivatives_by_initial_velocities_are_exact(rod: str) -> None:
    names = NAMES if rod == "rigid" else [name.replace("rod.centre", "rod.end") for name in NAMES]
    times = np.linspace(0.0, 0.02, 5)
    model = mb.TimeResponse(
        lambda rate, length: crank(rate, rod, length),
        {"rate": (10.0, 14.0), "length": (0.25, 0.35)},
        names,
        times,
        mb.RadauIIA(step=1e-3),
    )
    at = np.array([12.0, 0.3])
    exact = model.jacobian(at)
    for column, step in enumerate((1e-3, 1e-5)):
        shift = step * np.eye(2)[column]
        after, before = model.evaluate(np.array([at + shift, at - shift])).only()
        slope = (after - before) / (2 * step)
        size = np.max(np.abs(slope), axis=0)
        np.testing.assert_allclose(exact[:, :, column] / size, slope / size, rtol=0, atol=ALLOWED[rod])


def test_a_velocity_that_fits_at_one_value_only_has_no_derivative() -> None:
    """The slider's stated velocity fits one rate of the crank."""
    speed = first(crank(), "slider.centre.vx")[0]

    model = mb.TimeResponse(
        lambda rate: crank(rate, slider_velocity=(speed, 0.0)),
        {"rate": Parameter("rate", 11.0, 13.0, start=12.0)},
        ["slider.centre.x"],
        AT_START,
    )
    with pytest.raises(ModelError, match=r"satisfy joint '(A|B|O|guide)', but not for other values of a parameter"):
        model.jacobian(np.array([12.0]))
