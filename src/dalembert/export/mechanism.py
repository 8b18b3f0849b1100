"""A mechanism in motion, as points and lines."""

from collections.abc import Iterator

import numpy as np

from dalembert.export.vtu import Mesh, chosen
from dalembert.multibody import Trajectory
from dalembert.multibody.model.drawing import Drawing, draw

STEP = 1e-30
"""Of the complex step from places to velocities."""


def motion(trajectory: Trajectory, frames: int | None, points: int) -> Iterator[tuple[float, Mesh]]:
    """Times and meshes of a motion: bodies as lines, or vertices where they are points, and joints as vertices.

    Bodies in space with shapes are triangles, too; those of beams and of reduced bodies have strains.
    """
    rows = chosen(len(trajectory.times), frames)
    times, states = trajectory.times[rows], trajectory.states
    # A place is a function of the coordinates, so a step along the velocities carries its own velocity.
    drawn = draw(trajectory.system, trajectory.lowered, times, states.x[rows] + STEP * 1j * states.v[rows], points)
    bodies = list(drawn.lines.values())
    joints = [place[:, None] for place in drawn.joints.values()]
    corners = [drawn.corners(name) for name in drawn.surfaces]
    places = np.concatenate([*bodies, *joints, *corners], axis=1)
    if places.shape[2] == 2:
        places = np.concatenate([places, np.zeros_like(places[..., :1])], axis=2)
    sizes = [line.shape[1] for line in bodies] + [1] * len(joints)
    cells, marks = _cells(sizes, len(bodies))
    if corners:
        numbers = [list(drawn.lines).index(name) for name in drawn.surfaces]
        first = sum(sizes) + np.cumsum([0, *(part.shape[1] for part in corners)])
        triangles = [surface.triangles for surface in drawn.surfaces.values()]
        cells.append(
            ("triangle", np.concatenate([part + start for part, start in zip(triangles, first, strict=False)]))
        )
        marks["body"].append(np.repeat(numbers, list(map(len, triangles))))
        marks["joint"].append(np.full(len(marks["body"][-1]), -1))
    sections = {name: np.zeros(places.shape[1]) for name in ("height", "width")}
    of_bodies = sizes[: len(bodies)]
    for name, values in sections.items():
        part = [float(np.real(getattr(body, name, 0.0))) for body in trajectory.system.bodies]
        values[: sum(of_bodies)] = np.repeat(part, of_bodies)
    strains = _strains(drawn, places.shape[:2])
    for number, (time, place) in enumerate(zip(times, places, strict=True)):
        fields = {"displacement": (place - places[0]).real, "velocity": place.imag / STEP}
        fields |= {} if strains is None else {"strain": strains[number]}
        yield float(time), Mesh(place.real, cells, fields | sections, marks)


def _strains(drawn: Drawing, shape: tuple[int, int]) -> np.ndarray | None:
    """Strains at corners of surfaces, (frames, points), zero at other points; None without such corners."""
    if all(surface.strains is None for surface in drawn.surfaces.values()):
        return None
    values, at = np.zeros(shape), shape[1] - sum(surface.corners.shape[-2] for surface in drawn.surfaces.values())
    for surface in drawn.surfaces.values():
        count = surface.corners.shape[-2]
        if surface.strains is not None:
            values[:, at : at + count] = surface.strains[:]
        at += count
    return values


def _cells(sizes: list[int], bodies: int) -> tuple[list[tuple[str, np.ndarray]], dict[str, list[np.ndarray]]]:
    """Lines along the points of each body and vertices for what has one point, with numbers of bodies and joints."""
    first = np.cumsum([0, *sizes])
    kinds = {"line": [place for place, size in enumerate(sizes) if size > 1]}
    kinds["vertex"] = [place for place, size in enumerate(sizes) if size == 1]
    cells, marks = [], {"body": [], "joint": []}
    for kind, places in kinds.items():
        if not places:
            continue
        starts = [first[place] + np.arange(max(sizes[place] - 1, 1)) for place in places]
        owner = np.repeat(places, [len(ends) for ends in starts])
        begin = np.concatenate(starts)
        cells.append((kind, np.column_stack([begin, begin + 1]) if kind == "line" else begin[:, None]))
        marks["body"].append(np.where(owner < bodies, owner, -1))
        marks["joint"].append(np.where(owner < bodies, -1, owner - bodies))
    return cells, marks
