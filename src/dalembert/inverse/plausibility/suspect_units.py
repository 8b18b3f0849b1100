"""Channels whose data are suspected to be in another unit than the response."""

from dataclasses import dataclass
from itertools import islice

import numpy as np

from dalembert.data import Measurements
from dalembert.findings import Finding
from dalembert.forward import ForwardModel
from dalembert.inverse.noise.correlation.series import Series, series_of
from dalembert.inverse.plausibility.without_outliers import without_outliers
from dalembert.inverse.problem.journal import Journal
from dalembert.inverse.problem.problem import MisfitProblem, pose

PREFIX, ANGLE = 1e3, 180 / np.pi
"""Usual factors between units: a metric prefix, such as mm and m, and degrees for radians."""

TOLERATED = {PREFIX: 4.0, 1 / PREFIX: 4.0, ANGLE: 3.0, 1 / ANGLE: 3.0}
"""Largest quotient of a ratio and a factor, either way, at which the factor is suspected."""

FLAT = 1e-9
"""Range of a channel, as a part of its largest value, below which it is constant but for rounding."""

ROUGH = 1.5
"""Mean square of successive differences over the variance from which data are mostly noise: white noise has 2."""


@dataclass(frozen=True)
class SuspectUnit:
    """A channel whose data vary by a usual factor more, or less, than the response."""

    channel: str
    factor: float  # about what the ratio is: 1000, 57.3, or the inverse of one of them
    ratio: float  # range of the data over that of the response

    @property
    def question(self) -> str:
        """What may be wrong, as a question."""
        if self.factor in (PREFIX, 1 / PREFIX):
            return "Is a metric prefix wrong, such as mm for m?"
        return "Are the data in degrees?" if self.factor > 1 else "Were data in radians converted from degrees?"


def suspect_units(problem: MisfitProblem, response: np.ndarray) -> tuple[SuspectUnit, ...]:
    """Return the channels whose ranges differ by a usual factor from those of a response (samples, channels).

    Channels that are constant but for rounding, and data that are mostly noise, are not judged.
    """
    units = {channel.name: channel.unit for channel in problem.model.channels}
    suspects = []
    for series in series_of(problem):
        ratio = _ratio(problem, response, series)
        factors = (factor for factor in _factors(units.get(series.name, "")) if is_like(ratio, factor))
        suspects += [SuspectUnit(series.name, factor, ratio) for factor in islice(factors, 1)]
    return tuple(suspects)


def first_unit_findings(model: ForwardModel, data: Measurements) -> tuple[Finding, ...]:
    """Return the units that the response at the first guesses makes suspect, from one simulation."""
    problem = pose(model, data, None, Journal(len(data.coordinate.values)))
    response = problem.responses(model.parameters.start[None])[0]
    return tuple(unit_finding(suspect) for suspect in suspect_units(problem, response))


def unit_finding(suspect: SuspectUnit, changed: str = "") -> Finding:
    """Return the finding on a suspected unit; ``changed`` is the parameter that makes up for it."""
    values = {"channel": suspect.channel, "ratio": suspect.ratio, "factor": suspect.factor, "parameter": changed}
    absorbed = f" The fit changes {changed!r} by such a factor to make up for it." if changed else ""
    message = (
        f"The data of {suspect.channel!r} vary {suspect.ratio:.3g} times as much as the response at the first guesses. "
        f"{suspect.question}{absorbed}"
    )
    advice = "Give the unit of the column in units. If the unit is right, start closer to the true values."
    return Finding("suspect-unit", "warning", values, message, advice)


def _ratio(problem: MisfitProblem, response: np.ndarray, series: Series) -> float:
    """Range of a channel's data over that of the response; NaN where one of them says nothing."""
    rows, column = np.divmod(series.rows, response.shape[1])
    column = column[0]
    data, computed = problem.data.continuous[rows, column], response[rows, column]
    if problem.data.wrapping[column]:
        computed = np.unwrap(computed)
    data, computed = without_outliers(data, computed)
    ranges = np.array([np.ptp(data), np.ptp(computed)])
    if np.any(ranges <= FLAT * np.array([np.max(np.abs(data)), np.max(np.abs(computed))])):
        return np.nan
    if np.mean(np.diff(data) ** 2) > ROUGH * np.var(data):
        return np.nan
    return float(ranges[0] / ranges[1])


def _factors(unit: str) -> tuple[float, ...]:
    """Factors that may lie between the data and a response in a unit."""
    angles = (ANGLE, 1 / ANGLE) if unit.split("/")[0] == "rad" else ()
    return (*angles, PREFIX, 1 / PREFIX)


def is_like(ratio: float, factor: float) -> bool:
    """Whether a ratio is about a factor."""
    return 1 / TOLERATED[factor] < ratio / factor < TOLERATED[factor]
