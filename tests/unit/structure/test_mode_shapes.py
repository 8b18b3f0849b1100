"""Shapes of free vibrations at the nodes."""

from dataclasses import replace

import numpy as np
from inline_snapshot import snapshot

from dalembert.errors import InputError
from dalembert.structure import Dofs, Nodes, Structure, eigenmodes, mode_shapes
from refusals import refused

BAR = Structure(
    np.diag([1.0, 4.0]), np.eye(2), Dofs(("b.z", "b.x")), nodes=Nodes(("a", "b"), np.array([[0.0, 0, 0], [1, 0, 0]]))
)


def test_the_heavier_way_comes_first_and_the_largest_motion_is_one():
    shapes = mode_shapes(BAR, eigenmodes(BAR, 2)).shapes
    np.testing.assert_allclose(np.abs(shapes[:, 0]), [[1, 0, 0], [0, 0, 1]], atol=1e-12)


def test_complex_shapes_are_refused():
    modes = eigenmodes(BAR, 2)
    with refused(
        InputError,
        snapshot(
            "mode_shapes: the shapes are complex; expected those of the undamped structure, which `eigenmodes` finds, whose nodes move in phase"
        ),
    ):
        mode_shapes(BAR, replace(modes, shapes=modes.shapes * (1 + 1j)))
