"""Films as browsers play them, decoded."""

from base64 import b64decode
from typing import Any

import numpy as np

from dalembert.report.player.film import encoded


def decoded(scene) -> dict[str, np.ndarray]:
    """Positions (frames or 1, points, 2 or 3) of the shapes of a scene, by role and name, as a browser gets them."""
    film: dict[str, Any] = encoded(scene, complete=True)
    numbers, across, frames = np.frombuffer(b64decode(film["positions"]), "<f4"), film["dimensions"], len(film["times"])
    found = {}
    for shape in film["shapes"]:
        size = across * shape["count"] * (frames if shape["moves"] else 1)
        points, numbers = numbers[:size].reshape(-1, shape["count"], across), numbers[size:]
        if shape.get("posed"):
            poses, numbers = numbers[: 12 * frames].reshape(-1, 4, 3), numbers[12 * frames :]
            points = poses[:, :1] + points @ poses[:, 1:]
        found[f"{shape['role']} {shape['name']}".strip()] = points
    assert not len(numbers)
    return found


def kinds(scene) -> dict[str, str]:
    """Kind of each shape by its role and name."""
    return {
        f"{shape['role']} {shape['name']}".strip(): shape["kind"] for shape in encoded(scene, complete=True)["shapes"]
    }
