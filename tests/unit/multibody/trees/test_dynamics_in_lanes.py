"""Torques, mass matrices and regressors of many samples: the bits of each sample alone."""

from collections.abc import Callable

import numpy as np
import pytest

from dalembert.multibody.spatial import Inertia, Orientation, Pose
from dalembert.multibody.trees.dynamics import FEWEST_IN_LANES, inverse_dynamics, mass_matrix, regressor
from dalembert.multibody.trees.tree import PRISMATIC, REVOLUTE, Link, Tree, TreeJoint

LINKS = (("base", "a", REVOLUTE), ("a", "b", PRISMATIC), ("a", "c", REVOLUTE), ("c", "d", REVOLUTE))


def tree() -> Tree:
    """A tree with a branch and a slide, whose joints have friction."""
    pose = Pose((0.1, 0.2, 0.3), Orientation.by_angles("xz", [0.7, 0.4]))
    rod = Inertia.box(2.0, (0.1, 0.2, 0.3)).moved((0.02, 0.01, 0.15))
    return Tree(
        "branched",
        "base",
        tuple(
            Link(name, parent, TreeJoint(f"to {name}", kind, pose, damping=0.1, friction=0.2), rod)
            for parent, name, kind in LINKS
        ),
    )


@pytest.mark.parametrize(("function", "arrays"), [(inverse_dynamics, 3), (mass_matrix, 1), (regressor, 3)])
def test_a_sample_has_the_bits_of_one_alone(function: Callable[..., np.ndarray], arrays: int) -> None:
    count = FEWEST_IN_LANES + 5  # no multiple of eight
    motion = np.random.default_rng(5).normal(size=(arrays, count, len(LINKS)))
    together = function(tree(), *motion)
    alone = [function(tree(), *motion[:, k : k + 1])[0] for k in range(count)]
    np.testing.assert_array_equal(together, np.stack(alone))
