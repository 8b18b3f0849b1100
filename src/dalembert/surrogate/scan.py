"""Values of a polynomial at a grid in each of many boxes."""

from dataclasses import dataclass

import numpy as np
import scipy

from dalembert.surrogate.basis import chebyshev, products
from dalembert.surrogate.polynomial import ChebyshevPolynomial

# Points of the largest grid: more directions are scanned at as many points spread over box and sides.
MOST_POINTS = 20_000
FEWEST = 9  # points in each of up to three directions at low degrees, so that no valley beside another is overlooked
# Largest table of coefficients, absent terms as zeros, for which grids are evaluated direction by direction.
DENSE = 1_000_000


@dataclass(frozen=True)
class Scan:
    """Points of a scan relative to a box.

    Parameters
    ----------
    grid : array, shape (points, d)
        In [0, 1].
    sides : array of int, shape (d,) or (0,)
        Points in each direction, the last one fastest; none if they form no grid.
    """

    grid: np.ndarray
    sides: np.ndarray


def spread(polynomial: ChebyshevPolynomial, points: int | None) -> Scan:
    """Return points at which to scan: in each direction as many as asked for, or two more than the degree, at least
    FEWEST. Chebyshev points of the second kind, cos πj/(n − 1), both ends included; equidistant ones if a number is
    given. In too many directions for a grid: a Sobol sequence, half of its coordinates at the ends.
    """
    degrees = polynomial.degrees
    least = FEWEST if len(degrees) <= 3 else 0
    sides = np.where(degrees > 0, np.maximum(degrees + 2, least) if points is None else points, 1)
    if np.prod(sides.astype(float)) > MOST_POINTS:
        # Extremes of smooth functions in many directions are often on sides: a quarter of the coordinates at each end.
        sobol = scipy.stats.qmc.Sobol(2 * len(degrees), scramble=False).random_base2(12)
        place, end = sobol[:, : len(degrees)], sobol[:, len(degrees) :]
        return Scan(np.where(end < 0.25, 0.0, np.where(end < 0.5, 1.0, place)), np.empty(0, dtype=int))
    lines = [_line(n, points is not None) for n in sides]
    return Scan(np.stack(np.meshgrid(*lines, indexing="ij"), axis=-1).reshape(-1, len(lines)), sides)


def _line(points: int, even: bool) -> np.ndarray:
    """Points of one direction; a single one is the upper end."""
    if points == 1:
        return np.array([1.0])
    return np.linspace(0, 1, points) if even else np.sin(np.pi * np.arange(points) / (2 * (points - 1))) ** 2


def values(polynomial: ChebyshevPolynomial, scan: Scan, low: np.ndarray, high: np.ndarray) -> np.ndarray:
    """Values (boxes, outputs, points) at the points of a scan, of boxes (boxes, d) given in coordinates η."""
    degrees, outputs = polynomial.degrees, polynomial.coefficients.shape[1]
    if not len(scan.sides) or outputs * np.prod(degrees + 1.0) > DENSE:
        boxes = (chebyshev(a + scan.grid * (b - a), degrees) for a, b in zip(low, high, strict=True))
        return np.stack([(products(bases, polynomial.exponents) @ polynomial.coefficients).T for bases in boxes])
    grid = scan.grid.reshape(*scan.sides, -1)
    bases = []
    for k, number in enumerate(scan.sides):
        line = np.moveaxis(grid[..., k], k, 0).reshape(number, -1)[:, 0]
        eta = low[:, k, None] + line * (high - low)[:, k, None]
        bases.append(chebyshev(eta.reshape(-1, 1), degrees[[k]])[0].reshape(len(low), number, -1))
    return transformed(polynomial, bases)


def transformed(polynomial: ChebyshevPolynomial, bases: list[np.ndarray]) -> np.ndarray:
    """Coefficients taken to another basis, direction by direction: shape (boxes, outputs, Π n_k), the last one fastest.

    ``bases`` (d arrays (boxes, n_k, degrees_k + 1)): what each Chebyshev polynomial of a direction is in the new basis.
    """
    size, outputs = polynomial.degrees + 1, polynomial.coefficients.shape[1]
    boxes = len(bases[0])
    table = np.zeros((size[0], outputs, *size[1:]))
    table[polynomial.exponents[:, 0], :, *polynomial.exponents.T[1:]] = polynomial.coefficients
    # The first direction as one product for all boxes, the others box by box from the last one on.
    result = bases[0].reshape(-1, size[0]) @ table.reshape(size[0], -1)
    done = 1
    for k in range(len(size) - 1, 0, -1):
        result = bases[k][:, None] @ result.reshape(boxes, -1, size[k], done)
        done *= bases[k].shape[1]
    return result.reshape(boxes, -1, outputs, done).swapaxes(1, 2).reshape(boxes, outputs, -1)
