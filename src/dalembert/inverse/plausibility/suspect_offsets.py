"""Channels whose data are suspected to have another zero than the response."""

from collections.abc import Iterator

import numpy as np

from dalembert.data import Measurements
from dalembert.findings import Finding
from dalembert.forward import ForwardModel
from dalembert.inverse.noise.correlation.series import series_of
from dalembert.inverse.plausibility.suspect_units import suspect_units, unit_finding
from dalembert.inverse.plausibility.without_outliers import without_outliers
from dalembert.inverse.problem.journal import Journal
from dalembert.inverse.problem.problem import MisfitProblem, pose

FAR = 0.6
"""Difference of the means, as a part of the larger range, from which a zero is suspected.

Motions in opposite directions from the same place differ by at most a half.
"""


def first_findings(model: ForwardModel, data: Measurements) -> tuple[Finding, ...]:
    """Return the units and zeros that the response at the first guesses makes suspect, from one simulation."""
    problem = pose(model, data, None, Journal(len(data.coordinate.values)))
    response = problem.responses(model.parameters.start[None])[0]
    units = suspect_units(problem, response)
    judged = {suspect.channel for suspect in units}
    return (*map(unit_finding, units), *_offsets(problem, response, judged))


def _offsets(problem: MisfitProblem, response: np.ndarray, judged: set[str]) -> Iterator[Finding]:
    """Yield findings on channels, other than those whose unit is suspected, whose means differ much."""
    units = {channel.name: channel.unit for channel in problem.model.channels}
    for series in series_of(problem):
        rows, columns = np.divmod(series.rows, response.shape[1])
        data, computed = without_outliers(problem.data.continuous[rows, columns], response[rows, columns])
        difference, span = float(np.mean(data) - np.mean(computed)), max(np.ptp(data), np.ptp(computed))
        if series.name in judged or problem.data.wrapping[columns[0]] or not abs(difference) > FAR * span > 0:
            continue
        lower, upper = (float(f"{end:.3g}") for end in (difference - span / 2, difference + span / 2))
        values = {"channel": series.name, "difference": difference, "lower": lower, "upper": upper}
        yield Finding(
            "suspect-offset",
            "warning",
            values,
            f"The mean of the data of {series.name!r} is {np.mean(data):.3g} {units.get(series.name, '')}, and that of "
            f"the response at the first guesses is {np.mean(computed):.3g}; both vary by at most {span:.3g}.",
            "Check the zero and the direction of the sensor. If the zero is not known, estimate the offset: "
            f'[sensors."{series.name}"] offset = [{lower:g}, {upper:g}].',
        )
