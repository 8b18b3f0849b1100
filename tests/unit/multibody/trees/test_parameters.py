"""The parameters in which the torques of a tree are linear."""

import numpy as np
import pytest

from dalembert.errors import InputError
from dalembert.multibody.spatial import Inertia
from dalembert.multibody.trees.parameters import parameter_names, parameters_of, with_parameters
from dalembert.multibody.trees.tree import Link, Tree, TreeJoint
from robots import six_joints, three_joints


def test_parameters_are_named_in_order():
    inertia = Inertia(2.0, (0.1, 0.2, 0.25), (0.01, 0.02, 0.03), (0.5, -0.4, 0.3))
    joint = TreeJoint("pin", damping=0.7, friction=0.8, armature=0.9)
    frame = Link("frame", "base", TreeJoint("weld", "fixed"))
    tree = Tree("arm", "base", (frame, Link("rod", "frame", joint, inertia)))
    expected = {
        "rod.mass": 2.0,
        "rod.first_x": 1.0,
        "rod.first_y": -0.8,
        "rod.first_z": 0.6,
        "rod.second_xx": 0.1 + 2 * (0.16 + 0.09),
        "rod.second_yy": 0.2 + 2 * (0.25 + 0.09),
        "rod.second_zz": 0.25 + 2 * (0.25 + 0.16),
        "rod.second_xy": 0.01 + 2 * 0.5 * 0.4,
        "rod.second_xz": 0.02 - 2 * 0.5 * 0.3,
        "rod.second_yz": 0.03 + 2 * 0.4 * 0.3,
        "pin.damping": 0.7,
        "pin.friction": 0.8,
        "pin.armature": 0.9,
    }
    assert parameter_names(tree) == tuple(expected)
    np.testing.assert_allclose(parameters_of(tree), list(expected.values()), rtol=1e-14)


@pytest.mark.parametrize("tree", [three_joints(), six_joints(damping=0.1, armature=0.2)], ids=["three", "six"])
def test_a_tree_with_its_parameters_is_the_same(tree):
    scaled = parameters_of(tree) * 1.25
    changed = with_parameters(tree, scaled)
    np.testing.assert_allclose(parameters_of(changed), scaled, rtol=0, atol=1e-14)
    assert [link.joint.pose for link in changed.links] == [link.joint.pose for link in tree.links]
    for link, before in zip(changed.links, tree.links, strict=True):
        np.testing.assert_allclose(link.inertia.centre, before.inertia.centre, rtol=0, atol=1e-14)


def test_impossible_parameters_are_refused():
    tree = three_joints()
    values = parameters_of(tree)
    with pytest.raises(InputError) as error:
        with_parameters(tree, values[:-1])
    assert str(error.value) == (
        "with_parameters: parameters has the shape (38,); expected (39,), the order of parameter_names(tree)"
    )
    values[10] = -1.0
    with pytest.raises(InputError) as error:
        with_parameters(tree, values)
    assert str(error.value) == "link 'link1': the mass is -1 kg; expected a positive one"
    values[10], values[14:20] = 1.0, 0.0
    with pytest.raises(InputError, match="link 'link1': Inertia: the smallest principal moment, about "):
        with_parameters(tree, values)
