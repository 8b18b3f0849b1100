"""A model in space as a browser draws it in three dimensions: shapes of its parts, and names."""

from collections.abc import Collection, Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from dalembert.report.charts.frequency.shapes import edges, triangles
from dalembert.report.charts.motion.outlines import unfolded
from dalembert.report.pictures.canvas import COLOURS, INK
from dalembert.report.pictures.mechanism import turns
from dalembert.report.pictures.structure import ends_of, node_of, role_of

if TYPE_CHECKING:
    from dalembert.multibody.motion.sketch import Sketch
    from dalembert.vibration import VibrationSystem

Scene = dict[str, Any]
"""``shapes`` with the part that each shows, ``names``, and the corners ``low`` and ``high`` of all, in m."""
AXES = {"x": (1.0, 0.0, 0.0), "y": (0.0, 1.0, 0.0), "z": (0.0, 0.0, 1.0)}
MOST_NAMES, MOST_SIDES = 24, 20_000
MESH = "#9fc3e6"
"""Of the sides of elements, on the faces."""
ROLES = ("channel", "force", "joint", "load", "body")
"""Roles of parts whose names come first where there are too many."""


def mechanism_scene(
    sketch: "Sketch",
    channels: Mapping[str, tuple[np.ndarray, list[str]]],
    measured: Mapping[str, np.ndarray],
    tables: Collection[str] | None = None,
) -> Scene:
    """Return a mechanism: bodies as surfaces or lines, joints, loads, gravity, points with channels, measured ones.

    ``tables`` are the parts that have tables. A load at the place of another name is named only if it is among them:
    the drives of a robot would crowd its joints.
    """
    from dalembert.multibody.components.points import Point
    from dalembert.multibody.motion.sketch import is_grounded

    drawing, shapes, names = sketch.drawing, [], []
    for number, (name, line) in enumerate(drawing.lines.items()):
        part, colour = f"body {name}", COLOURS[number % len(COLOURS)]
        if name in drawing.surfaces:
            shapes.append(_mesh(part, drawing.corners(name)[0], drawing.surfaces[name].triangles, colour))
        else:
            shapes.append(_shape("line", part, unfolded(line)[0], colour))
        names.append(_name(part, line[0].mean(axis=0)))
    if drawing.ground is not None:
        shapes.append(_mesh("ground", drawing.ground.corners, drawing.ground.triangles, INK))
    for joint in sketch.system.joints:
        ends, at = sketch.ends.get(joint.name), drawing.joints.get(joint.name)
        span = ends if ends is not None else at
        if span is None:
            continue
        part, centre = f"joint {joint.name}", span[-1:] if at is None else at[:1]
        shapes.append(_shape("ball", part, centre, INK))
        if is_grounded(joint):
            attached = span[:1] if isinstance(joint.b, Point) else span[-1:]
            shapes.append(_shape("ground", part, attached, INK))
        shapes += [_shape("dashes", part, span, INK)] * (len(span) == 2)
        names.append(_name(part, span.mean(axis=0)))
    for load in sketch.system.loads:
        if load.name in sketch.ends:
            shapes.append(_load(load, sketch))
            name = _name(f"load {load.name}", sketch.ends[load.name].mean(axis=0))
            named = tables is None or name["part"] in tables
            if named or not any(np.allclose(name["at"], other["at"], atol=1e-9) for other in names):
                names.append(name)
    for owner, (position, span) in channels.items():
        outputs = ", ".join(channel.rpartition(".")[2] for channel in span)
        shapes.append(_shape("ring", f"channel {span[0]}", position[None], COLOURS[1]))
        names.append(_name(f"channel {span[0]}", position, f"{owner}: {outputs}", COLOURS[1]))
    shapes += [_shape("point", f"point {name}", position[None], INK) for name, position in sketch.marks.items()]
    shapes += [_shape("points", f"measured {name}", positions, INK) for name, positions in measured.items()]
    pull = np.real(np.array(sketch.system.gravity, dtype=complex))
    scene = _scene(shapes, names, np.concatenate([sketch.positions, *measured.values()]))
    return scene | ({"gravity": (pull / np.linalg.norm(pull)).tolist()} if pull.any() else {})


def structure_scene(system: "VibrationSystem", channels: Sequence[str] = ()) -> Scene | None:
    """Return a structure with a mesh, its forces, contacts and nodes with channels; None without positions of nodes."""
    nodes = system.structure.nodes
    if nodes is None or not len(nodes.names):
        return None
    places, known, shapes, names = nodes.places, set(nodes.names), [], []
    if nodes.faces is None or not len(nodes.faces):
        shapes.append(_shape("points", "body structure", places, COLOURS[0]))
    else:
        shapes.append(_mesh("body structure", places, triangles(nodes.faces), COLOURS[0]))
        shapes.append(_shape("edges", "body structure", places[edges(places, nodes.faces)].reshape(-1, 3), INK))
        if len(mesh := _sides(nodes.faces)) <= MOST_SIDES:
            shapes.append(_shape("edges", "body structure", places[mesh].reshape(-1, 3), MESH))
    for element in system.elements:
        ends, part = ends_of(element, known), f"{role_of(element)} {element.name}"
        if ends:
            at = places[nodes.rows(ends)]
            shapes.append(_shape("ball", part, at[:1], COLOURS[1]))
            shapes += [_shape("dashes", part, at[:2], COLOURS[1])] * (len(at) > 1)
            names.append(_name(part, at[0]))
    for channel in channels:
        if (node := node_of(channel, known)) is not None:
            shapes.append(_shape("ring", f"channel {channel}", places[nodes.rows([node])], COLOURS[1]))
            names.append(_name(f"channel {channel}", places[nodes.rows([node])][0], channel, COLOURS[1]))
    for force in system.forces:
        node, _, axis = force.dof.rpartition(".")
        if node in known and axis in AXES:
            at = places[nodes.rows([node])]
            shapes.append(_shape("arrow", f"force {force.dof}", at, COLOURS[3]) | {"along": AXES[axis], "pulls": True})
            names.append(_name(f"force {force.dof}", at[0]))
    return _scene(shapes, names, places)


def _sides(faces: np.ndarray) -> np.ndarray:
    """Ends (sides, 2) of the sides of all faces, each once."""
    return np.unique(np.sort(np.stack([faces, np.roll(faces, -1, axis=1)], axis=2).reshape(-1, 2), axis=1), axis=0)


def _load(load: Any, sketch: "Sketch") -> dict[str, Any]:
    part, ends = f"load {load.name}", sketch.ends[load.name]
    if hasattr(load, "joint") or turns(load):
        return _shape("ring", part, ends[:1], COLOURS[1])
    if len(ends) == 2 and np.ptp(ends, axis=0).max() > 0:
        return _shape("spring", part, ends, COLOURS[2])
    force = sketch.forces.get(load.name, np.zeros(3))
    if force.any():
        return _shape("arrow", part, ends[:1], COLOURS[3]) | {"along": (force / np.linalg.norm(force)).tolist()}
    return _shape("ball", part, ends[:1], COLOURS[2])


def _shape(kind: str, part: str, points: np.ndarray, colour: str) -> dict[str, Any]:
    """A shape through points; those that are not finite are gaps of a line."""
    numbers = [
        [None if np.isnan(number) else round(number, 7) for number in point] for point in np.asarray(points).tolist()
    ]
    return {"kind": kind, "part": part, "points": numbers, "colour": colour}


def _mesh(part: str, corners: np.ndarray, faces: np.ndarray, colour: str) -> dict[str, Any]:
    return _shape("mesh", part, corners, colour) | {"triangles": np.asarray(faces).ravel().tolist()}


def _name(part: str, position: np.ndarray, words: str = "", colour: str = INK) -> dict[str, Any]:
    return {
        "part": part,
        "at": np.asarray(position).tolist(),
        "words": words or part.partition(" ")[2],
        "colour": colour,
    }


def _scene(shapes: list[dict[str, Any]], names: list[dict[str, Any]], positions: np.ndarray) -> Scene:
    known = positions[np.isfinite(positions).all(axis=1)]
    low, high = known.min(axis=0).tolist(), known.max(axis=0).tolist()
    return {"shapes": shapes, "names": readable(names), "low": low, "high": high}


def readable(names: list[dict[str, Any]]) -> list[dict[str, Any]]:
    """Return the names that fit into a scene, in their order: those of whole roles, most wanted first."""
    roles = [name["part"].partition(" ")[0] for name in names]
    wanted = dict.fromkeys([*(role for role in ROLES if role in roles), *roles])
    shown: list[str] = []
    for role in wanted:
        if len(shown) + roles.count(role) <= MOST_NAMES:
            shown += [role] * roles.count(role)
    return [name for name, role in zip(names, roles, strict=True) if role in shown]
