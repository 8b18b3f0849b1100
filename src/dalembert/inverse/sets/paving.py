"""Boxes in, out of, and on the boundary of the set where a polynomial keeps between limits."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from dalembert.data.record import TURN
from dalembert.surrogate import ChebyshevPolynomial, bounds

AS_THEY_ARE = 1e9  # a gap that no Bernstein coefficients leave, so that boxes are halved by the paving alone


@dataclass(frozen=True, eq=False)
class Limits:
    """A polynomial, known to ``error``, is to keep within ``radius`` of ``middle``, all (outputs,).

    An output whose middle is NaN has no limits; one that ``wraps`` (mask (outputs,)) counts modulo a turn.
    """

    middle: np.ndarray
    radius: np.ndarray
    error: np.ndarray
    wraps: np.ndarray | None = None

    def judge(self, low: np.ndarray, high: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Which boxes (boxes,) keep the limits, and which leave them, from bounds (boxes, outputs) on them. Of a
        wrapping output the whole turn next to the middle of its bounds decides: bounds that reach to another one reach
        to this one, too.
        """
        low, high = low - self.middle, high - self.middle
        if self.wraps is not None:
            turns = np.where(self.wraps, TURN * np.rint((low + high) / 2 / TURN), 0.0)
            low, high = low - turns, high - turns
        free = np.isnan(self.middle)
        surely, perhaps = self.radius - self.error, self.radius + self.error
        kept = np.all(free | ((low >= -surely) & (high <= surely)), axis=1)
        return kept, np.any((low > perhaps) | (high < -perhaps), axis=1)


@dataclass(frozen=True, eq=False)
class Paving:
    """Boxes (boxes, 2, d) inside and on the boundary; not ``finished`` if there were too many to look at."""

    inside: np.ndarray
    boundary: np.ndarray
    finished: bool

    @property
    def hull(self) -> tuple[np.ndarray, np.ndarray] | None:
        """Corners (d,), (d,) of the smallest box around all of them; None if there is none."""
        boxes = np.concatenate([self.inside, self.boundary])
        return (boxes[:, 0].min(axis=0), boxes[:, 1].max(axis=0)) if len(boxes) else None


def pave(
    polynomial: ChebyshevPolynomial,
    limits: Limits,
    resolution: float,
    most_boxes: int,
    tell: Callable[[int, int, int], None] = lambda inside, boundary, waiting: None,
) -> Paving:
    """Return a paving of the points in the polynomial's box at which it keeps its limits, by branch and prune. A box is
    outside where a Bernstein enclosure leaves the limits by more than the error, inside where it keeps them by more
    than the error, and halved otherwise. ``resolution``: boxes are halved until their sides are no longer than this
    part of the polynomial's box; ``most_boxes``: boxes to look at; ``tell``: called with the numbers of boxes inside,
    on the boundary and waiting, after each halving.
    """
    size = polynomial.upper - polynomial.lower
    boxes = np.stack([polynomial.lower, polynomial.upper])[None]
    inside, boundary, looked = [boxes[:0]], [boxes[:0]], 0
    finished = True
    while len(boxes):
        looked += len(boxes)
        low, high = enclosures(polynomial, boxes)
        within, out = limits.judge(low, high)
        inside.append(boxes[within & ~out])
        boxes = boxes[~within & ~out]
        sides = (boxes[:, 1] - boxes[:, 0]) / size
        small = np.all(sides <= resolution * (1 + 1e-9), axis=1)
        boundary.append(boxes[small])
        boxes = boxes[~small]
        if looked + 2 * len(boxes) > most_boxes:
            boundary.append(boxes)
            finished = False
            break
        # Both halves of the boxes (n, 2, d) along these directions (n,).
        along = np.argmax(sides[~small], axis=1)
        rows = np.arange(len(boxes))
        middle = boxes[rows, :, along].mean(axis=1)
        halves = np.repeat(boxes[None], 2, axis=0)
        halves[0, rows, 1, along] = middle
        halves[1, rows, 0, along] = middle
        boxes = np.moveaxis(halves, 0, 1).reshape(-1, *boxes.shape[1:])
        tell(sum(map(len, inside)), sum(map(len, boundary)), len(boxes))
    return Paving(np.concatenate(inside), np.concatenate(boundary), finished)


def enclosures(polynomial: ChebyshevPolynomial, boxes: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Bounds (boxes, outputs) twice, from Bernstein coefficients as they are: halving the boxes makes them sharp."""
    enclosure = bounds(polynomial, boxes[:, 0], boxes[:, 1], "bernstein", gap=AS_THEY_ARE)
    return enclosure.lower, enclosure.upper
