"""Shapes of bodies in space: closed surfaces, and the inertia of solids."""

import numpy as np
import pytest

from dalembert.errors import InputError
from dalembert.multibody.components.spatial.shapes import surface_of
from dalembert.multibody.spatial import Inertia, Orientation, Pose, RigidBody, Shape
from support import says

TURNED = Pose((0.3, -0.2, 0.5), Orientation.by_angles("zyx", [0.4, -0.7, 1.1]))
SHAPES = [Shape.box((0.1, 0.2, 0.3), TURNED), Shape.cylinder(0.1, 0.5, TURNED), Shape.sphere(0.2, TURNED)]


@pytest.mark.parametrize("shape", SHAPES, ids=lambda shape: shape.kind)
def test_surfaces_are_closed_and_face_outwards(shape):
    corners, triangles, *_ = shape.surface
    a, b, c = corners[triangles].swapaxes(0, 1)
    np.testing.assert_allclose(np.cross(b - a, c - a).sum(axis=0), 0.0, atol=1e-15)  # of a closed surface
    inside = np.einsum("ti,ti->", a - TURNED.position, np.cross(b - a, c - a)) / 6
    assert shape.volume * (0.93 if shape.kind != "box" else 1 - 1e-12) < inside <= shape.volume * (1 + 1e-12)
    sides = np.sort(np.concatenate([triangles[:, [0, 1]], triangles[:, [1, 2]], triangles[:, [2, 0]]]), axis=1)
    assert set(np.unique(sides, axis=0, return_counts=True)[1]) == {2}


@pytest.mark.parametrize("shape", SHAPES, ids=lambda shape: shape.kind)
def test_inertia_is_the_sum_over_the_solid(shape):
    """Moments over points drawn uniformly in the solid."""
    random = np.random.default_rng(0).uniform(-1, 1, (400_000, 3))
    if shape.kind == "box":
        own = random * np.array(shape.sizes) / 2
    elif shape.kind == "sphere":
        own = shape.sizes[0] * random[np.sum(random**2, axis=1) < 1]
    else:
        own = random[np.sum(random[:, :2] ** 2, axis=1) < 1] * (shape.sizes[0], shape.sizes[0], shape.sizes[1] / 2)
    points = own @ TURNED.orientation.matrix.T + TURNED.position
    homogeneous = np.column_stack([np.ones(len(points)), points])
    mass = 2700.0 * shape.volume
    expected = mass * homogeneous.T @ homogeneous / len(points)
    np.testing.assert_allclose(shape.inertia(2700.0).pseudo, expected, atol=3e-3 * mass)


def test_volumes_are_those_of_solids():
    volumes = [shape.volume for shape in SHAPES]
    np.testing.assert_allclose(volumes, [0.006, np.pi * 0.005, 4 / 3 * np.pi * 0.008], rtol=1e-14)


def test_inertia_takes_complex_sizes():
    step = 1e-30
    mass = Shape.cylinder(0.1 + 1j * step, 0.5).inertia(1000.0).mass
    assert np.imag(mass) / step == pytest.approx(1000.0 * np.pi * 2 * 0.1 * 0.5, rel=1e-14)


def test_a_body_draws_all_its_shapes():
    body = RigidBody("b", Inertia.sphere(1.0, 0.1), shapes=[*SHAPES, Shape("mesh", (1.0, 1.0, 1.0), file="arm.stl")])
    surface = body.surface
    assert len(surface.corners) == sum(len(shape.surface.corners) for shape in SHAPES)
    assert surface.triangles.max() == len(surface.corners) - 1
    assert surface_of([]) is None
    assert RigidBody("b", Inertia.sphere(1.0, 0.1)).surface is None


def test_wrong_shapes_are_refused():
    with pytest.raises(
        InputError,
        match=says("Shape: the sizes of a cylinder are (0.1,); expected a radius and a length, positive, in m"),
    ):
        Shape("cylinder", (0.1,))
    with pytest.raises(
        InputError, match=says("Shape: the sizes of a box are (0.1, -0.2, 0.3); expected three sides, positive, in m")
    ):
        Shape.box((0.1, -0.2, 0.3))
    with pytest.raises(InputError, match="unknown kind 'ball'"):
        Shape("ball", (0.1,))
    with pytest.raises(InputError, match=says("Shape: the volume of a mesh is not known. Give the body an Inertia")):
        Shape("mesh", (1.0, 1.0, 1.0)).inertia(1.0)
