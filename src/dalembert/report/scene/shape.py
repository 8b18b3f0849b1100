"""Scenes of structures that are deformed: over a period, and mode by mode."""

from typing import TYPE_CHECKING

import numpy as np

from dalembert.report.player.playback import slowness
from dalembert.report.scene.scene import ColourBar, Film, Primitive, Scene
from dalembert.report.scene.structure import edges
from dalembert.structure import ModeShapes
from dalembert.tables import labelled, prefixed, shown

if TYPE_CHECKING:
    from dalembert.vibration import Deformation

MAGNIFIED = 0.1
"""Size that the largest displacement is drawn with, as part of the structure's."""
FRAMES, FEW_FRAMES = 24, 12
MANY = 20_000
"""Nodes above which a period has fewer frames."""
SECONDS = 2.0
"""Duration of a period in a film, s."""
MOST = 12
"""Modes that are drawn."""
SECONDS_A_MODE = 1.5


def deformation_scene(shape: "Deformation") -> Scene:
    """The structure over a period, magnified, coloured by the largest displacement of each node in the period."""
    motion = _period(shape, FEW_FRAMES if len(shape.places) > MANY else FRAMES)
    count = len(motion)
    first = int(np.abs(motion).max(axis=(1, 2), initial=0.0).argmax())  # the largest deflection, to be seen in print
    order = np.roll(np.arange(count), -first)
    sizes = np.linalg.norm(motion, axis=2).max(axis=0)
    factor, unit = prefixed(float(sizes.max(initial=0.0)), "m")
    positions = shape.places + magnification(shape.places, sizes) * motion[order]
    labels = [f"{360 * number / count:.0f}" for number in order]
    film = Film(labels, SECONDS, "phase", "°", slowness(SECONDS * shape.frequency), endless=True)
    return _scene(
        shape.places, shape.faces, positions, factor * sizes[None], labelled("largest displacement", unit), film
    )


def mode_scene(modes: ModeShapes) -> Scene:
    """Each mode at its largest deflection, coloured by the size of the displacement; one frame a mode."""
    shapes = np.asarray(modes.shapes)[:MOST]
    sizes = np.linalg.norm(shapes, axis=2)
    diagonal = float(np.linalg.norm(np.ptp(modes.places, axis=0)))
    positions = modes.places + MAGNIFIED * diagonal * shapes / sizes.max(axis=1)[:, None, None]
    labels = [f"{number}: {shown(float(value))} Hz" for number, value in enumerate(modes.frequencies[: len(shapes)], 1)]
    film = Film(labels, SECONDS_A_MODE * len(labels), "mode", "")
    return _scene(modes.places, modes.faces, positions, sizes, "part of the largest displacement", film)


def _scene(
    places: np.ndarray, faces: np.ndarray, positions: np.ndarray, values: np.ndarray, quantity: str, film: Film
) -> Scene:
    """Faces, or nodes where there are none, at positions (frames, nodes, 3), m, with colours of values (frames or 1,
    nodes); behind them the sharp edges at rest.
    """
    has_faces = len(faces) > 0
    rest = places[edges(places, faces)].reshape(1, -1, 3)
    shapes = [Primitive("edges", "outline", "at rest", rest)] * has_faces
    kind = "mesh" if has_faces else "points"
    shapes.append(Primitive(kind, "body", "", positions, 0, faces if has_faces else None, values=values))
    bar = ColourBar(quantity, float(values.max(initial=0.0)) or 1.0)
    return Scene(tuple(shapes), times=np.arange(len(positions), dtype=float), film=film, bar=bar)


def _period(shape: "Deformation", count: int) -> np.ndarray:
    """Displacements at phases of a period, (phases, nodes, 3), m."""
    return shape.motion(2 * np.pi * np.arange(count) / count)


def magnification(places: np.ndarray, sizes: np.ndarray) -> float:
    """Factor that displacements of these sizes (nodes,), m, are drawn with."""
    most = float(sizes.max(initial=0.0))
    return MAGNIFIED * float(np.linalg.norm(np.ptp(places, axis=0))) / most if most > 0 else 1.0


def magnified(shape: "Deformation") -> float:
    """How much larger than they are displacements are drawn."""
    return magnification(shape.places, np.linalg.norm(_period(shape, FRAMES), axis=2).max(axis=0))
