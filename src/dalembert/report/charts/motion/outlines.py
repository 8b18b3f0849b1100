"""Lines of bodies, thinned for a film."""

from collections.abc import Mapping

import numpy as np

NAMED_BODIES = 7
"""More bodies than colours share one trace."""
POINTS_A_FRAME = 1000
GHOSTS = 6
PATH = 2000
"""Points of a path."""


def bodies_of(drawn: Mapping[str, np.ndarray]) -> dict[str, np.ndarray]:
    """Lines (frames, points, 2 or 3) in single precision, thinned; many bodies become one line with gaps."""
    total = sum(line.shape[1] for line in drawn.values())
    stride = max(1, -(-total // POINTS_A_FRAME))
    lines = {name: np.asarray(line[:, _kept(line.shape[1], stride)], dtype=np.float32) for name, line in drawn.items()}
    return lines if len(lines) <= NAMED_BODIES else {f"{len(lines)} bodies": _gapped(lines)}


def outlines(drawn: Mapping[str, np.ndarray], frames: np.ndarray) -> np.ndarray:
    """A few poses along the motion, as one line with gaps, (points, 2 or 3)."""
    poses = frames[np.unique(np.linspace(0, len(frames) - 1, GHOSTS).round().astype(int))]
    lines = _gapped({name: line[poses] for name, line in bodies_of(drawn).items()})
    return lines.reshape(-1, lines.shape[2])


def unfolded(line: np.ndarray) -> np.ndarray:
    """A line (frames, points, 3) without pieces that go back or have no length, with gaps: WebGL cannot draw them.

    >>> there_and_back = np.array([[[0.0, 0, 0], [1, 0, 0], [0, 0, 0], [0, 0, 0], [0, 1, 0]]])
    >>> unfolded(there_and_back)[0, :, :2].tolist()
    [[0.0, 0.0], [1.0, 0.0], [nan, nan], [0.0, 0.0], [0.0, 1.0]]
    """
    first = line[0]
    pieces: list[list[int]] = []
    for end in range(1, len(first)):
        back = end > 1 and np.array_equal(first[end], first[end - 2])
        if back or np.array_equal(first[end], first[end - 1]):
            continue
        if pieces and pieces[-1][-1] == end - 1:
            pieces[-1].append(end)
        else:
            pieces.append([end - 1, end])
    if not pieces:
        return line[:, :1]
    gap = np.full((len(line), 1, 3), np.nan)
    parts = [part for piece in pieces for part in (line[:, piece], gap)]
    return np.concatenate(parts[:-1], axis=1)


def path_of(path: np.ndarray) -> np.ndarray:
    """A path (samples, 2 or 3), thinned."""
    return np.asarray(path, dtype=np.float32)[:: max(1, len(path) // PATH)]


def _gapped(lines: Mapping[str, np.ndarray]) -> np.ndarray:
    """Lines (frames, points, 2 or 3) one after the other, with a gap behind each."""
    parts = [np.asarray(line, dtype=np.float32) for line in lines.values()]
    gaps = np.full((len(parts[0]), 1, parts[0].shape[2]), np.nan, dtype=np.float32)
    return np.concatenate([part for line in parts for part in (line, gaps)], axis=1)


def _kept(points: int, stride: int) -> np.ndarray:
    """Every so many of a line's points, its two ends always."""
    return np.unique(np.linspace(0, points - 1, max(2, -(-points // stride))).round().astype(int))
