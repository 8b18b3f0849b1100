"""All figures of a result."""

from typing import Any

import plotly.graph_objects as go

from dalembert.report.contents import Result, contents


def figures(result: Result, **options: Any) -> dict[str, go.Figure]:
    """Every figure that a report of the result would show, by name.

    Parameters
    ----------
    result : Fit, Trajectory, FrequencyCurve, Propagation, Comparison, BandFit, ParameterSet, Profiles …
    **options
        ``trajectory``, ``points``, ``truth``, ``profiles``, ``prediction``, ``dofs``, ``amplitude``,
        ``time_comparison``, ``backbone``, ``deformation`` and ``reduction``, as in :func:`dalembert.report.report`.

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
    return {plot.name: plot.figure for section in contents(result, **options) for plot in section.plots}
