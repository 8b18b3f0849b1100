"""Arguments of components in space are checked, whichever component and whichever argument."""

from dataclasses import fields

import numpy as np
import pytest

import dalembert.multibody.spatial as sp
from dalembert.errors import InputError
from dalembert.multibody.components.fields import arguments
from dalembert.structure import Material, box, free_body_modes, solid

BOX = sp.Inertia.box(1.0, (0.1, 0.2, 0.3))
SECTION = sp.Section((1.0,) * 6, 1.0, (1.0, 1.0))
BODY, SECOND = sp.RigidBody("body", BOX), sp.RigidBody("second", BOX)
SIDES = {"a": sp.Ground(), "b": BODY.point("origin")}
PIN, SLIDE = sp.RevoluteJoint("pin", **SIDES), sp.PrismaticJoint("slide", **SIDES)
OTHER = sp.RevoluteJoint("other", sp.Ground(), SECOND.point("origin"))
MODES = free_body_modes(
    solid(box((0.1, 0.1, 0.1), (1, 1, 1)), Material(1e9, 0.3, 1e3), "brick 27"),
    {"left": "left"},
    modes=2,
    recovery={"gauge": {"0.x": 1.0}},
)
COMPONENTS = {
    sp.RigidBody: {"inertia": BOX},
    sp.PointMass: {"mass": 1.0},
    sp.Beam: {"section": SECTION, "length": 1.0},
    sp.Cable: {"length": 1.0, "elements": 2, "axial_stiffness": 1.0, "mass_per_length": 1.0},
    sp.Section: {"stiffness": (1.0,) * 6, "mass": 1.0, "moments": (1.0, 1.0)},
    sp.NodePoint: {},
    sp.RevoluteJoint: SIDES,
    sp.PrismaticJoint: SIDES,
    sp.CylindricalJoint: SIDES,
    sp.SphericalJoint: SIDES,
    sp.UniversalJoint: SIDES,
    sp.ConstantVelocityJoint: SIDES,
    sp.FixedJoint: SIDES,
    sp.DistanceJoint: {**SIDES, "length": 1.0},
    sp.PlanarJoint: SIDES,
    sp.PointOnLineJoint: SIDES,
    sp.ScrewJoint: {**SIDES, "lead": 0.1},
    sp.PrescribedMotion: {**SIDES, "motion": 1.0},
    sp.GearJoint: {"a": PIN, "b": OTHER, "ratio": 2.0},
    sp.CouplingJoint: {"a": PIN, "b": OTHER, "ratio": 2.0},
    sp.RackJoint: {"a": PIN, "b": SLIDE, "radius": 2.0},
    sp.Spring: {**SIDES, "stiffness": 1.0},
    sp.TorsionSpring: {**SIDES, "stiffness": 1.0},
    sp.Bushing: SIDES,
    sp.Motor: {**SIDES, "torque_constant": 1.0, "resistance": 1.0, "voltage": 1.0},
    sp.Armature: {**SIDES, "inertia": 1.0},
    sp.Force: {"at": BODY.point("origin")},
    sp.Torque: {"at": BODY.point("origin")},
    sp.UserForce: {"at": BODY.point("origin"), "function": lambda t, at, against: (0.0,) * 6},
    sp.AngleLimit: {"joint": PIN, "stiffness": 1.0, "upper_limit": 1.0},
    sp.DisplacementLimit: {"joint": SLIDE, "stiffness": 1.0, "upper_limit": 1.0},
    sp.InertialSensor: {"at": BODY.point("origin")},
    sp.RelativeSensor: SIDES,
    sp.ReducedBody: {"modes": MODES},
    sp.RecoverySensor: {"at": sp.ReducedBody("body", MODES).point("left"), "quantity": "gauge"},
    sp.CableSensor: {"at": sp.Cable("rope", 1.0, 1, 1.0, 1.0).end},
    sp.BeamSensor: {"at": sp.Beam("beam", SECTION, 1.0).end},
    sp.LineForce: {"on": sp.Beam("beam", SECTION, 1.0).end},
    sp.Inertia: {"mass": 1.0, "moments": (1.0, 1.0, 1.0)},
    sp.Pose: {},
    sp.Friction: {"coulomb": 1.0},
    sp.Shape: {"kind": "box", "sizes": (1.0, 1.0, 1.0)},
}
WRONG = [
    "wrong", b"1", [1.0], np.ones(2), np.array("1"), np.nan, -np.inf, 1e200, object(), (1.0, 2.0), (1.0, 2.0, "a"),
    (np.nan, 0.0, 0.0), [[1.0], [2.0, 3.0]], {"a": object()}, BODY,
]  # fmt: skip
TEXTS = {"file", "found"}  # any text is right
PAIRS = {(sp.Section, name) for name in ("moments", "centre", "shear_centre", "centroid")} | {(sp.BeamSensor, "gauge")}
"""Arguments of two numbers, which two numbers are right for."""


def all_arguments() -> list[tuple[type, str]]:
    return [(component, entry.name) for component in COMPONENTS for entry in arguments(component)]


def test_every_component_is_here() -> None:
    known = {entry for name in sp.__all__ if isinstance(entry := getattr(sp, name), type)}
    bases = {sp.Body, sp.Joint, sp.Load, sp.Ground, sp.GroundPoint, sp.Point, sp.SpatialSystem, sp.Surface}
    assert known - bases - {sp.Orientation} == set(COMPONENTS)  # orientations have their tests in test_wrong_inputs


@pytest.mark.parametrize(("component", "argument"), all_arguments(), ids=lambda one: getattr(one, "__name__", one))
def test_a_wrong_kind_of_argument_is_refused_by_its_name(component: type, argument: str) -> None:
    given = {"name": "part"} if any(entry.name == "name" for entry in fields(component)) else {}
    for wrong in WRONG:
        if isinstance(wrong, str) and (argument in (*TEXTS, "name") or (component, argument) == (sp.NodePoint, "at")):
            continue
        if (component, argument) in PAIRS and isinstance(wrong, tuple | np.ndarray) and np.shape(wrong) == (2,):
            continue
        with pytest.raises(InputError) as refused:
            component(**{**given, **COMPONENTS[component], argument: wrong})
        about = (argument, "coordinate" if argument.startswith("of_") else argument)
        assert any(word in str(refused.value) for word in about)


@pytest.mark.parametrize("wrong", ["0.1", None, np.nan, 0.0, -1.0, [1.0], 1e200])
@pytest.mark.parametrize(
    "make",
    [
        lambda wrong: sp.Inertia.box(wrong, (1.0, 1.0, 1.0)),
        lambda wrong: sp.Inertia.box(1.0, (1.0, wrong, 1.0)),
        lambda wrong: sp.Inertia.sphere(wrong, 1.0),
        lambda wrong: sp.Inertia.sphere(1.0, wrong),
        lambda wrong: sp.Inertia.cylinder(wrong, 1.0, 1.0),
        lambda wrong: sp.Inertia.cylinder(1.0, wrong, 1.0),
        lambda wrong: sp.Inertia.cylinder(1.0, 1.0, wrong),
    ],
    ids=["box mass", "box side", "sphere mass", "radius", "cylinder mass", "cylinder radius", "length"],
)
def test_inertias_of_shapes_need_positive_numbers(make, wrong) -> None:
    with pytest.raises(
        InputError, match=r"^Inertia\.(box|sphere|cylinder): \w+ is .*; expected (a|three) positive num"
    ):
        make(wrong)


@pytest.mark.parametrize("inner", [0.1, 0.2, -0.01, "0.05", np.nan, None])
def test_the_inner_radius_of_a_tube_is_smaller_than_the_outer_one(inner) -> None:
    with pytest.raises(InputError, match=r"^Inertia\.cylinder: inner is .*; expected a radius from 0 to less than"):
        sp.Inertia.cylinder(1.0, 0.1, 1.0, inner)
    thin = sp.Inertia.cylinder(1.0, 0.1, 1.0, 0.1 - 1e-9)
    assert thin.moments[2] == pytest.approx(0.01, rel=1e-7)  # m r^2 of a ring


@pytest.mark.parametrize(
    "tensor", ["a", np.eye(2), [[1.0], [2.0, 3.0]], np.triu(np.ones((3, 3))), np.full((3, 3), np.nan)]
)
def test_a_tensor_is_symmetric(tensor) -> None:
    with pytest.raises(InputError, match=r"^Inertia: the tensor is "):
        sp.Inertia.of(1.0, tensor)


def coupled(stiffness: float) -> np.ndarray:
    """Stiffnesses of 1 N/m along x and 1e-3 N m/rad about y, coupled."""
    matrix = np.zeros((6, 6))
    matrix[0, 0], matrix[4, 4] = 1.0, 1e-3
    matrix[0, 4] = matrix[4, 0] = stiffness
    return matrix


@pytest.mark.parametrize("what", ["stiffness", "damping"])
@pytest.mark.parametrize(
    "wrong",
    [(1.0, -1e-3, 1.0, 1.0, 1.0, 1.0), coupled(0.032), coupled(-0.032), np.diag([1.0, 1.0, 1.0, 0.0, 0.0, -1e-6])],
)
def test_bushings_store_and_lose_energy(what: str, wrong) -> None:
    """The determinant of the coupled pair is 1e-3 - 0.032^2 < 0."""
    with pytest.raises(InputError, match=f"^Bushing 'bush': {what} is .*; expected .* negative|semidefinite"):
        sp.Bushing("bush", **SIDES, **{what: wrong})


@pytest.mark.parametrize("right", [(0.0,) * 6, (1e6, 1.0, 0.0, 0.0, 0.0, 1e-6), coupled(0.0316), np.ones((6, 6))])
def test_singular_bushings_are_accepted(right) -> None:
    sp.Bushing("bush", **SIDES, stiffness=right, damping=right)


@pytest.mark.parametrize("gain", [(0.0, 1.0, 1.0), np.diag([1.0, 0.0, 1.0])])
@pytest.mark.parametrize("what", ["acceleration_gain", "rate_gain"])
def test_a_gain_of_zero_is_a_finding(what: str, gain) -> None:
    (found,) = sp.InertialSensor("imu", BODY.point("origin"), **{what: gain}).findings
    assert (found.code, found.severity, found.values) == ("zero-gain", "warning", {"sensor": "imu", "gain": what})


def test_other_gains_are_no_finding() -> None:
    across = np.array([[0.0, 1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.1, 1.0]])
    assert sp.InertialSensor("imu", BODY.point("origin"), acceleration_gain=across).findings == ()


@pytest.mark.parametrize(("kind", "numbers"), [(sp.GearJoint, {"ratio": 2.0}), (sp.CouplingJoint, {"ratio": -1.0})])
def test_a_joint_is_not_coupled_with_itself(kind: type, numbers: dict) -> None:
    with pytest.raises(InputError, match=f"^{kind.__name__} 'teeth': a and b are the angle of the same joint 'pin'"):
        kind("teeth", PIN, PIN, **numbers)
    both = sp.CylindricalJoint("both", **SIDES)
    sp.CouplingJoint("thread", both, both, ratio=0.1, of_a="angle", of_b="displacement")  # as a screw


@pytest.mark.parametrize("kind", [sp.GearJoint, sp.CouplingJoint])
def test_a_ratio_of_zero_is_refused(kind: type) -> None:
    with pytest.raises(InputError, match=r"ratio is 0\.0; expected a number other than zero"):
        kind("teeth", PIN, OTHER, ratio=0.0)
