"""Mechanisms of trees: poses and rates of bodies, merged links, friction, armature inertias, parameters."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.linalg import expm

from dalembert.errors import InputError, ModelError
from dalembert.multibody import (
    EnergyMomentum,
    GeneralizedAlpha,
    OdeSolver,
    RadauIIA,
    TimeResponse,
    Variational,
    simulate,
)
from dalembert.multibody.components.spatial.inertia import Inertia
from dalembert.multibody.components.spatial.joint_limit import AngleLimit
from dalembert.multibody.components.spatial.orientation import Orientation, Pose
from dalembert.multibody.trees import Link, Tree, TreeJoint, read_urdf
from robot_files import ARM, POSITIONS, RATES
from support import says

LINKS = ["column", "slider", "wrist", "tool", "tip"]


@pytest.fixture(scope="module")
def arm(tmp_path_factory) -> Tree:
    path = tmp_path_factory.mktemp("arm") / "arm.urdf"
    path.write_text(ARM)
    return read_urdf(path)


def transform(joint, position):
    """Pose behind a joint, as the exponential of a twist (4, 4)."""
    placed, twist = np.eye(4, dtype=complex), np.zeros((4, 4), complex)
    placed[:3, :3], placed[:3, 3] = joint.pose.orientation.matrix, joint.pose.position
    x, y, z = np.array(joint.axis) / np.linalg.norm(joint.axis)
    if joint.kind == "revolute":
        twist[:3, :3] = position * np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    elif joint.kind == "prismatic":
        twist[:3, 3] = position * np.array([x, y, z])
    return placed @ expm(twist)


def poses(tree, positions):
    """Poses of all links by products of exponentials, {name: (4, 4)}."""
    found = {tree.root: np.eye(4, dtype=complex)}
    for link in tree.links:
        found[link.name] = found[link.parent] @ transform(link.joint, positions.get(link.joint.name, 0.0))
    return found


def rates_of(tree, positions, rates):
    """Poses, and their rates by a complex step along the rates of the joints."""
    step = 1e-30
    moved = poses(tree, {name: positions[name] + 1j * step * rates[name] for name in positions})
    return {name: (np.real(pose), np.imag(pose) / step) for name, pose in moved.items()}


def test_frames_of_all_links_at_the_start(arm):
    """Positions, axes, velocities and angular velocities against products of exponentials."""
    motion = simulate(arm.system(POSITIONS, RATES), 1e-3)
    for name, (pose, rate) in rates_of(arm, POSITIONS, RATES).items():
        if name == "base":
            continue
        mark = arm.marker(name)
        read = lambda *outputs, mark=mark: motion.channels([f"{mark}.{own}" for own in outputs])[0]  # noqa: E731
        assert np.abs(read("x", "y", "z") - pose[:3, 3]).max() < 1e-14
        assert np.abs(read("vx", "vy", "vz") - rate[:3, 3]).max() < 1e-12
        spin = rate[:3, :3] @ pose[:3, :3].T
        assert np.abs(read("wx", "wy", "wz") - [spin[2, 1], spin[0, 2], spin[1, 0]]).max() < 1e-12
        turned = Orientation.by_rotation_vector(read("rotation_x", "rotation_y", "rotation_z")).matrix
        assert np.abs(turned - pose[:3, :3]).max() < 1e-12
    start = motion.channels(
        ["turn.angle", "turn.rate", "slide.displacement", "slide.speed", "bend.angle", "bend.rate"]
    )[0]
    assert np.abs(start - [0.4, 1.1, 0.15, -0.3, -0.8, 2.0]).max() < 1e-12


def test_links_that_are_fixed_to_each_other_are_one_body(arm):
    system = arm.system(POSITIONS)
    assert [body.name for body in system.bodies] == ["column", "slider", "wrist"]
    assert [arm.marker(name) for name in LINKS] == [
        "column.origin", "slider.origin", "wrist.origin", "wrist.tool", "wrist.tip",
    ]  # fmt: skip
    own = poses(arm, {})
    behind = np.real(np.linalg.inv(own["wrist"]) @ own["tool"])
    wrist, tool = arm.link("wrist").inertia, arm.link("tool").inertia
    total = behind[[3, 0, 1, 2]][:, [3, 0, 1, 2]]  # of [1; s]
    expected = wrist.pseudo + total @ tool.pseudo @ total.T
    assert np.abs(system.body("wrist").inertia.pseudo - expected).max() < 1e-16
    assert system.body("slider").inertia == arm.link("slider").inertia  # to the last bit


def test_a_tilted_base_and_a_tilted_gravity_are_the_same(arm):
    tilt = Orientation.by_angles("XYZ", [0.5, -0.3, 0.2])
    names = ["turn.angle", "slide.displacement", "bend.angle"]
    gravity = tuple((tilt.matrix.T @ [0.0, 0.0, -9.81]).tolist())
    tilted = simulate(arm.system(POSITIONS, RATES, base=Pose((1.0, 2.0, 3.0), tilt)), 0.1).channels(names)
    assert np.abs(tilted - simulate(arm.system(POSITIONS, RATES, gravity), 0.1).channels(names)).max() < 1e-10


def test_positions_may_be_a_list(arm):
    one, other = arm.system(POSITIONS, RATES), arm.system([0.4, 0.15, -0.8], np.array([1.1, -0.3, 2.0]))
    for mine, theirs in zip(one.bodies, other.bodies, strict=True):
        assert (mine.position, mine.velocity, mine.orientation) == (
            theirs.position,
            theirs.velocity,
            theirs.orientation,
        )


PARAMETERS = {
    "tool.mass": (0.2, 0.6),
    "tool.centre_x": (-0.1, 0.1),
    "slider.inertia_xy": (-0.002, 0.002),
    "turn.damping": (0.0, 1.0),
    "turn.friction": (0.0, 1.0),
    "slide.armature": (0.0, 4.0),
    "bend.armature": (0.0, 0.1),
}


def test_numbers_of_a_tree_are_parameters(arm):
    """Sensitivities by complex steps against central differences."""

    def build(**values):
        position = values.pop("bend")
        return arm.with_numbers(values).system(POSITIONS | {"bend": position}, RATES, slip=0.1)

    channels = ["turn.angle", "slide.displacement", "bend.rate", "wrist.tip.x"]
    bounds = PARAMETERS | {"bend": (-2.0, 2.0)}
    model = TimeResponse(build, bounds, channels, np.linspace(0.0, 0.2, 5), solver=GeneralizedAlpha(step=2e-3))
    point = np.array([*(arm.numbers[name] for name in PARAMETERS), -0.8])
    exact = model.jacobian(point)
    for k in range(len(point)):
        step = 1e-3 * max(abs(point[k]), 0.02)
        ends = model.evaluate(np.array([point + step * np.eye(len(point))[k], point - step * np.eye(len(point))[k]]))
        differences = (ends.values[0] - ends.values[1]) / (2 * step)
        size = np.abs(differences).max()
        assert size > 1e-6
        assert np.abs(exact[..., k] - differences).max() < 2e-6 * size


def test_a_number_that_is_zero_may_be_a_parameter(arm):
    """Damping, friction and armature at their lower bound have derivatives; a tree without them has no friction."""
    none = {f"{joint.name}.{what}": 0.0 for joint in arm.moving for what in ("damping", "friction", "armature")}
    bare = replace(arm.with_numbers(none), changed=frozenset())
    assert not bare.system().loads
    assert [joint.friction for joint in bare.system().joints] == [None] * 3

    def build(**values):
        return bare.with_numbers(values).system(POSITIONS, RATES, slip=0.1)

    names = ["turn.damping", "bend.friction", "slide.armature"]
    model = TimeResponse(
        build, dict.fromkeys(names, (0.0, 1.0)), ["turn.angle", "slide.displacement", "bend.angle"],
        np.array([0.0, 0.1]), solver=GeneralizedAlpha(step=2e-3),
    )  # fmt: skip
    exact = model.jacobian(np.zeros(3))[-1]
    for k in range(3):
        step = 1e-4 * np.eye(3)[k]
        values = model.evaluate(np.array([0 * step, step, 2 * step])).values[:, -1]
        differences = (-1.5 * values[0] + 2 * values[1] - 0.5 * values[2]) / 1e-4  # one-sided, of second order
        assert np.abs(exact[:, k] - differences).max() < 1e-5 * np.abs(differences).max()


@pytest.mark.parametrize("solver", [RadauIIA(), Variational(step=1e-3), EnergyMomentum(step=1e-3)], ids=str)
def test_armatures_move_with_all_methods(arm, solver):
    channels = ["turn.angle", "bend.angle", "slide.displacement"]
    exact = simulate(arm.system(POSITIONS, RATES), 0.1, GeneralizedAlpha(step=1e-4)).channels(channels)[-1]
    own = simulate(arm.system(POSITIONS, RATES), 0.1, solver).channels(channels)[-1]
    np.testing.assert_allclose(own, exact, atol=1e-5)


def following(arm: Tree, **joints: tuple[str, float, float]) -> Tree:
    """The arm with joints that follow others."""
    return replace(
        arm,
        links=tuple(
            replace(link, joint=replace(link.joint, mimic=joints[link.joint.name]))
            if link.joint.name in joints
            else link
            for link in arm.links
        ),
    )


def test_joints_follow_others(arm):
    """A chain: the wrist follows the slide, which follows the column; more than half a turn from zero."""
    follows = following(arm, slide=("turn", 0.1, -0.2), bend=("slide", 30.0, 0.5))
    system = follows.system({"turn": 4.0}, {"turn": 0.7})
    motion = simulate(system, 0.3, OdeSolver("DOP853", 1e-10, 1e-10))
    names = ["slide mimic.angle_a", "slide mimic.displacement_b", "bend mimic.displacement_a", "bend mimic.angle_b"]
    turn, slide, same, bend = motion.channels(names).T
    np.testing.assert_allclose([turn[0], slide[0], bend[0]], [4.0, 0.2, 6.5], atol=1e-12)
    assert np.ptp(turn) > 0.1
    np.testing.assert_allclose(slide, 0.1 * turn - 0.2, atol=1e-9)
    np.testing.assert_allclose(same, slide, atol=1e-9)
    np.testing.assert_allclose(bend, 30.0 * slide + 0.5, atol=1e-8)
    np.testing.assert_allclose(motion.channels(["slide.displacement"])[:, 0], slide, atol=1e-9)


def test_joints_that_follow_each_other_are_refused(arm):
    sentence = "joints follow each other in a circle (mimic): 'turn' -> 'bend' -> 'turn'. Let one of them move freely"
    with pytest.raises(ModelError, match=says(sentence)):
        following(arm, turn=("bend", 1.0, 0.0), bend=("turn", 1.0, 0.0))


def test_stops_at_the_limits_of_joints(arm):
    positions = {"turn": 0.2, "slide": 0.35, "bend": 7.0}
    system = arm.system(positions, limits=(1e4, 0.2))
    assert [
        (load.name, load.lower_limit, load.upper_limit) for load in system.loads if load.name.endswith("limits")
    ] == [
        ("slide limits", -0.2, 0.4),
        ("bend limits", -2.0, 2.5),
    ]
    start = simulate(system, 1e-3, GeneralizedAlpha(step=1e-3)).channels(["bend limits.angle", "bend limits.torque"])[0]
    np.testing.assert_allclose(start, [7.0, -1e4 * 4.5**1.5], rtol=1e-9)
    system = arm.system({"slide": 0.3}, {"slide": 2.0}, limits={"slide": (1e6, 0.2)})
    motion = simulate(system, 0.2, GeneralizedAlpha(step=2e-4))
    displacement, speed = motion.channels(["slide.displacement", "slide.speed"]).T
    assert 0.4 < displacement.max() < 0.42
    assert speed.min() < -0.5
    with pytest.raises(
        InputError, match=says("Tree.system: limits: unknown joint with limits 'turn'; known: bend, slide")
    ):
        arm.system(limits={"turn": (1.0, 0.0)})
    with pytest.raises(
        InputError,
        match=says("Tree.system: limits of joint 'slide' is 3.0; expected two numbers, stiffness and damping"),
    ):
        arm.system(limits={"slide": 3.0})


def test_limits_without_effect_are_listed():
    """Those of positions unless the system has stops for them, and always those of rates and torques."""
    inertia = Inertia.sphere(1.0, 0.1)
    links = [
        Link(name, above, TreeJoint(joint, kind, lower=-0.1, **more), inertia)
        for name, above, joint, kind, more in (
            ("a", "base", "a", "revolute", {}),
            ("b", "a", "turn", "revolute", {"velocity": 2.0, "upper": 1.0}),
            ("c", "b", "slide", "prismatic", {"effort": 5.0}),
        )
    ]
    tree = Tree("robot", "base", (*links, Link("d", "c", TreeJoint("free"), inertia)))

    def listed(system):
        (finding,) = system.findings
        assert (finding.code, finding.severity) == ("not-imported", "note")
        assert finding.values == {"robot": "robot", "parts": finding.message.count("the limits of"), "moves": False}
        return [part.rstrip(".") for part in finding.message.partition("depends: ")[2].split("; ")]

    rates, torques = (
        "the limits of the rates of 'turn' have no effect",
        "the limits of the torques or forces of 'slide' have no effect",
    )
    positions = "the limits of the positions of {} have no effect"
    assert listed(tree.system()) == [positions.format("'a', 'turn' and 'slide'"), rates, torques]
    assert listed(tree.system(limits={"turn": (1.0, 0.0)})) == [positions.format("'a' and 'slide'"), rates, torques]
    assert listed(tree.system(limits=(1.0, 0.0))) == [rates, torques]
    system = tree.system()
    system.add(AngleLimit("stop", system.joints[0], 10.0, -0.1, None))
    assert listed(system) == [positions.format("'turn' and 'slide'"), rates, torques]
    many = Tree("r", "base", tuple(Link(f"l{k}", "base", TreeJoint(f"j{k}", upper=1.0), inertia) for k in range(9)))
    assert "of 'j0', 'j1', 'j2', 'j3', 'j4', 'j5' and 3 more joints have" in many.system().findings[0].message
    fixed = tree.with_fixed_joints({"a": 0.0, "turn": 0.0, "slide": 0.0})
    assert fixed.system().findings == ()


def test_joints_that_follow_fixed_ones(arm):
    follows = following(arm, bend=("turn", 2.0, 0.1))
    astray = following(arm, bend=("flange", 2.0, 0.1))
    sentence = (
        "joint 'bend' follows 'flange', which is fixed. Fix it too: tree.with_fixed_joints({'bend': 0.1}), or "
        'fixed = { "bend" = 0.1 } in [model.robot]'
    )
    with pytest.raises(ModelError, match=says(sentence)):
        astray.system()
    fixed = follows.with_fixed_joints({"bend": -0.8})
    assert [body.name for body in fixed.system().bodies] == ["column", "slider"]
    assert fixed.marker("tip") == "slider.tip"
    tip = poses(arm, POSITIONS)
    behind = np.real(np.linalg.inv(tip["slider"]) @ tip["tip"])[:3, 3]
    assert np.abs(np.array(fixed.system().body("slider").points["tip"].position) - behind).max() < 1e-15
    with pytest.raises(ModelError, match=says("joint 'bend' follows 'turn', which is to be fixed. Fix both")):
        follows.with_fixed_joints({"turn": 0.0})


def test_links_without_mass_that_move_are_refused():
    inertia = Inertia.sphere(1.0, 0.1)
    cross = Tree("cross", "base", (Link("fork", "base", TreeJoint("a")), Link("arm", "fork", TreeJoint("b"), inertia)))
    sentence = (
        "link 'fork' moves by joint 'a', but has no mass, and no link with mass is fixed to it. Give it an inertia, or "
        "fix the joint: tree.with_fixed_joints({'a': 0.0}), or fixed = { \"a\" = 0.0 } in [model.robot]"
    )
    with pytest.raises(ModelError, match=says(sentence)):
        cross.system()
    assert [body.name for body in cross.with_fixed_joints({"a": 0.3}).system().bodies] == ["arm"]


def test_links_and_joints_may_have_the_same_name():
    inertia = Inertia.sphere(1.0, 0.1)
    links = (
        Link("one", "base", TreeJoint("one", armature=0.1), inertia),
        Link("two", "one", TreeJoint("fixed", "fixed"), inertia),
        Link("two frame", "one", TreeJoint("also fixed", "fixed")),
        Link("three", "two", TreeJoint("two", "prismatic"), inertia),
    )
    system = Tree("robot", "base", links).system()
    assert [joint.name for joint in system.joints] == ["one joint", "two"]
    assert system.body("one").point_names == ("origin", "centre", "two", "two frame", "two frame_")
    assert [load.name for load in system.loads] == ["one joint armature"]


@pytest.mark.parametrize(
    ("call", "sentence"),
    [
        (
            lambda tree: tree.system([0.0, 1.0]),
            "Tree.system: positions has 2 numbers; expected 3, one for each of ['turn', 'slide', 'bend']",
        ),
        (
            lambda tree: tree.system(rates={"turns": 1.0}),
            "Tree.system: rates: unknown joint 'turns'; did you mean 'turn'?",
        ),
        (
            lambda tree: tree.system({"turn": np.nan}),
            "Tree.system: positions of joint 'turn' is nan; expected a finite number",
        ),
        (
            lambda tree: tree.marker("base"),
            "unknown link 'base'; known: column, slider, tip, tool, wrist",
        ),
        (
            lambda tree: tree.with_fixed_joints({"turn": "far"}),
            "Tree.with_fixed_joints: 'turn' is 'far'; expected a finite number",
        ),
    ],
    ids=["count", "unknown", "no number", "base", "fixed"],
)  # fmt: skip
def test_refused_arguments(arm, call, sentence):
    with pytest.raises(InputError, match=says(sentence)):
        call(arm)
