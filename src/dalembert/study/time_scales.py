"""Whether the sampling of a study's data suits the time scales of its model."""

from collections.abc import Iterator

from dalembert.errors import DalembertError
from dalembert.findings import Finding
from dalembert.study.study import Study


def time_scale_findings(study: Study) -> Iterator[Finding]:
    """Yield a finding where the times of data are probably in another unit, from a short simulation for each record.

    A simulation that fails has no finding: what follows the check reports it.
    """
    if not study.has_system or study.task not in ("identify", "sample", "regularise"):
        return
    from dalembert.inverse.experiments.suspect_times import first_times, time_unit_findings

    records = [(study.variant(table), table) for table in study.file.experiments]
    records += [] if study.file.data is None else [(study, study.file.data)]
    for varied, table in records:
        data = table.read()
        times = first_times(data)
        if data.coordinate.unit != "s" or not times[-1] > 0:
            continue
        try:
            responses = varied.forward(data.channels, times).evaluate(varied.parameters.start[None])
        except DalembertError:
            continue
        if responses.failures[0] is None:
            yield from time_unit_findings(data, times, responses.values[0])
