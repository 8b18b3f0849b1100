"""The deformed shape of a structure that vibrates, in motion."""

import numpy as np
import plotly.graph_objects as go

from dalembert.report.charts.frequency.body import magnification, outline, space, surface
from dalembert.report.charts.motion.film import Film, slowness
from dalembert.report.digits import shown
from dalembert.report.look import themed
from dalembert.report.prefixes import prefixed
from dalembert.report.quantities import labelled
from dalembert.vibration import Deformation

FRAMES, FEW_FRAMES = 24, 12
MANY = 20_000
"""Numbers of a frame above which there are fewer of them."""
SECONDS = 2.0
STILL = 1e-3
"""Part of the largest displacement up to which an axis counts as still."""


def deformation(shape: Deformation, *, title: str | None = None) -> go.Figure:
    """The structure over a period, magnified, coloured by the largest displacement of each node in the period.

    Parameters
    ----------
    shape : Deformation
    title : str, optional

    Returns
    -------
    plotly.graph_objects.Figure
    """
    moving = np.abs(shape.motion(2 * np.pi * np.arange(FRAMES) / FRAMES))
    along = np.flatnonzero(moving.max(axis=(0, 1), initial=0.0) > STILL * moving.max(initial=0.0))
    count = FEW_FRAMES if len(shape.places) * max(len(along), 1) > MANY else FRAMES
    motion = shape.motion(2 * np.pi * np.arange(count) / count)
    first = int(np.abs(motion).max(axis=(1, 2), initial=0.0).argmax())  # the largest deflection, to be seen in print
    order = np.roll(np.arange(count), -first)
    motion = motion[order]
    sizes = np.linalg.norm(motion, axis=2).max(axis=0)
    factor, unit = prefixed(float(sizes.max(initial=0.0)), "m")
    positions = shape.places + magnification(shape.places, sizes) * motion
    body = surface(positions[0], shape.faces, factor * sizes, labelled("largest displacement", unit))
    figure = go.Figure([outline(shape.places, shape.faces), body])
    figure.frames = [
        go.Frame(
            name=str(number),
            traces=[1],
            data=[{"type": body.type, **{"xyz"[axis]: frame[:, axis].astype(np.float32) for axis in along}}],
        )
        for number, frame in enumerate(positions)
    ]
    labels = [f"{360 * number / count:.0f}" for number in order]
    film = Film(labels, SECONDS, "phase", "°", slowness(SECONDS * shape.frequency), endless=True)
    space(figure, np.concatenate([positions.reshape(-1, 3), shape.places]))
    return themed(figure, title or f"Deformed shape at {shown(shape.frequency)} Hz", 520, **film.controls())


def magnified(shape: Deformation) -> float:
    """How much larger than they are displacements are drawn."""
    motion = shape.motion(2 * np.pi * np.arange(FRAMES) / FRAMES)
    return magnification(shape.places, np.linalg.norm(motion, axis=2).max(axis=0))
