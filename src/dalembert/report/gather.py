"""All figures of a result."""

from typing import Any

import plotly.graph_objects as go

from dalembert.report.asked import asked
from dalembert.report.contents import contents


def figures(result: object, *beside: object, **options: Any) -> dict[str, go.Figure]:
    """Every figure that a report of the result would show, by name.

    Parameters
    ----------
    result : Fit, Trajectory, FrequencyCurve, Propagation, Comparison, BandFit, ParameterSet, Profiles …
    *beside, **options
        As in :func:`dalembert.report.report`.

    Returns
    -------
    dict of str to plotly.graph_objects.Figure
        For a fit ``"parameters"``, ``"responses-1"``, ``"convergence"``, ``"correlation"`` …, from response
        sensitivity ``"l-curve"`` and ``"steps"``, from multiple shooting ``"gaps"`` too, for a trajectory
        ``"mechanism"``, ``"energies"``, ``"violations"``, ``"newton"``, for bounds ``"bands-1"`` …, for methods
        compared ``"methods"`` and ``"differences"`` too, for intervals from bands ``"intervals"``,
        ``"residual-bands-1"`` …, for a set ``"paving-1"`` …, for a sweep ``"sweep-1"`` …, for profiles
        ``"profile-1"`` …, for a prediction ``"prediction-1"`` …, for designs ``"ranking"`` and ``"horizons"``, for a
        response over frequency ``"frequency-curve"``, ``"hysteresis"``, ``"contact-states"``, ``"harmonic-content"`` ….

    Raises
    ------
    InputError
        For a result that is none of these.
    """
    return {plot.name: plot.figure for section in contents(result, asked(beside, **options)) for plot in section.plots}
