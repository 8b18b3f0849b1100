"""The regressor of trees of links has the columns, names and order that the identification expects."""

import numpy as np

from dalembert.inverse.inertial import base_parameters, pseudo_inertia
from dalembert.multibody.components.spatial.orientation import Pose
from dalembert.multibody.spatial import Inertia, Orientation
from dalembert.multibody.trees import dynamics, parameters
from dalembert.multibody.trees.tree import Link, Tree, TreeJoint
from serial_arm import SIX, swinging, truth


def test_the_regressor_of_a_tree_is_that_of_an_independent_algorithm():
    true = truth(SIX)
    links, parent = [], "base"
    for name, (roll, *place), pseudo in zip(
        SIX.links, SIX.frames, pseudo_inertia(true[:60].reshape(6, 10)), strict=True
    ):
        pose = Pose(tuple(place), Orientation.by_rotation_vector((roll, 0.0, 0.0)))
        joint = TreeJoint(name.replace("link", "joint"), pose=pose, damping=0.4, friction=0.6, armature=0.08)
        links.append(Link(name, parent, joint, Inertia.of_pseudo(pseudo)))
        parent = name
    tree = Tree("six", "base", tuple(links))
    motion = swinging(6, 3, 60)[1:]
    ours, expected = dynamics.regressor(tree, *motion, slip=1e-3), SIX.regressor(*motion)
    assert parameters.parameter_names(tree) == SIX.names
    np.testing.assert_allclose(parameters.parameters_of(tree), true, atol=1e-14)
    np.testing.assert_allclose(ours, expected, atol=1e-12 * np.abs(expected).max())
    assert base_parameters(ours, SIX.names).rank == 52
