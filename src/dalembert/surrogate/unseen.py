"""Which features of a function its surrogate cannot exclude, as a finding: how large a part of a box has no run."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.spatial import KDTree

from dalembert.findings import Finding
from dalembert.surrogate.basis import powers_of_two
from dalembert.surrogate.surrogate import Surrogate

# Part of the scale below which an output does not count for the lengths over which the response varies.
SIGNIFICANT = 0.1
PLACES = 1024  # random places at which an empty box is looked for
KEPT, ROUNDS = 16, 30  # places that are moved to where the empty box is larger, and how often
FEATURE = "bump, pit or step"


@dataclass(frozen=True)
class Gaps:
    """Parts of a box without a run."""

    # Side of the largest box without a run, as a part of the sides of the whole box, the same in each direction.
    all_together: float
    each: tuple[float, ...]  # largest distance between neighbouring runs along each direction, as a part of its side
    relative: float  # the same as ``all_together`` in units of the lengths over which the response varies


def unseen(surrogate: Surrogate, names: Sequence[str]) -> Finding:
    """Return the finding "unseen-features": the width below which a feature can lie between the runs.

    ``names`` sequence of str, of length d: of the directions.
    """
    polynomial = surrogate.polynomial
    free = np.flatnonzero(polynomial.upper > polynomial.lower)
    if not len(free):
        return Finding("unseen-features", "note", {"gap": 0.0}, "The box has no width.")
    empty = gaps(polynomial.eta(surrogate.points)[:, free], variation_lengths(surrogate)[free])
    message, values = _described(empty, [names[int(k)] for k in free], surrogate.runs)
    if not surrogate.tested:
        message += " No held-out run tested the surrogate."
        return Finding("unseen-features", "warning", values, message, "Set held_out to at least 10.")
    if empty.relative > 1:
        message += " The response varies over shorter lengths than that."
        return Finding("unseen-features", "warning", values, message, "Increase held_out, or make the box smaller.")
    return Finding("unseen-features", "note", values, message, "Increase held_out if the response may have one.")


def unseen_between(eta: np.ndarray, names: Sequence[str]) -> tuple[str, dict[str, float | int]]:
    """Return the sentence and the values for runs at coordinates η (runs, f) of named directions."""
    return _described(gaps(eta), names, len(eta))


def variation_lengths(surrogate: Surrogate) -> np.ndarray:
    """Return half a wave of the response along each direction as a part of its side, shape (d,); at most 1. T_n has n
    half waves. Of each output that matters the mean degree √(Σ e_k² c² / Σ c²) counts, and of all outputs the largest.
    """
    polynomial = surrogate.polynomial
    varying = polynomial.exponents.any(axis=1)
    exponents, coefficients = polynomial.exponents[varying], polynomial.coefficients[varying]
    powers = powers_of_two(coefficients)  # the squares of large outputs would overflow
    squares = np.ldexp(coefficients, -powers) ** 2
    total = squares.sum(axis=0)
    matters = np.sqrt(total) > np.ldexp(SIGNIFICANT * surrogate.scale / 2, -powers)
    if not matters.any():
        return np.ones(len(polynomial.lower))
    degrees = np.sqrt((exponents**2).T @ squares[:, matters] / total[matters])
    return 1 / np.maximum(degrees.max(axis=1), 1.0)


def _described(empty: Gaps, names: Sequence[str], runs: int) -> tuple[str, dict[str, float | int]]:
    """Return a sentence on gaps and values of a finding, as parts of the intervals."""
    each = dict(zip(names, empty.each, strict=True))
    values = {f"gap of {name}": part for name, part in each.items()}
    values = {"gap": empty.all_together, **values, "gap in lengths of variation": empty.relative, "runs": runs}
    if len(names) == 1:
        interval = f"{_part(empty.each[0])} of the interval of {names[0]!r}"
        return f"{runs} runs cannot exclude a {FEATURE} narrower than {interval}.", values
    parts = ", ".join(f"{_part(part)} of {name!r}" for name, part in each.items())
    sentence = (
        f"{runs} runs cannot exclude a {FEATURE} narrower than {_part(empty.all_together)} of every interval, or in a "
        f"single parameter narrower than {parts}."
    )
    return sentence, values


def _part(share: float) -> str:
    return f"{float(f'{100 * share:.2g}'):g} %"


def gaps(eta: np.ndarray, lengths: np.ndarray | None = None) -> Gaps:
    """Return the largest gaps between runs at coordinates η (runs, f) in [−1, 1].

    Each is a part of the side 2: ``each`` the largest distance of neighbours in one coordinate, ``all_together`` the
    side of the largest empty cube, ``relative`` its ratio to the correlation length.

    Parameters
    ----------
    eta : array, shape (runs, f)
    lengths : array, shape (f,), optional
        Correlation length of the response along each coordinate, as a part of the side; 1 if not stated.

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
    """Return the largest t such that a box of sides t · ``sides`` (f,), as parts of the whole box, holds no run. By a
    search from random places: at each, the largest box around it that holds no run and does not leave the whole one.
    Larger ones may exist; they are rare.
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
