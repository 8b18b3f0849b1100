"""Arguments of components are checked by their annotations, whichever component and whichever argument."""

from collections.abc import Callable
from cProfile import Profile
from dataclasses import InitVar, dataclass

import numpy as np
import pytest

import dalembert.multibody as mb
from dalembert.arguments import Checked, kinds_of
from dalembert.errors import InputError

BAR = mb.RigidBar("bar", length=1.0, mass=1.0)
SIDES = {"a": mb.Ground(), "b": BAR.end}
SECTION = {"length": 1.0, "elements": 1, "youngs_modulus": 1e6, "density": 1.0, "height": 0.1, "width": 0.1}
STIFFNESSES = {f"stiffness_{name}": 1.0 for name in ("x", "y", "angle")}
MOTOR = {"torque_constant": 1.0, "resistance": 1.0}
COMPONENTS = {
    mb.PointMass: {"mass": 1.0},
    mb.RigidBar: {"length": 1.0, "mass": 1.0},
    mb.RigidBarBetween: {"start": (0.0, 0.0), "end": (1.0, 0.0), "mass": 1.0},
    mb.RigidBody: {"mass": 1.0, "inertia": 1.0},
    mb.AncfCable: SECTION,
    mb.AncfBeam: {**SECTION, "poisson_ratio": 0.3},
    mb.RevoluteJoint: {**SIDES, "pin_radius": 0.1, "stribeck_rate": 0.1},
    mb.PrismaticJoint: {**SIDES, "stribeck_velocity": 0.1},
    mb.DistanceJoint: SIDES,
    mb.FixedJoint: SIDES,
    mb.GearJoint: {**SIDES, "ratio": 2.0},
    mb.PrescribedMotion: {**SIDES, "motion": 1.0},
    mb.Spring: {**SIDES, "stiffness": 1.0},
    mb.TorsionSpring: {**SIDES, "stiffness": 1.0},
    mb.Bushing: {**SIDES, **STIFFNESSES},
    mb.Motor: {**SIDES, **MOTOR, "voltage": 1.0},
    mb.Servo: {**SIDES, **MOTOR, "goal": 1.0, "kp": 1.0},
    mb.Force: {"at": BAR.end},
    mb.Torque: {"at": BAR.end, "torque": 1.0},
}
LIFTED = 0.25 + 1e-30j
WRONG = ["1", (), [1.0], np.ones(2), {}, True, np.nan, -np.inf, 1e200, object(), np.array("1"), b"1", BAR]


def numeric() -> list[tuple[type, str]]:
    """Every argument that may be a number, of every component."""
    found = []
    for component in COMPONENTS:
        for entry in component.__dataclass_fields__.values():
            kinds = kinds_of(entry.type.type if isinstance(entry.type, InitVar) else entry.type)
            if entry.init and complex in kinds:
                found.append((component, entry.name))
    return found


def test_every_component_is_here() -> None:
    kinds = (mb.Body, mb.Joint, mb.Load)
    known = {entry for entry in vars(mb).values() if isinstance(entry, type) and issubclass(entry, kinds)}
    assert known - {*kinds, mb.UserForce} <= set(COMPONENTS)


@pytest.mark.parametrize(("component", "name"), numeric(), ids=lambda one: getattr(one, "__name__", one))
def test_what_is_no_number_is_refused(component: type, name: str) -> None:
    for wrong in [*WRONG, *([None] if component.__dataclass_fields__[name].default is not None else [])]:
        with pytest.raises(InputError, match=f"^{component.__name__} 'part': {name} is .*; expected a "):
            component("part", **{**COMPONENTS[component], name: wrong})


@pytest.mark.parametrize(("component", "name"), numeric(), ids=lambda one: getattr(one, "__name__", one))
def test_numbers_of_all_sorts_pass(component: type, name: str) -> None:
    """Complex ones too, which carry derivatives."""
    excluded = {"voltage": None} if name == "current" else {}
    for right in (0.25, np.float32(0.25), np.array(0.25), LIFTED, np.complex128(LIFTED)):
        component("part", **{**COMPONENTS[component], **excluded, name: right})


@pytest.mark.parametrize(
    ("make", "sentence"),
    [
        (
            lambda: mb.PointMass("bob", 1.0, 2.0),
            "PointMass 'bob': position is 2.0; expected two finite numbers in m, such as (0.0, 0.0) or a point of a "
            "body such as rod.end or a point of the ground such as system.ground.point(0.0, 0.0)",
        ),
        (
            lambda: mb.RevoluteJoint("pin", mb.Ground(), BAR),
            "RevoluteJoint 'pin': b is a RigidBar; expected a point of a body such as rod.end or a point of the ground "
            "such as system.ground.point(0.0, 0.0) or the ground",
        ),
        (lambda: mb.RigidBar(1.0, 2.0, 3.0), "RigidBar: name is 1.0; expected a text"),
        (
            lambda: mb.Force("push", BAR.end, follower="no"),
            "Force 'push': follower is 'no'; expected True or False",
        ),
        (
            lambda: mb.RigidBody("plate", 1.0, 1.0, points={"edge": 1.0}),
            "RigidBody 'plate': points is {'edge': 1.0}; expected a mapping from names to two finite numbers in m, "
            "such as (0.0, 0.0)",
        ),
        (
            lambda: mb.Polynomial([0.0, "1"]),
            "Polynomial: coefficients is [0.0, '1']; expected a list of finite numbers",
        ),
        (
            lambda: mb.Torque("motor", BAR.end, lambda t: t),
            "Torque 'motor': torque is a function; expected a number in N*m or a function of time such as "
            "Harmonic(amplitude, angular_frequency)",
        ),
        (
            lambda: mb.System(gravity=-9.81),
            "System: gravity is -9.81; expected two finite numbers in m/s^2, along x and y, such as (0.0, -9.81)",
        ),
        (
            lambda: mb.System(gravity=(0.0, 0.0, -9.81)),
            "System: gravity is (0.0, 0.0, -9.81); expected two finite numbers in m/s^2, along x and y, such as "
            "(0.0, -9.81)",
        ),
        (
            lambda: mb.System(driving=3),
            "System: driving is 3; expected names, such as ['AB.end.x', 'AB.end.y']",
        ),
    ],
)
def test_the_message_says_what_is_expected(make, sentence: str) -> None:
    with pytest.raises(InputError) as error:
        make()
    assert str(error.value) == sentence


def test_one_name_may_stand_for_a_list_of_them() -> None:
    assert mb.System(driving="bar.angle").driving == ("bar.angle",)


def test_arguments_that_are_not_kept_are_checked_too() -> None:
    with pytest.raises(InputError, match=r"^RigidBar 'bar': start is 'left'; expected two finite numbers in m, "):
        mb.RigidBar("bar", 1.0, 1.0, start="left")


def test_annotations_of_other_sorts_accept_everything() -> None:
    @dataclass(frozen=True)
    class Own(Checked):
        anything: "Unknown"  # type: ignore[name-defined]  # noqa: F821
        number: float | complex = 1.0

    assert Own({}).anything == {}


def calls(run: Callable[[], object]) -> int:
    """Calls of functions in run: its cost, the same on every machine."""
    profile = Profile()
    profile.runcall(run)
    return sum(entry.callcount for entry in profile.getstats())


def test_checks_need_less_than_a_fifth_of_the_calls_of_a_preparation() -> None:
    from dalembert.multibody.start.assemble import assembled

    def chain() -> mb.System:
        system = mb.System()
        side: object = system.ground
        for number in range(10):
            bar = system.add(mb.RigidBar(f"bar {number}", 1.0, 1.0, start=(float(number), 0.0)))
            system.add(mb.RevoluteJoint(f"pin {number}", side, bar.start))  # type: ignore[arg-type]
            side = bar.end
        return system

    def checked_again() -> None:
        for component in (*system.bodies, *system.joints):
            Checked.__post_init__(component, 0.5, (0.0, 0.0))

    system = chain()
    assert calls(checked_again) < 0.2 * calls(lambda: assembled(chain()))
