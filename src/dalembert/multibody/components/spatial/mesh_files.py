"""Surfaces from files of meshes, with as few corners as a moving picture needs."""

import warnings
from functools import lru_cache
from importlib import import_module
from importlib.util import find_spec
from pathlib import Path
from typing import Any

import numpy as np

SUFFIXES = (".dae", ".obj", ".ply", ".stl")
CORNERS = 250
"""Corners of a drawn mesh at most."""
_FINEST = 64
"""Cells along the longest side of a mesh at most."""


def unread(path: Path) -> str:
    """Say why the file of a mesh is not drawn; empty if it can be read."""
    if path.suffix.lower() not in SUFFIXES:
        return f"is no {', '.join(SUFFIXES[:-1])} or {SUFFIXES[-1]} file. Convert it to be drawn"
    if find_spec("trimesh") is None:
        return "needs trimesh, which is not installed, to be drawn; run: pip install 'dalembert[meshes]'"
    return ""


def triangles_of(path: str) -> tuple[np.ndarray, np.ndarray] | None:
    """Return corners and triangles (both (count, 3)) of a mesh; None, with a warning, if it cannot be read."""
    try:
        return _read(path, Path(path).stat().st_mtime_ns)
    except Exception as error:  # whatever a library of file formats raises for a damaged file
        warnings.warn(
            f"the mesh {path} cannot be read, so it is not drawn: {type(error).__name__}: {error}",
            RuntimeWarning,
            stacklevel=2,
        )
        return None


@lru_cache(maxsize=256)
def _read(path: str, changed: int) -> tuple[np.ndarray, np.ndarray]:
    """The mesh of a file of this state, simplified."""
    library: Any = import_module("trimesh")
    mesh = library.load_scene(path, skip_materials=True).to_mesh()
    corners, triangles = np.asarray(mesh.vertices, dtype=float), np.asarray(mesh.faces, dtype=np.int64)
    if not len(triangles) or not np.all(np.isfinite(corners)):
        raise ValueError("it has no triangles, or corners that are not finite")
    return simplified(corners, triangles)


def simplified(corners: np.ndarray, triangles: np.ndarray, most: int = CORNERS) -> tuple[np.ndarray, np.ndarray]:
    """Return a mesh of at most ``most`` corners: those in one cell of a grid become their mean.

    The grid is the finest one with so few cells. Rossignac and Borrel, Multi-resolution 3D approximations (1993).

    >>> line = np.linspace(0.0, 1.0, 1000)
    >>> corners = np.column_stack([line, line**2, 0.0 * line])
    >>> triangles = np.arange(998)[:, None] + [0, 1, 2]
    >>> few, _ = simplified(corners, triangles, most=50)
    >>> 40 < len(few) <= 50
    True
    """
    low, size = corners.min(axis=0), np.ptp(corners, axis=0).max()
    finest = np.unique(corners, axis=0, return_inverse=True)
    places, owners = finest[0], finest[1].ravel()
    count = _FINEST
    while len(places) > most and count > 1:
        cells = np.floor((corners - low) / size * count)
        _, owners = np.unique(cells, axis=0, return_inverse=True)
        owners = owners.ravel()
        share = np.bincount(owners)
        places = np.column_stack([np.bincount(owners, corners[:, k]) / share for k in range(3)])
        count = min(count - 1, int(count * 0.9))
    moved = owners[triangles]
    whole = moved[(moved[:, 0] != moved[:, 1]) & (moved[:, 1] != moved[:, 2]) & (moved[:, 2] != moved[:, 0])]
    _, first = np.unique(np.sort(whole, axis=1), axis=0, return_index=True)
    return places, whole[np.sort(first)]
