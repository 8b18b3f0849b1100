"""Points spread over a box, evenly in each direction."""

import numpy as np


def latin_hypercube(directions: int, points: int, rng: np.random.Generator) -> np.ndarray:
    """Return a random Latin hypercube in [0, 1), shape (points, directions). Each direction has one point in each of
    ``points`` equal intervals. The points are those of ``scipy.stats.qmc.LatinHypercube`` with the same generator;
    loading `scipy.stats` takes as long as a small study. Source: McKay, Beckman and Conover, Technometrics 21 (1979),
    239-245.
    """
    (rng,) = rng.spawn(1)  # as SciPy does
    within = rng.uniform(size=(points, directions))
    intervals = np.tile(np.arange(1, points + 1), (directions, 1))
    for row in intervals:
        rng.shuffle(row)
    return (intervals.T - within) / points
