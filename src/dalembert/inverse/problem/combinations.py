"""Combinations of parameters that nothing separates, in plain sentences."""

from collections.abc import Sequence

import numpy as np
from scipy import linalg

from dalembert.errors import listed
from dalembert.parameters import Parameters

SHOWN = 0.1
"""Part of its width by which the parameter that moves most moves in a sentence."""

MEMBER = 0.1
"""Parameters that move by less than this part of the largest move, both as parts of their widths, are not named."""


def amounts(parameters: Parameters, values: np.ndarray) -> str:
    """Numbers (parameters,) with the names and units of parameters, ``mass 0.1 kg, angle 2e-05``."""
    pairs = zip(parameters, values, strict=True)
    return ", ".join(f"{item.name} {value:.2g} {item.unit}".rstrip() for item, value in pairs)


def separated(rows: np.ndarray) -> np.ndarray:
    """Basis of the space of independent ``rows`` (n, parameters) in which each row has a pivot that no other row has,
    so that as few parameters as possible are part of each.

    >>> separated(np.array([[1.0, 1.0, 2.0, 2.0], [1.0, 1.0, -1.0, -1.0]])).round(12).tolist()
    [[0.0, 0.0, 1.0, 1.0], [1.0, 1.0, 0.0, 0.0]]
    """
    if not len(rows):
        return rows
    *_, pivots = linalg.qr(rows, mode="economic", pivoting=True)
    pivots = pivots[: len(rows)]
    return np.linalg.solve(rows[:, pivots], rows)


def members(move: np.ndarray, widths: np.ndarray) -> np.ndarray:
    """Numbers of the parameters that a move (parameters,) is made of."""
    parts = np.abs(move) / widths
    return np.flatnonzero(parts >= MEMBER * parts.max())


def moved(names: Sequence[str], move: np.ndarray, widths: np.ndarray) -> str:
    """A move (parameters,) in words, the largest one by a tenth of its width, the first one upward.

    >>> moved(["a", "b"], np.array([-2.0, 1.0]), np.array([2.0, 5.0]))
    "'a' by +0.2 and 'b' by -0.1"
    """
    named = members(move, widths)
    move = move * np.sign(move[named[0]]) * SHOWN / np.max(np.abs(move) / widths)
    return listed([f"{names[k]!r} by {move[k]:+.3g}" for k in named])
