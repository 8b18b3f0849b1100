"""How large a part of a box the runs leave empty: what they cannot see."""

from dataclasses import dataclass

import numpy as np
from scipy.spatial import KDTree

PLACES = 1024  # random places at which an empty box is looked for
KEPT, ROUNDS = 16, 30  # places that are moved to where the empty box is larger, and how often


@dataclass(frozen=True)
class Gaps:
    """Parts of a box without a run."""

    # Side of the largest box without a run, as a part of the sides of the whole box, the same in each direction.
    all_together: float
    each: tuple[float, ...]  # largest distance between neighbouring runs along each direction, as a part of its side
    relative: float  # the same as ``all_together`` in units of the lengths over which the response varies


def gaps(eta: np.ndarray, lengths: np.ndarray | None = None) -> Gaps:
    """Return the gaps between runs at coordinates η (runs, f) in [−1, 1].

    Parameters
    ----------
    eta : array, shape (runs, f)
    lengths : array, shape (f,), optional
        Over which the response varies, as parts of the sides; 1 if not given.

    Examples
    --------
    >>> gaps(np.array([[-1.0], [0.0], [0.5], [1.0]]))
    Gaps(all_together=0.5, each=(0.5,), relative=0.5)
    """
    f = eta.shape[1]
    each = tuple(float(np.diff(np.unique(np.concatenate([[-1.0, 1.0], column]))).max() / 2) for column in eta.T)
    together = each[0] if f == 1 else _largest_empty(eta, np.ones(f))
    scaled = np.ones(f) if lengths is None else np.minimum(lengths, 1.0)
    if np.all(scaled == scaled[:1]):
        return Gaps(together, each, together / float(scaled[0]))
    return Gaps(together, each, _largest_empty(eta, scaled))


def _largest_empty(eta: np.ndarray, sides: np.ndarray) -> float:
    """Return the largest t such that a box of sides t · ``sides`` (f,), as parts of the whole box, holds no run.

    By a search from random places: at each, the largest box around it that holds no run and does not leave the whole
    one. Larger ones may exist; they are rare.
    """
    f = len(sides)
    tree = KDTree(eta / sides)

    def size(middles: np.ndarray) -> np.ndarray:
        # In the maximum norm the distance to the nearest run is half the side of the largest empty box around a place.
        to_runs = np.asarray(tree.query(middles / sides, p=np.inf)[0])
        return np.minimum(to_runs, np.min((1 - np.abs(middles)) / sides, axis=1))

    random = np.random.default_rng(0)
    places = random.uniform(-1, 1, (PLACES, f))
    largest = size(places)
    best = np.argsort(-largest, kind="stable")[:KEPT]
    places, largest = places[best], largest[best]
    for turn in range(ROUNDS):
        # Random moves whose reach halves every six rounds: cheaper than a Voronoi diagram, which grows fast with the
        # directions.
        reach = largest[:, None] * sides * 0.5 ** (turn / 6)
        moved = np.clip(places + reach * random.uniform(-1, 1, places.shape), -1, 1)
        larger = size(moved)
        better = larger > largest
        places[better], largest[better] = moved[better], larger[better]
    return float(largest.max())
