"""A large box within a union of boxes."""

import numpy as np

SEEDS = 8  # boxes of the union from which one is grown
GROWTHS = 10_000  # most steps of one growth


def inner_box(boxes: np.ndarray) -> np.ndarray | None:
    """Return the largest box (2, d) found in a union of boxes (n, 2, d) that meet only in their faces; None for no
    boxes. Grown from the largest of the boxes, and from the one nearest to the middle of all, either on all sides in
    turn by the smallest step, or along one direction as far as it goes and then on.
    """
    if not len(boxes):
        return None
    volumes = np.prod(boxes[:, 1] - boxes[:, 0], axis=1)
    middles = boxes.mean(axis=1)
    extent = np.ptp(boxes.reshape(-1, boxes.shape[2]), axis=0)
    centre = np.average(middles, axis=0, weights=volumes)
    central = np.argmin(np.sum(((middles - centre) / extent) ** 2, axis=1))
    seeds = [central, *np.argsort(-volumes, kind="stable")[:SEEDS]]
    d = boxes.shape[2]
    orders = [[list(range(d))], *([[k], [j for j in range(d) if j != k]] for k in range(d) if d > 1)]
    grown = [_grown(boxes, boxes[seed], order) for seed in seeds for order in orders]
    return max(grown, key=lambda box: float(np.prod(box[1] - box[0])))


def _grown(boxes: np.ndarray, seed: np.ndarray, order: list[list[int]]) -> np.ndarray:
    """The seed (2, d), grown within the union: first along the directions of the first group, then of the next."""
    step = np.min(boxes[:, 1] - boxes[:, 0], axis=0)
    box = seed.copy()
    for group in order:
        open_ = [(side, k) for k in group for side in (0, 1)]
        for _ in range(GROWTHS):
            for face in list(open_):
                side, k = face
                slab = box.copy()
                slab[1 - side, k] = box[side, k]
                slab[side, k] = box[side, k] + (2 * side - 1) * step[k]
                # The union covers the slab if the parts of the slab in the boxes add up to its volume.
                overlap = np.minimum(boxes[:, 1], slab[1]) - np.maximum(boxes[:, 0], slab[0])
                inner = np.prod(np.maximum(overlap, 0), axis=1).sum()
                if inner >= (1 - 1e-6) * np.prod(slab[1] - slab[0]):
                    box[side, k] = slab[side, k]
                else:
                    open_.remove(face)
            if not open_:
                break
    return box
