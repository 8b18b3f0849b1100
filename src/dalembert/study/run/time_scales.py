"""Whether the times of a study's data suit the time scales of its model."""

from collections.abc import Iterator

from dalembert.errors import DalembertError
from dalembert.findings import Finding
from dalembert.study.tables.study import Study


def time_scale_findings(study: Study) -> Iterator[Finding]:
    """Yield a finding where the times of data are probably in another unit, from short simulations for each record.

    A simulation that fails has no finding: what follows the check reports it.
    """
    if not study.has_system or study.task not in ("identify", "sample", "regularise"):
        return
    from dalembert.inverse.experiments.suspect_times import time_findings

    records = [(study.variant(table), table) for table in study.file.experiments]
    records += [] if study.file.data is None else [(study, study.file.data)]
    for varied, table in records:
        data = table.read()
        try:
            model = varied.forward(data.channels, data.coordinate.values)
        except DalembertError:
            continue
        yield from time_findings(model, data, model.parameters.start)
