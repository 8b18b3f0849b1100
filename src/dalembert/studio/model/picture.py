"""The drawing of a study's model, with measured positions, computed in the process of the study's page."""

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from dalembert.errors import DalembertError, ModelError, SolveError
from dalembert.studio.editor.lines import Place
from dalembert.studio.editor.reading import study_of
from dalembert.studio.model.parts import absent_parts, places_of, shown_channels
from dalembert.studio.worker import Kept

if TYPE_CHECKING:
    from dalembert.multibody.motion.sketch import Sketch
    from dalembert.report.scene.scene import Scene
    from dalembert.study import Study

MOST = 150
"""Positions of a point that are drawn."""
FAR = 10.0
"""Size of measured positions and model, relative to that of the model, beyond which they are not drawn."""
Positions = dict[str, np.ndarray]
"""Positions (samples, 2 or 3) in m by the names of points."""


def measured_positions(study: "Study", axes: Sequence[str]) -> Positions:
    """Return positions of the points of which all coordinates are measured; none of data that cannot be read."""
    from dalembert.report.sections.motion_sections import measured

    tables = study.file.experiments or ([] if study.file.data is None else [study.file.data])
    parts_of_point: dict[str, list[np.ndarray]] = {}
    for table in tables:
        try:
            data = table.read()
        except DalembertError:  # the panel of the data says it
            continue
        for point, positions in measured(data.channels, data.values, "".join(axes)).items():
            parts_of_point.setdefault(point, []).append(positions[np.isfinite(positions).all(axis=1)])
    joined = {point: np.concatenate(parts) for point, parts in parts_of_point.items()}
    return {point: path[:: max(1, len(path) // MOST)] for point, path in joined.items() if len(path)}


def near_positions(measured: Positions, model: np.ndarray) -> tuple[Positions, list[str]]:
    """Return the positions near the model, whose points are (points, 2 or 3), and names of points that are far."""
    known = model[np.isfinite(model).all(axis=1)]
    size = float(np.ptp(known, axis=0).max())
    far = [
        point
        for point, positions in measured.items()
        if np.ptp(np.concatenate([positions, known]), axis=0).max() > FAR * size > 0
    ]
    return {point: positions for point, positions in measured.items() if point not in far}, far


Reader = Callable[[Kept, Path, str], "Study"]
"""Returns the study of a path whose study file, or model file, has a text."""
SIZE = (720, 460)
MARGIN = 0.09
"""Room for names beside the drawing, as part of its size."""
MOST_POINTS = 40
"""Points of bodies that are drawn and named."""
NOTHING = "This model is a Python function of its parameters alone. It has no shape to draw."


@dataclass(frozen=True)
class Picture:
    """A model as a page draws it. ``svg``: empty if there is nothing to draw; ``scene``: the same in three dimensions,
    of a model in space, as :func:`~dalembert.report.player.film.encoded` returns it; ``parts``: roles and names of the
    drawn parts; ``places``: places in the text by the parts of the drawing, see
    :func:`~dalembert.studio.model.parts.places_of`; ``box`` (2, 2): corners of what is drawn, m; ``absent``: parts of
    the model that have tables and no shape; ``message``: about the drawing; ``mistake``: in the model, or empty.
    """

    svg: str = ""
    scene: dict[str, Any] | None = None
    parts: tuple[str, ...] = ()
    places: dict[str, Place] = field(default_factory=dict)
    box: np.ndarray | None = None
    absent: tuple[str, ...] = ()
    message: str = ""
    mistake: str = ""


def model_picture(
    kept: Kept,
    path: Path,
    text: str,
    values: Mapping[str, float],
    box: np.ndarray | None = None,
    read: Reader = study_of,
) -> Picture:
    """Draw the model of a text at values of its parameters. ``text`` is that of the study at ``path``, or what ``read``
    takes instead. ``box`` (2, 2) has the corners of an earlier drawing, m. It is kept if the model fits into it, so
    that a drawing that follows a slider stands still.
    """
    try:
        study = read(kept, path, text)
    except DalembertError:
        return Picture(message="The text has mistakes. The drawing follows when they are corrected.")
    places = places_of(study)
    if study.file.model.forward is not None:
        return Picture(places=places, message=NOTHING)
    from dalembert.study.picture import unreduced

    parameters = study.parameters
    try:
        system = unreduced(study)(**parameters.mapping([values[name] for name in parameters.names]))
    except DalembertError as error:
        return Picture(places=places, message="The model cannot be built.", mistake=str(error))
    if not study.has_system:
        from dalembert.report.scene.structure import structure_scene

        scene = structure_scene(system, shown_channels(study))
        if scene is None:
            message = "The structure has no nodes with positions to draw."
            return Picture(places=places, absent=tuple(absent_parts(places, ())), message=message)
        return _drawn(scene, "Drawing of the structure", places, ())
    positions = kept.newest("measured positions", (path, text), lambda: measured_positions(study, system.AXES))
    return _mechanism(study, system, places, positions, box)


def _mechanism(
    study: "Study", system: Any, places: dict[str, Place], measured: Positions, box: np.ndarray | None
) -> Picture:
    from dalembert.multibody.motion.sketch import sketch
    from dalembert.report.pictures.projection import Projection
    from dalembert.report.scene.mechanism import mechanism_scene

    shown = {channel.rpartition(".")[0] for channel in shown_channels(study)}
    points = [f"{body.name}.{point}" for body in system.bodies for point in body.point_names]
    declared = {f"{body.name}.{point}" for body in system.bodies for point in getattr(body, "points", ())}
    marks = [point for point in points if point in shown or point in declared][:MOST_POINTS]
    message, mistake = "", ""
    try:
        drawn = sketch(system, marks=marks)
    except (ModelError, SolveError) as error:
        drawn = sketch(system, marks=marks, assemble=False)
        message, mistake = "Drawn as placed: the mechanism cannot be assembled.", str(error)
    channels = _channels(study, drawn)
    scene = mechanism_scene(drawn, channels, places)
    near, far = near_positions(measured, scene.positions)
    if far and not message:
        message = f"Measured positions of {', '.join(far)} are far from the model and not drawn. Check their unit."
    scene = scene.with_measured(near)
    corners = _box(Projection.of(scene.dimensions)(scene.positions), box)
    seen = [name for _, channel_names in channels.values() for name in channel_names]
    return _drawn(scene, "Drawing of the mechanism", places, seen, box=corners, message=message, mistake=mistake)


def _drawn(scene: "Scene", label: str, places: dict[str, Place], channels: Iterable[str], **state: Any) -> Picture:
    """Picture of a scene; ``channels`` have a mark, which they may share."""
    from dalembert.report.pictures.svg import scene_picture
    from dalembert.report.player.film import encoded

    svg = scene_picture(scene, label, SIZE, box=state.get("box"), choosable=True, labels=True)
    absent = absent_parts(places, scene.parts | {f"channel {name}" for name in channels})
    in_space = encoded(scene) if scene.dimensions == 3 else None
    return Picture(svg, in_space, tuple(scene.parts), places, absent=tuple(absent), **state)


def _channels(study: "Study", drawn: "Sketch") -> dict[str, tuple[np.ndarray, list[str]]]:
    """Positions of points, joints and loads with shown channels, and these channels."""
    known = {name: ends.mean(axis=0) for name, ends in drawn.ends.items()}
    known |= {name: motion[0] for name, motion in drawn.drawing.joints.items()} | drawn.marks
    result: dict[str, tuple[np.ndarray, list[str]]] = {}
    for channel in shown_channels(study):
        owner = channel.rpartition(".")[0]
        if owner in known:
            result.setdefault(owner, (known[owner], []))[1].append(channel)
    return result


def _box(points: np.ndarray, before: np.ndarray | None) -> np.ndarray:
    """Corners around points, or the earlier ones if the points lie in them and fill a third of them."""
    points = points[np.isfinite(points).all(axis=1)]
    low, high = points.min(axis=0), points.max(axis=0)
    if before is not None:
        size, old = float(np.max(high - low)), float(np.max(before[1] - before[0]))
        if (low >= before[0] - 0.02 * old).all() and (high <= before[1] + 0.02 * old).all() and 3 * size > old:
            return before
    room = MARGIN * float(np.max(high - low))
    return np.array([low - room, high + room])
