"""Motions that begin at rest in the static equilibrium."""

import numpy as np
import pytest

from dalembert import study
from dalembert.errors import InputError, ModelError, SolveError
from dalembert.multibody import (
    AncfCable,
    FixedJoint,
    Force,
    GeneralizedAlpha,
    PointMass,
    Polynomial,
    PrescribedMotion,
    RadauIIA,
    RevoluteJoint,
    RigidBar,
    Spring,
    Step,
    System,
    TimeResponse,
    TorsionSpring,
    equilibrium,
    simulate,
)

LENGTH, DENSITY, GRAVITY = 1.0, 2700.0, 9.81


def strip(young: float = 70e9, density: float = DENSITY, height: float = 4e-3, start: str = "equilibrium") -> System:
    """A horizontal cantilever of eight elements."""
    system = System(start=start)
    body = system.add(
        AncfCable("strip", length=LENGTH, elements=8, youngs_modulus=young, density=density, height=height, width=0.02)
    )
    system.add(FixedJoint("clamp", system.ground, body.start))
    return system


def loaded_bar(stiffness: float = 40.0, mass: float = 1.5, force: float = 2.0) -> System:
    """A bar on a torsion spring that carries a force until 0.3 s."""
    system = System(start="equilibrium")
    bar = system.add(RigidBar("bar", length=0.8, mass=mass))
    system.add(RevoluteJoint("pin", system.ground, bar.start))
    system.add(TorsionSpring("spring", system.ground, bar.start, stiffness=stiffness))
    system.add(Force("push", bar.end, y=Step(-force, -1.0, 0.3)))
    return system


def test_a_strip_that_starts_at_its_equilibrium_stays_there() -> None:
    start = equilibrium(strip(start="placed")).channels(["strip.end.y"])[0]
    rests = simulate(strip(), 0.5, GeneralizedAlpha(step=1e-3)).channels(["strip.end.y"])
    assert np.max(np.abs(rests - start)) < 1e-9
    falls = simulate(strip(start="placed"), 1.5, GeneralizedAlpha(step=1e-3)).channels(["strip.end.y"])
    assert falls.min() / start == pytest.approx(2.0, rel=0.1)


@pytest.mark.parametrize("solver", [GeneralizedAlpha(step=2e-3), RadauIIA(tolerance=1e-8)])
def test_derivatives_are_those_of_the_motion_from_the_equilibrium(solver: object) -> None:
    """By central differences of the whole response, the equilibrium included."""
    box = {"stiffness": (20.0, 80.0), "mass": (0.5, 3.0), "force": (0.0, 5.0)}
    model = TimeResponse(loaded_bar, box, ["bar.end.y", "bar.end.angle"], np.linspace(0.0, 1.0, 21), solver)
    vector = np.array([40.0, 1.5, 2.0])
    jacobian = model.jacobian(vector)
    assert np.all(np.abs(jacobian[0]).max(axis=0) > 1e-4)  # the equilibrium itself depends on all three
    for column, step in enumerate(1e-5 * vector):
        ahead, behind = (model.evaluate(vector + sign * step * np.eye(3)[column]).values[0] for sign in (1, -1))
        difference = (ahead - behind) / (2 * step)
        assert np.max(np.abs(jacobian[..., column] - difference)) < 1e-6 * np.abs(difference).max()


def test_derivatives_of_a_sagging_strip() -> None:
    """At time 0 by differences; the sag of a slender beam is that of the linear theory, w = q L^4 / (8 E I)."""
    box = {"young": (1e9, 1e12), "density": (100.0, 1e4)}
    model = TimeResponse(strip, box, ["strip.end.y"], np.array([0.0, 1e-3]))
    vector = np.array([70e9, DENSITY])
    response, jacobian = model.linearise(vector)
    inertia = 0.02 * 4e-3**3 / 12
    sag = -DENSITY * 0.02 * 4e-3 * GRAVITY * LENGTH**4 / (8 * 70e9 * inertia)
    assert response[0, 0] == pytest.approx(sag, rel=5e-3)
    assert jacobian[0, 0] * vector == pytest.approx([-sag, sag], rel=2e-2)
    step = 1e-5 * vector
    for column in range(2):
        ahead, behind = (
            model.evaluate(vector + sign * step[column] * np.eye(2)[column]).values[0, 0, 0] for sign in (1, -1)
        )
        assert jacobian[0, 0, column] == pytest.approx((ahead - behind) / (2 * step[column]), rel=1e-6)


def test_a_system_without_joints() -> None:
    system = System(start="equilibrium")
    bob = system.add(PointMass("bob", mass=2.0, position=(0.0, -1.0)))
    system.add(Spring("spring", system.ground.point(0.0, 0.0), bob.centre, stiffness=500.0, free_length=1.0))
    motion = simulate(system, 0.2).channels(["bob.centre.y"])
    assert np.max(np.abs(motion + 1.0 + 2.0 * 9.81 / 500.0)) < 1e-12


def test_bodies_begin_with_the_motion_that_is_prescribed() -> None:
    """A hanging bar on a pin that moves from the start: the pin has its rate, and the bar is where it would rest."""
    system = System(start="equilibrium")
    bar = system.add(RigidBar("bar", length=0.8, mass=1.0, angle=-1.4))
    system.add(PrescribedMotion("along", system.ground, bar.start, coordinate="x", motion=Polynomial([0.0, 0.5])))
    system.add(PrescribedMotion("across", system.ground, bar.start, coordinate="y"))
    place, rate = simulate(system, 0.1).channels(["bar.end.angle", "bar.start.vx"])[0]
    assert place == pytest.approx(-np.pi / 2, abs=1e-12)
    assert rate == pytest.approx(0.5, abs=1e-12)


def inverted(start: str = "equilibrium", **motion: float) -> System:
    system = System(start=start)
    bar = system.add(RigidBar("bar", length=1.0, mass=1.0, angle=np.pi / 2, **motion))
    system.add(RevoluteJoint("pin", system.ground, bar.start))
    return system


def test_an_inverted_pendulum_has_no_rest() -> None:
    with pytest.raises(ModelError, match="the equilibrium at the start is unstable: 'bar' falls away from it"):
        simulate(inverted(), 1.0)
    model = TimeResponse(lambda m: inverted(), {"m": (0.0, 1.0)}, ["bar.end.angle"], np.array([0.0, 0.1]))
    with pytest.raises(ModelError, match="nearer to the equilibrium that is meant"):
        model.evaluate(np.array([[0.5]]))


@pytest.mark.parametrize("bars", [1, 2, 8])
@pytest.mark.parametrize("angle", [-1.5, 0.0, 1.4])
def test_chains_without_stiffness_hang_down(bars: int, angle: float) -> None:
    """From almost upright, too: the way to the equilibrium goes downhill."""
    system = System(start="equilibrium")
    above = system.ground.point(0.0, 0.0)
    for number in range(bars):
        bar = system.add(RigidBar(f"bar{number}", length=0.5, mass=1.0, angle=angle, start=above))
        system.add(RevoluteJoint(f"pin{number}", system.ground if number == 0 else above, bar.start))
        above = bar.end
    angles = simulate(system, 0.01).channels([f"bar{number}.end.angle" for number in range(bars)])
    assert np.max(np.abs(angles + np.pi / 2)) < 1e-9


def test_a_stated_velocity_contradicts_rest() -> None:
    with pytest.raises(ModelError, match="'bar' has a velocity at the start"):
        simulate(inverted(angular_velocity=1.0), 1.0)


def test_a_body_without_support_has_no_rest() -> None:
    system = System(start="equilibrium")
    system.add(PointMass("bob", mass=1.0, position=(0.0, 0.0)))
    with pytest.raises(SolveError, match=r"no equilibrium was found.*largest of which acts on 'bob'"):
        simulate(system, 1.0)


def test_the_word_is_checked() -> None:
    with pytest.raises(InputError, match="start"):
        System(start="rest")


STUDY = """
[parameters]
mass = { lower = 0.5, upper = 3.0 }
[model]
start = "equilibrium"
[[model.body]]
kind = "PointMass"
name = "bob"
mass = "mass"
position = [0.0, -1.0]
[[model.load]]
kind = "Spring"
name = "spring"
a = [0.0, 0.0]
b = "bob.centre"
stiffness = 500.0
free_length = 1.0
[solver]
step = "1 ms"
[simulate]
end = "1 s"
"""


def test_a_study_file_starts_at_rest(tmp_path) -> None:
    (tmp_path / "study.toml").write_text(STUDY)
    system = study.load(tmp_path / "study.toml").builder(mass=2.0)
    assert system.start == "equilibrium"
    assert equilibrium(system).channels(["bob.centre.y"])[0] == pytest.approx(-1.0 - 2.0 * 9.81 / 500.0)
