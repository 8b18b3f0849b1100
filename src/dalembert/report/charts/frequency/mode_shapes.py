"""Shapes of free vibrations."""

import numpy as np
import plotly.graph_objects as go

from dalembert.report.charts.frequency.body import MAGNIFIED, outline, space, surface
from dalembert.report.charts.motion.film import Film
from dalembert.report.digits import shown
from dalembert.report.look import themed
from dalembert.structure import ModeShapes

MOST = 12
"""Modes that are drawn."""
SECONDS_A_MODE = 1.5


def mode_shapes(modes: ModeShapes, *, title: str = "Mode shapes") -> go.Figure:
    """Each mode at its largest deflection, coloured by the size of the displacement; a slider takes one after another.

    Parameters
    ----------
    modes : ModeShapes
    title : str

    Returns
    -------
    plotly.graph_objects.Figure
    """
    shapes = np.asarray(modes.shapes)[:MOST]
    sizes = np.linalg.norm(shapes, axis=2)
    diagonal = float(np.linalg.norm(np.ptp(modes.places, axis=0)))
    positions = modes.places + MAGNIFIED * diagonal * shapes / sizes.max(axis=1)[:, None, None]
    body = surface(positions[0], modes.faces, sizes[0], "part of the largest displacement")
    figure = go.Figure([outline(modes.places, modes.faces), body])
    figure.frames = [
        go.Frame(name=str(number), traces=[1], data=[_frame(body, frame, size)])
        for number, (frame, size) in enumerate(zip(positions, sizes, strict=True))
    ]
    labels = [f"{number}: {shown(float(value))} Hz" for number, value in enumerate(modes.frequencies[: len(shapes)], 1)]
    film = Film(labels, SECONDS_A_MODE * len(labels), "mode", "")
    space(figure, np.concatenate([positions.reshape(-1, 3), modes.places]))
    return themed(figure, title, 520, **film.controls())


def _frame(body: go.Mesh3d | go.Scatter3d, positions: np.ndarray, sizes: np.ndarray) -> dict:
    """What changes of a surface from one mode to the next."""
    size = sizes.astype(np.float32)
    colour = {"intensity": size} if body.type == "mesh3d" else {"marker": {"color": size}}
    return {"type": body.type, **dict(zip("xyz", positions.T.astype(np.float32), strict=True)), **colour}
