"""A growing set of terms, each with its run, closed downwards: with a term, all of lower degrees are there."""

import numpy as np

from dalembert.surrogate.basis import powers_of_two
from dalembert.surrogate.leja import hierarchical, leja

Term = tuple[int, ...]
# Part of a surplus that is expected two degrees on, where the one between them is smaller: symmetry makes zeros.
SKIPPED = 0.3
TOGETHER = 0.2  # terms whose expected size is at least this part of the largest one are run in one batch


class Growth:
    """Terms, their surpluses, and the candidates to be next; ``basis`` as in :class:`dalembert.surrogate.Adaptive`."""

    def __init__(self, directions: int, basis: str) -> None:
        self.directions, self.basis = directions, basis
        self.terms: list[Term] = []
        self._exponents = np.empty((0, directions), dtype=int)
        self._surpluses = np.empty((0, 0))
        self._surplus: dict[Term, np.ndarray] = {}
        self._candidates: dict[Term, np.ndarray | None] = {(0,) * directions: None}
        self._orders = np.zeros(directions, dtype=int)
        self._ratio = 1.0

    def batch(self, scale: np.ndarray | None, most: int, stalled: int) -> list[Term]:
        """Return the next terms, at most ``most``, the ones expected to be largest relative to ``scale`` first.
        ``stalled`` counts the batches since the held-out runs show an error where nothing large is expected any more. A
        symmetry hides it, as that of e^{xy} does, which has no terms but (k, k): then any large surplus nearby counts,
        and in every other batch the lowest degrees, as sin² 3x vanishes at all of the first points.
        """
        if scale is None:
            return self._start()[:most]
        candidates = sorted(self._candidates)
        if stalled and stalled % 2 == 0:
            lowest = min(map(sum, candidates))
            return [term for term in candidates if sum(term) == lowest][:most]
        sizes = map(self._nearby if stalled else self._expected, candidates)
        expected = np.array([np.max(size / np.where(scale > 0, scale, 1)) for size in sizes])
        chosen = self._chosen(candidates, expected)
        order = np.argsort(-expected[chosen], kind="stable")
        return [candidates[i] for i in np.flatnonzero(chosen)[order]][:most]

    def _start(self) -> list[Term]:
        """Degrees zero, one and two of each direction."""
        unit = np.eye(self.directions, dtype=int)
        return [tuple(row) for row in np.concatenate([0 * unit[:1], unit, 2 * unit]).tolist()]

    def _chosen(self, candidates: list[Term], expected: np.ndarray) -> np.ndarray:
        # "sparse" takes what is promising, "total-degree" the lowest degree, "tensor" a box of degrees that grows where
        # it promises most.
        terms = np.array(candidates)
        promising = expected >= TOGETHER * expected.max()
        if self.basis == "sparse":
            return promising
        if self.basis == "total-degree":
            return terms.sum(axis=1) == terms.sum(axis=1).min()
        inside = np.all(terms <= self._orders, axis=1)
        if not inside.any():
            self._orders = np.maximum(self._orders, terms[promising].max(axis=0))
            inside = np.all(terms <= self._orders, axis=1)
        return inside

    def points(self, batch: list[Term]) -> np.ndarray:
        """Coordinates η of terms, shape (terms, directions)."""
        places = np.array(batch)
        return leja(int(places.max()) + 1)[places]

    def add(self, batch: list[Term], values: np.ndarray) -> None:
        """Terms with the outputs (terms, outputs) of their runs."""
        sizes: list[tuple[float, float]] = []
        # A term is foretold by terms below it alone, so the order within a batch is that of degrees.
        for term, value in sorted(zip(batch, values, strict=True), key=lambda pair: sum(pair[0])):
            expected = self._candidates.pop(term, None)
            # Newton's form on Leja points: h_e vanishes at all points before its own, so a surplus is final once it is
            # known.
            surplus = value - self._foretold(term, len(value))
            self._append(term, surplus)
            # How far expectations were right in this batch scales the estimate of the tail.
            if expected is not None and expected.any():
                sizes.append((float(np.sum(np.abs(surplus))), float(np.sum(expected))))
            self._admit(term)
        if sizes:
            largest, foreseen = np.sum(sizes, axis=0)
            self._ratio = min(largest / foreseen, 1.0)

    def _append(self, term: Term, surplus: np.ndarray) -> None:
        """Store a term; the arrays double when they are full."""
        known = len(self.terms)
        if known == len(self._exponents):
            more = ((0, max(64, known)), (0, 0))
            self._exponents = np.pad(self._exponents, more)
            self._surpluses = np.pad(self._surpluses.reshape(known, len(surplus)), more)
        self._exponents[known], self._surpluses[known] = term, surplus
        self._surplus[term] = surplus
        self.terms.append(term)

    def _foretold(self, term: Term, outputs: int) -> np.ndarray:
        """Value at the point of a term of the polynomial so far, shape (outputs,)."""
        if not self.terms:
            return np.zeros(outputs)
        exponents = self._exponents[: len(self.terms)]
        table = hierarchical(int(max(exponents.max(), *term)) + 1)[0]
        # Π_k h_{e_k}(ζ_{t_k}): zero unless e ≤ t in all directions, so few terms count.
        weights = np.prod(table[exponents, np.array(term)], axis=1)
        below = np.flatnonzero(weights)
        return weights[below] @ self._surpluses[below]

    def since(self, first: int) -> tuple[np.ndarray, np.ndarray]:
        """Return exponents (terms, directions) and surpluses (terms, outputs) of the terms from number ``first`` on."""
        return self._exponents[first : len(self.terms)], self._surpluses[first : len(self.terms)]

    def _admit(self, term: Term) -> None:
        """Makes candidates of the terms above one, where nothing is missing below them."""
        for above in (_raised(term, k, 1) for k in range(self.directions)):
            # Downward closed (Gerstner & Griebel 2003): a term needs all of its lower neighbours, else interpolation is
            # not unique.
            below = [_raised(above, k, -1) for k in range(self.directions) if above[k]]
            if above not in self._surplus and all(entry in self._surplus for entry in below):
                self._candidates[above] = None

    def _expected(self, term: Term) -> np.ndarray:
        """Expected magnitude of the surplus of a candidate, shape (outputs,)."""
        known = self._candidates[term]
        if known is None:
            sizes = []
            for k in range(self.directions):
                if term[k]:
                    size = np.abs(self._surplus[_raised(term, k, -1)])
                    # Odd or even functions have zero surpluses at every other degree: the one before it counts in part.
                    if term[k] > 2 or (term[k] > 1 and sum(term) > term[k]):
                        size = np.maximum(size, SKIPPED * np.abs(self._surplus[_raised(term, k, -2)]))
                    sizes.append(size)
            known = self._candidates[term] = _geometric_mean(np.array(sizes))
        return known

    def _nearby(self, term: Term) -> np.ndarray:
        """Largest surplus (outputs,) one degree or, in part, two degrees below a candidate, in whichever directions."""
        below = [_raised(term, k, -1) for k in range(self.directions) if term[k]]
        further = [_raised(entry, k, -1) for entry in below for k in range(self.directions) if entry[k]]
        sizes = [np.abs(self._surplus[entry]) for entry in below]
        return np.max([*sizes, *(SKIPPED * np.abs(self._surplus[entry]) for entry in further)], axis=0)

    def tail(self) -> np.ndarray:
        """Estimate of what the terms left out would add, shape (outputs,)."""
        # The margin of the set of terms stands for all that is left out: what is further out is smaller by another
        # factor.
        expected = np.array([self._expected(term) for term in self._candidates])
        return self._ratio * np.sum(expected, axis=0)

    def polynomial(self) -> tuple[np.ndarray, np.ndarray]:
        """Exponents (terms, directions) and Chebyshev coefficients (terms, outputs)."""
        exponents, surpluses = self.since(0)
        order = np.lexsort(exponents.T[::-1])
        exponents, surpluses = exponents[order], surpluses[order]
        series = hierarchical(int(exponents.max()) + 1)[1]
        # From h to T in each direction; the product of the tables is the matrix of all terms.
        matrix = np.ones((len(exponents), len(exponents)))
        for k in range(self.directions):
            matrix *= series[exponents[:, None, k], exponents[None, :, k]]
        return exponents, matrix.T @ surpluses


def _raised(term: Term, direction: int, by: int) -> Term:
    return (*term[:direction], term[direction] + by, *term[direction + 1 :])


def _geometric_mean(sizes: np.ndarray) -> np.ndarray:
    """Geometric means of magnitudes (count, outputs), whose products may exceed the largest number."""
    with np.errstate(over="ignore"):
        product = np.prod(sizes, axis=0)
    if np.all(np.isfinite(product)):
        return product ** (1 / len(sizes))
    powers = powers_of_two(sizes)
    return np.ldexp(np.prod(np.ldexp(sizes, -powers), axis=0) ** (1 / len(sizes)), powers)
