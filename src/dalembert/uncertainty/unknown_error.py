"""Why the error of bounds from runs alone is unknown, as a finding."""

from collections.abc import Mapping
from typing import Any

import numpy as np

from dalembert.findings import Finding
from dalembert.surrogate.unseen import unseen_between
from dalembert.uncertainty.runs import Runs


def unknown_error(runs: Runs, points: np.ndarray, reason: str, values: Mapping[str, Any], advice: str = "") -> Finding:
    """Return the finding "unknown-error" of bounds that runs at ``points`` (n, parameters) of the box reach.
    ``reason``: what the method has instead, in a sentence; ``values``: its numbers.
    """
    message, gaps = f"The error of the bounds is unknown. {reason}", {}
    if len(runs.free):
        box, free = runs.box, runs.free
        eta = ((points - box.middle) / np.where(box.radius > 0, box.radius, 1.0))[:, free]
        sentence, gaps = unseen_between(np.clip(eta, -1, 1), [box.names[k] for k in free])
        message = f"{message} {sentence}"
    return Finding("unknown-error", "note", {**values, **gaps}, message, advice)


def share_of(part: np.ndarray, lower: np.ndarray, upper: np.ndarray) -> float:
    """Return the largest of parts (samples, channels) relative to the widest band of their channel; zero without any.
    >>> share_of(np.array([[0.5]]), np.zeros((1, 1)), np.ones((1, 1)))
    0.5
    """
    width = np.max(upper - lower, axis=0) * np.ones_like(part)
    return float(np.max(np.divide(part, width, out=np.zeros_like(part), where=width > 0), initial=0.0))
