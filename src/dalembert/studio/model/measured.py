"""Measured positions of points, drawn beside the model."""

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from dalembert.errors import DalembertError

if TYPE_CHECKING:
    from dalembert.study import Study

MOST = 150
"""Positions of a point that are drawn."""
FAR = 10.0
"""Size of measured positions and model, relative to that of the model, beyond which they are not drawn."""
Positions = dict[str, np.ndarray]
"""Positions (samples, 2 or 3) in m by the names of points."""


def measured_positions(study: "Study", axes: Sequence[str]) -> Positions:
    """Return positions of the points of which all coordinates are measured; none of data that cannot be read."""
    from dalembert.report.sections.motion.trajectory import measured

    tables = study.file.experiments or ([] if study.file.data is None else [study.file.data])
    found: dict[str, list[np.ndarray]] = {}
    for table in tables:
        try:
            data = table.read()
        except DalembertError:  # the panel of the data says it
            continue
        for point, positions in measured(data.channels, data.values, "".join(axes)).items():
            found.setdefault(point, []).append(positions[np.isfinite(positions).all(axis=1)])
    whole = {point: np.concatenate(parts) for point, parts in found.items()}
    return {point: own[:: max(1, len(own) // MOST)] for point, own in whole.items() if len(own)}


def near_positions(measured: Positions, model: np.ndarray) -> tuple[Positions, list[str]]:
    """Return the positions near the model, whose points are (points, 2 or 3), and names of points that are far."""
    known = model[np.isfinite(model).all(axis=1)]
    size = float(np.ptp(known, axis=0).max())
    far = [
        point for point, own in measured.items() if np.ptp(np.concatenate([own, known]), axis=0).max() > FAR * size > 0
    ]
    return {point: own for point, own in measured.items() if point not in far}, far
