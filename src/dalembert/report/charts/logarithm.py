"""Logarithmic axes that say decades, and 2 and 5 between them where there are few."""

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
    """Settings of a logarithmic axis: a label at every decade or few; at 2 and 5 too where there are few."""
    traces: Any = figure.data
    series = [np.asarray(trace[along], dtype=float) for trace in traces]
    values = np.concatenate([*series, [np.nan]])
    values = np.log10(values[np.isfinite(values) & (values > 0)])
    span = float(np.ptp(values)) if len(values) else 0.0
    if span <= 1:
        return {"type": "log"}
    if span < 2:
        decades = range(int(np.floor(values.min())) - 1, int(np.ceil(values.max())) + 2)
        return {"type": "log", "tickvals": [float(f"{step}e{decade}") for decade in decades for step in (1, 2, 5)]}
    return {"type": "log", "dtick": max(1, int(np.ceil(span / LABELS)))}
