"""Torques, mass matrices, regressors and positions of trees."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from dalembert.errors import InputError, ModelError
from dalembert.multibody.trees.dynamics import bias_forces, inverse_dynamics, mass_matrix, poses, regressor
from dalembert.multibody.trees.parameters import parameters_of
from dalembert.multibody.trees.tree import Tree
from robots import random_motion, random_robot, six_joints, three_joints

ROBOTS = {
    "three joints": three_joints(damping=0.3, friction=0.4, armature=0.05),
    "six joints": six_joints(damping=0.3, friction=0.4, armature=0.05),
}
NEAR = dict(rtol=0, atol=1e-12)


def following(tree: Tree, leader: str, follower: str, factor: float, offset: float) -> Tree:
    """The tree with a joint that follows another one."""
    links = (
        replace(link, joint=replace(link.joint, mimic=(leader, factor, offset)))
        if link.joint.name == follower
        else link
        for link in tree.links
    )
    return replace(tree, links=tuple(links))


@pytest.fixture(params=ROBOTS)
def tree(request: pytest.FixtureRequest) -> Tree:
    return ROBOTS[request.param]


@pytest.mark.parametrize("slip", [None, 0.3])
def test_torques_are_linear_in_the_parameters(tree, slip):
    q, v, a = random_motion(tree, 20)
    torques = inverse_dynamics(tree, q, v, a, slip=slip)
    assert torques.shape == (20, len(tree.moving))
    linear = regressor(tree, q, v, a, slip=slip) @ parameters_of(tree)
    np.testing.assert_allclose(linear, torques, rtol=0, atol=1e-12 * np.abs(torques).max())


def test_mass_matrix_is_that_of_inverse_dynamics(tree):
    q, v, a = random_motion(tree, 20)
    masses, nothing = mass_matrix(tree, q), np.zeros_like(q)
    np.testing.assert_array_equal(masses, masses.transpose(0, 2, 1))
    assert np.linalg.eigvalsh(masses).min() > 0.0
    for k, unit in enumerate(np.eye(q.shape[1])):
        column = inverse_dynamics(tree, q, nothing, np.broadcast_to(unit, q.shape), (0.0, 0.0, 0.0))
        np.testing.assert_allclose(masses[:, :, k], column, **NEAR)
    whole = np.einsum("sij,sj->si", masses, a) + bias_forces(tree, q, v)
    np.testing.assert_allclose(inverse_dynamics(tree, q, v, a, friction=False), whole, **NEAR)


def test_friction_and_armature_are_selectable(tree):
    q, v, a = random_motion(tree, 5)
    bare = inverse_dynamics(tree, q, v, a, friction=False, armature=False)
    np.testing.assert_allclose(inverse_dynamics(tree, q, v, a, friction=False), bare + 0.05 * a, **NEAR)
    rubbing = bare + 0.3 * v + 0.4 * np.sign(v)
    np.testing.assert_allclose(inverse_dynamics(tree, q, v, a, armature=False), rubbing, **NEAR)
    smooth = bare + 0.3 * v + 0.4 * np.tanh(v / 0.2)
    np.testing.assert_allclose(inverse_dynamics(tree, q, v, a, armature=False, slip=0.2), smooth, **NEAR)
    difference = mass_matrix(tree, q) - mass_matrix(tree, q, armature=False)
    np.testing.assert_allclose(difference, np.broadcast_to(0.05 * np.eye(q.shape[1]), difference.shape), **NEAR)


def test_poses_are_products_of_those_of_joints(tree):
    q = random_motion(tree, 4)[0]
    place, axes = poses(tree, q)
    slots = {joint.name: k for k, joint in enumerate(tree.moving)}
    known = {tree.root: (np.zeros((4, 3)), np.broadcast_to(np.eye(3), (4, 3, 3)))}
    for k, link in enumerate(tree.links):
        origin, turned = known[link.parent]
        origin = origin + turned @ np.array(link.joint.pose.position)
        turned = turned @ link.joint.pose.orientation.matrix
        u = np.array(link.joint.axis) / np.linalg.norm(link.joint.axis)
        if link.joint.kind == "prismatic":
            origin = origin + q[:, slots[link.joint.name], None] * (turned @ u)
        elif link.joint.moves:
            turned = turned @ Rotation.from_rotvec(np.outer(q[:, slots[link.joint.name]], u)).as_matrix()
        np.testing.assert_allclose(place[:, k], origin, **NEAR)
        np.testing.assert_allclose(axes[:, k], turned, **NEAR)
        known[link.name] = origin, turned


def test_a_following_joint_reduces_the_coordinates():
    free = six_joints(damping=0.3, friction=0.4, armature=0.05)
    tree = following(free, "joint2", "joint5", -0.5, 0.3)
    factors = np.array(
        [[1, 0, 0, 0, 0], [0, 1, 0, 0, 0], [0, 0, 1, 0, 0], [0, -0.5, 0, 0, 0], [0, 0, 0, 1, 0], [0, 0, 0, 0, 1.0]]
    )
    q, v, a = random_motion(tree, 6)
    every = q @ factors.T + [0, 0, 0, 0.3, 0, 0], v @ factors.T, a @ factors.T
    torques = inverse_dynamics(tree, q, v, a)
    np.testing.assert_allclose(torques, inverse_dynamics(free, *every) @ factors, **NEAR)
    np.testing.assert_allclose(mass_matrix(tree, q), factors.T @ mass_matrix(free, every[0]) @ factors, **NEAR)
    np.testing.assert_allclose(regressor(tree, q, v, a) @ parameters_of(tree), torques, **NEAR)
    np.testing.assert_allclose(poses(tree, q).positions, poses(free, every[0]).positions, **NEAR)


def test_a_joint_that_follows_a_fixed_one_is_refused():
    tree = following(random_robot(1, "frr"), "joint0", "joint1", 1.0, 0.0)
    with pytest.raises(ModelError) as error:
        mass_matrix(tree, np.zeros((1, len(tree.moving))))
    assert str(error.value) == (
        "joint 'joint1' follows joint 'joint0', which does not move. Let it follow one that moves"
    )


def test_derivatives_by_the_complex_step(tree):
    q, v, a = random_motion(tree, 3)
    step = 1e-30
    direction = np.random.default_rng(8).normal(size=q.shape)
    for function in (
        lambda q: inverse_dynamics(tree, q, v, a, slip=0.1),
        lambda q: mass_matrix(tree, q),
        lambda q: regressor(tree, q, v, a, slip=0.1),
        lambda q: poses(tree, q).positions,
    ):
        exact = function(q + 1j * step * direction).imag / step
        differences = (function(q + 1e-5 * direction) - function(q - 1e-5 * direction)) / 2e-5
        np.testing.assert_allclose(exact, differences, rtol=0, atol=1e-7 * max(1.0, np.abs(exact).max()))


def test_parameters_may_be_complex():
    tree = three_joints(damping=0.3, friction=0.4, armature=0.05)
    q, v, a = random_motion(tree, 3)
    columns = regressor(tree, q, v, a)
    masses = {f"{name}.damping": 0.3 + 1e-30j for name in ("joint0", "joint2")} | {"link1.mass": 1.0 + 1e-30j}
    torques = inverse_dynamics(tree.with_numbers(masses), q, v, a)
    varied = parameters_of(tree.with_numbers(masses)).imag / 1e-30
    np.testing.assert_allclose(torques.imag / 1e-30, columns @ varied, **NEAR)


def test_a_tree_with_other_numbers_has_other_torques():
    tree = three_joints()
    q, v, a = random_motion(tree, 3)
    before = inverse_dynamics(tree, q, v, a)
    heavier = tree.with_numbers({"link2.mass": 4.0})
    assert np.abs(inverse_dynamics(heavier, q, v, a) - before).max() > 0.1
    np.testing.assert_array_equal(inverse_dynamics(tree, q, v, a), before)


def test_a_tree_without_joints_has_no_torques():
    for tree in (random_robot(1, "ff"), Tree("nothing", "base", ())):
        nothing = np.zeros((2, 0))
        assert inverse_dynamics(tree, nothing, nothing, nothing).shape == (2, 0)
        assert poses(tree, nothing).positions.shape == (2, len(tree.links), 3)
        assert regressor(tree, nothing, nothing, nothing).shape == (2, 0, 10 * len(tree.links))


@pytest.mark.parametrize(
    ("wrong", "message"),
    [
        (
            {"v": np.zeros((4, 3))},
            "tree 'robot3': v has the shape (4, 3); expected numbers of the shape (5, 3), a column for each joint of "
            "tree.moving",
        ),
        (
            {"q": np.zeros(3)},
            "tree 'robot3': q has the shape (3,); expected numbers of the shape (samples, 3), a column for each joint of "
            "tree.moving",
        ),
        (
            {"a": np.where(np.arange(15) == 7, np.nan, 0.0).reshape(5, 3)},
            "tree 'robot3': a of joint 'joint1' is nan in sample 2; expected a finite number. Remove the sample",
        ),
        ({"gravity": (0.0, -9.81)}, "gravity is (0.0, -9.81); expected three numbers in m/s^2, such as (0, 0, -9.81)"),
        ({"slip": 0.0}, "slip is 0.0; expected a positive rate in rad/s or m/s, or None for sign(v)"),
    ],
)
def test_wrong_samples_are_refused(wrong, message):
    given = {"q": np.zeros((5, 3)), "v": np.zeros((5, 3)), "a": np.zeros((5, 3))} | wrong
    for function in (inverse_dynamics, regressor):
        with pytest.raises(InputError) as error:
            function(three_joints(friction=0.1), **given)
        assert str(error.value) == message
