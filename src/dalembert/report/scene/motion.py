"""The scene of a mechanism over time, thinned for an animation."""

from collections.abc import Mapping

import numpy as np

from dalembert.multibody import Drawing
from dalembert.multibody.components.spatial.mesh_files import simplified
from dalembert.multibody.components.spatial.shapes import Surface
from dalembert.report.scene.mechanism import FEW_BODIES
from dalembert.report.scene.scene import ColourBar, Primitive, Scene

POINTS_A_FRAME = 1000
"""Points of lines above which lines are thinned."""
CORNERS_A_FRAME = 2500
"""Corners of surfaces above which surfaces are simplified."""
FEWEST = 20
"""Corners of a surface below which bodies are drawn as lines."""
POSES = 6
"""Of the outline of a motion."""
PATH, MEASURED = 2000, 150
"""Points of a path, and measured positions of a point."""
DEVIATION = 2e-4
"""Of a simplified path, as part of its size."""
AXIS = 0.09
"""Length of the axes of a body as part of the drawing's size."""
STILL = 1e-9
"""Motion of a joint, as part of the drawing's size, below which it is fixed to the ground."""
Lines = Mapping[str, np.ndarray]
"""Points (samples, 2 or 3) or (frames, points, 2 or 3) by name, m."""


def motion_scene(drawing: Drawing, frames: np.ndarray, *, paths: Lines, measured: Lines) -> Scene:
    """Return bodies, their axes and joints of a drawing at some of its frames, paths, and measured positions.

    The lines of more than seven bodies become one with gaps; so do a few poses along the motion. Beams and reduced
    bodies have the colours of their strains.
    """
    lines = {name: np.asarray(line)[frames] for name, line in drawing.lines.items()}
    joints = {name: np.asarray(at)[frames] for name, at in drawing.joints.items()}
    in_space = next(iter([*lines.values(), *joints.values()])).shape[-1] == 3
    surfaces = _surfaces(drawing) if in_space else {}
    poses = np.unique(np.linspace(0, len(frames) - 1, POSES).round().astype(int))
    outline = joined({name: line[poses] for name, line in thinned(lines).items()})
    shapes = [Primitive("line", "outline", "", outline.reshape(1, -1, outline.shape[2]))]
    if in_space and drawing.ground is not None:
        ground = drawing.ground
        shapes.append(Primitive("surface", "ground", "", ground.corners[None], faces=ground.triangles))
    shapes += [Primitive("line", "path", name, simplified_path(path)[None]) for name, path in paths.items()]
    for name, positions in measured.items():
        known = positions[np.isfinite(positions).all(axis=1)]
        shapes.append(Primitive("crosses", "measured", name, known[None, :: max(1, len(known) // MEASURED)]))
    numbers = {name: number for number, name in enumerate(lines)}
    drawn = thinned({name: line for name, line in lines.items() if name not in surfaces})
    if len(drawn) > FEW_BODIES:
        drawn = {f"{len(drawn)} bodies": joined(drawn)}
    shapes += [Primitive("line", "body", name, line, numbers.get(name, 0)) for name, line in drawn.items()]
    strains = {name: surface.strains[frames] for name, surface in surfaces.items() if surface.strains is not None}
    highest = max((float(own.max()) for own in strains.values()), default=0.0)
    for name, surface in surfaces.items():
        deforms = surface.corners.ndim == 3
        corners = surface.corners[frames] if deforms else surface.corners[None]
        poses = None if deforms else drawing.axes[name][frames]
        values = strains.get(name) if highest else None
        shapes.append(
            Primitive("surface", "body", name, corners, numbers[name], surface.triangles, poses=poses, values=values)
        )
    size = max(float(np.ptp(Scene(tuple(shapes)).positions, axis=0).max()), 1e-9)
    for name, at in joints.items():
        is_still = float(np.ptp(at, axis=0).max()) <= STILL * size
        shapes.append(Primitive("ground" if is_still else "joint", "joint", name, at[: 1 if is_still else None, None]))
    if in_space and 0 < len(drawing.axes) <= FEW_BODIES:
        shapes += _axes({name: axes[frames] for name, axes in drawing.axes.items()}, AXIS * size)
    measures = {surfaces[name].measure for name in strains}
    bar = ColourBar(measures.pop() if len(measures) == 1 else "strain", highest) if highest else None
    return Scene(tuple(shapes), times=np.asarray(drawing.times, dtype=float)[frames], bar=bar)


def thinned(lines: Lines) -> dict[str, np.ndarray]:
    """Return lines (frames, points, 2 or 3) with every so many of their points, their two ends always."""
    stride = max(1, -(-sum(line.shape[1] for line in lines.values()) // POINTS_A_FRAME))
    return {
        name: line[:, np.unique(np.linspace(0, points - 1, max(2, -(-points // stride))).round().astype(int))]
        for name, line in lines.items()
        for points in [line.shape[1]]
    }


def simplified_path(path: np.ndarray) -> np.ndarray:
    """Return those of the points (samples, 2 or 3) of a path that its shape needs (Ramer, Douglas and Peucker).
    >>> simplified_path(np.array([[0.0, 0], [1, 0], [2, 0], [2, 1], [2, 2]])).tolist()
    [[0.0, 0.0], [2.0, 0.0], [2.0, 2.0]]
    """
    path = path[:: max(1, len(path) // PATH)]
    kept, pieces = {0, len(path) - 1}, [(0, len(path) - 1)]
    limit = DEVIATION * float(np.nanmax(np.ptp(path, axis=0)))
    while pieces:
        first, last = pieces.pop()
        inner, chord = path[first + 1 : last] - path[first], path[last] - path[first]
        share = np.clip(inner @ chord / (chord @ chord or 1.0), 0.0, 1.0)
        distances = np.linalg.norm(inner - share[:, None] * chord, axis=1)
        if len(inner) and not float(distances.max()) <= limit:
            middle = first + 1 + int(distances.argmax())
            kept.add(middle)
            pieces += [(first, middle), (middle, last)]
    return path[sorted(kept)]


def joined(lines: Lines) -> np.ndarray:
    """Return lines (frames, points, 2 or 3) one after the other, with a gap behind each."""
    first = next(iter(lines.values()))
    gap = np.full((len(first), 1, first.shape[2]), np.nan)
    return np.concatenate([part for line in lines.values() for part in (line, gap)], axis=1)


def _surfaces(drawing: Drawing) -> dict[str, Surface]:
    """Surfaces of bodies, simplified; none where there are too many corners."""
    surfaces = dict(drawing.surfaces)
    if sum(surface.corners.shape[-2] for surface in surfaces.values()) > CORNERS_A_FRAME:
        most = CORNERS_A_FRAME // len(surfaces)
        if most < FEWEST:
            return {}
        for name, surface in surfaces.items():
            if surface.corners.ndim == 2 and len(surface.corners) > most:
                surfaces[name] = Surface(*simplified(surface.corners, surface.triangles, most))
    return surfaces


def _axes(axes: Lines, length: float) -> list[Primitive]:
    """The axes x, y and z of bodies (frames, 4, 3), each as one line with gaps; red, green and blue."""
    return [
        Primitive("line", "axis", name, joined({body: _ray(frame, k, length) for body, frame in axes.items()}), colour)
        for k, (name, colour) in enumerate({"x": 1, "y": 2, "z": 0}.items(), start=1)
    ]


def _ray(axes: np.ndarray, number: int, length: float) -> np.ndarray:
    """Origin of a body and the end of one of its axes, (frames, 2, 3)."""
    return np.stack([axes[:, 0], axes[:, 0] + length * axes[:, number]], axis=1)
