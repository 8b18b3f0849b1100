"""Units of times that the response at the first guesses makes suspect."""

from collections.abc import Iterator, Sequence
from typing import Any

from dalembert.findings import Finding
from dalembert.inverse.identification.assess import Optimum
from dalembert.inverse.plausibility.suspect_times import time_findings


def time_units(optimum: Optimum) -> Iterator[Finding]:
    """Yield the findings on the times of the data, or on those of each experiment."""
    posed = optimum.posed
    joint: Any = posed.whole.model  # of experiments, it has their wiring
    vector = posed.problem.search.vectors(posed.first_point)
    if isinstance(posed.model, Sequence):
        for experiment, wiring in zip(posed.model, joint.wiring, strict=True):
            yield from time_findings(experiment.model, experiment.data, vector[wiring])
    elif posed.data is not None:
        yield from time_findings(posed.model, posed.data, vector)
