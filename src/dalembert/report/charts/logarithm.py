"""Logarithmic axes that say decades, and nothing between them."""

from typing import Any

import numpy as np
import plotly.graph_objects as go

LABELS = 8


def positive(values: np.ndarray) -> np.ndarray:
    """Values for a logarithmic axis: NaN, a gap, where there is nothing to draw.

    Examples
    --------
    >>> positive(np.array([1e-3, 0.0, np.inf])).tolist()
    [0.001, nan, nan]
    """
    return np.where((values > 0) & np.isfinite(values), values, np.nan)


def logarithmic(figure: go.Figure, along: str = "y") -> dict[str, Any]:
    """Settings of a logarithmic axis: a label at every decade, or at every few, where the data span more than one."""
    traces: Any = figure.data
    series = [np.asarray(trace[along], dtype=float) for trace in traces]
    values = np.concatenate([*series, [np.nan]])
    values = np.log10(values[np.isfinite(values) & (values > 0)])
    span = float(np.ptp(values)) if len(values) else 0.0
    return {"type": "log", "dtick": max(1, int(np.ceil(span / LABELS)))} if span > 1 else {"type": "log"}
