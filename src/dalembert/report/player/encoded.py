"""A scene as numbers and texts that a browser draws."""

from typing import Any

import numpy as np

from dalembert.report.pictures.canvas import COLOURS, INK
from dalembert.report.scene.motion import unfolded
from dalembert.report.scene.scene import Primitive, Scene
from dalembert.report.scene.structure import sides, triangles

SIDES = "#9fc3e6"
"""Colour of the sides of finite elements on their faces."""
MOST_SIDES = 20_000


def encoded(scene: Scene) -> dict[str, Any]:
    """Return a scene in space for ``space.js``: its shapes and labels, its lowest and highest corner, gravity."""
    surfaces = {shape.part for shape in scene.primitives if shape.kind == "surface"}
    shapes = [
        part
        for shape in scene.primitives
        if shape.kind != "line" or shape.part not in surfaces
        for part in _encoded(shape)
    ]
    labels = [
        {"part": label.part, "at": label.at.tolist(), "text": label.text, "colour": _colour(label.colour)}
        for label in scene.labels
    ]
    positions = scene.positions
    box = {"low": positions.min(axis=0).tolist(), "high": positions.max(axis=0).tolist()}
    gravity = {} if scene.gravity is None else {"gravity": scene.gravity.tolist()}
    return {"shapes": shapes, "labels": labels, **box, **gravity}


def _encoded(shape: Primitive) -> list[dict[str, Any]]:
    """A shape, and the sides of its faces if it is a mesh of finite elements."""
    points = unfolded(shape.points)[0] if shape.kind == "line" else shape.points[0]
    own = {"kind": shape.kind, "part": shape.part, "points": _numbers(points), "colour": _colour(shape.colour)}
    if shape.along is not None:
        own["along"] = shape.along.tolist()
    if shape.faces is None:
        return [own]
    own["triangles"] = triangles(shape.faces).ravel().tolist()
    if shape.kind == "surface" or len(ends := sides(shape.faces)) > MOST_SIDES:
        return [own]
    lines = {"kind": "edges", "part": shape.part, "points": _numbers(points[ends].reshape(-1, 3)), "colour": SIDES}
    return [own, lines]


def _numbers(points: np.ndarray) -> list[list[float | None]]:
    """Points (points, 3) in m; None where they are gaps of a line."""
    return [[None if np.isnan(number) else round(number, 7) for number in point] for point in points.tolist()]


def _colour(number: int) -> str:
    return INK if number < 0 else COLOURS[number % len(COLOURS)]
