"""Scenes as a browser draws them: texts, and their positions as one block of numbers."""

from base64 import b64encode
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from dalembert.report.pictures.colour_bar import STEPS, graded, ticks
from dalembert.report.player.playback import Playback
from dalembert.report.scene.motion import motion_scene
from dalembert.report.scene.scene import Scene

if TYPE_CHECKING:
    from dalembert.multibody import Drawing

FINE = 6001
REPORT_ONLY = ("outline", "axis")
"""Roles that only reports show."""


def frames(end: float) -> np.ndarray:
    """Times of the frames of a motion until ``end`` (s), as the films of reports have them."""
    return Playback.of(np.linspace(0.0, end, FINE)).times


def film_of(drawing: "Drawing", measured: Mapping[str, np.ndarray], rows: np.ndarray | None = None) -> dict[str, Any]:
    """Return a drawing at the times of :func:`frames`, with measured positions (samples, 2 or 3), encoded.

    ``rows`` are the numbers of these times among those of the drawing; all if not given.
    """
    rows = np.arange(len(drawing.times)) if rows is None else rows
    return encoded(motion_scene(drawing, rows, paths={}, measured=measured))


def encoded(scene: Scene, *, complete: bool = False) -> dict[str, Any]:
    """Return a scene as ``space.js`` and ``plane.js`` take it. ``positions``: single precision in base64, of each shape
    in turn (frames or 1, count, 2 or 3), m, of one with poses (frames, 4, 3), and of one with ``values`` these (values,
    count). Bodies with a surface have no lines. ``frames`` (texts) and ``quantity`` are those of a film that
    is not over time. ``complete``: with outlines of poses and axes of bodies, as in reports.
    """
    surfaces = {shape.part for shape in scene.primitives if shape.kind == "surface"}
    drawn = [
        shape
        for shape in scene.primitives
        if (complete or shape.role not in REPORT_ONLY) and (shape.kind != "line" or shape.part not in surfaces)
    ]
    shapes: list[dict[str, Any]] = []
    for shape in drawn:
        item = {"kind": shape.kind, "role": shape.role, "name": shape.name, "colour": shape.colour}
        item |= {"count": shape.points.shape[1], "moves": len(shape.points) > 1}
        item |= {} if shape.poses is None else {"posed": True}
        item |= {} if shape.faces is None else {"faces": shape.faces.tolist()}
        item |= {} if shape.along is None else {"along": shape.along.tolist()}
        item |= {} if shape.values is None else {"values": len(shape.values)}
        shapes.append(item)
    numbers = [part for shape in drawn for part in (shape.points, shape.poses, shape.values) if part is not None]
    positions = np.concatenate([part.astype("<f4").ravel() for part in numbers])
    film, bar = scene.film, scene.bar
    known: dict[str, Any] = {}
    if film is not None:
        labels = [f"{film.name} {label} {film.unit}".rstrip() for label in film.labels]
        known |= {"frames": labels, "quantity": film.name, "endless": film.endless}
    if bar is not None:
        known["bar"] = {**vars(bar), "colours": graded(np.linspace(0.0, 1.0, STEPS + 1)), "ticks": ticks(bar)}
    return known | {
        "dimensions": scene.dimensions,
        "times": [round(time, 9) for time in scene.times.tolist()],
        "seconds": Playback.of(scene.times).seconds if film is None else film.seconds,
        "shapes": shapes,
        "labels": [{**vars(label), "at": label.at.tolist()} for label in scene.labels],
        "gravity": None if scene.gravity is None else scene.gravity.tolist(),
        "positions": b64encode(positions.tobytes()).decode(),
    }
