"""The scene of a mechanism along a path of equilibria."""

from dataclasses import replace

import numpy as np

from dalembert.multibody import EquilibriumPath
from dalembert.report.scene.motion import motion_scene
from dalembert.report.scene.scene import Film, Scene
from dalembert.tables import shown

MOST = 60
"""Equilibria that are drawn, beside the critical points."""
SECONDS = 6.0


def path_scene(path: EquilibriumPath) -> Scene:
    """The mechanism at equilibria of a path and at each critical point; one frame each."""
    line, names = path.line, {}
    for node, point in zip(line.critical.tolist(), path.critical, strict=True):
        names[node] = point.name
    others = np.linspace(0, len(line.loads) - 1, min(MOST, len(line.loads))).round().astype(int)
    nodes = np.union1d(others, line.critical)
    labels = []
    for node in nodes.tolist():
        # A node begins the segment after it; the last one has only the segment before it.
        state = names.get(node, "stable" if line.stable[min(node, len(line.stable) - 1)] else "unstable")
        labels.append(f"{shown(float(line.loads[node]))} {path.unit}".rstrip() + f", {state}")
    scene = motion_scene(path.drawing(nodes), np.arange(len(nodes)), paths={}, measured={})
    film = Film(labels, SECONDS, path.parameter, "")
    return replace(scene, times=np.arange(len(nodes), dtype=float), film=film)
