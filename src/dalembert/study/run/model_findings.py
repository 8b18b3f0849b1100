"""Findings about the model and the data of a study, which do not depend on a result."""

from collections.abc import Iterator

from dalembert.errors import DalembertError
from dalembert.findings import Finding
from dalembert.study.tables.study import Study
from dalembert.study.tables.unused import few, unused_parameters
from dalembert.study.tasks import TASKS
from dalembert.study.tasks.requirements import needs_robot

_BATCHES = ("propagate", "sample", "sweep", "global_sensitivity", "identify_set", "identify_bands")
"""Tasks that evaluate many samples at once."""


def model_findings(study: Study) -> tuple[Finding, ...]:
    """Return the findings about the mechanism of a study: what the import of a robot left out, elements that lock."""
    unused = _unused(study)
    robot = study.file.model.robot_table
    if robot is not None and needs_robot in TASKS[study.task].needs:  # the task makes no mechanism of the robot
        return (*unused, *robot.tree.findings)
    return (*unused, *_one_by_one(study), *(study.system().findings if study.has_system else ()))


def _unused(study: Study) -> tuple[Finding, ...]:
    names = unused_parameters(study.file)
    if not names:
        return ()
    message = f"No number of the model depends on {few(names)}."
    advice = "Use each parameter in the model, or remove it from [parameters]."
    return (Finding("unused-parameters", "warning", {"parameters": ", ".join(names)}, message, advice),)


def _one_by_one(study: Study) -> tuple[Finding, ...]:
    """Return the finding about a component because of which samples cannot run side by side."""
    if study.task not in _BATCHES or not study.has_system or not study.solver.takes_lanes:
        return ()
    from dalembert.multibody.model.lane_models import prevents_lanes
    from dalembert.multibody.model.lowering import lower

    name = prevents_lanes(lower(study.system()))
    if not name:
        return ()
    message = f"The samples run one by one, because {name!r} cannot take eight at once."
    advice = "Results do not depend on this. A study without this component takes less time."
    return (Finding("samples-one-by-one", "note", {"component": name}, message, advice),)


def model_lines(study: Study) -> Iterator[str]:
    """Yield the findings about the model for a terminal."""
    for finding in model_findings(study):
        yield f"{finding.severity.capitalize()}: {finding}"


def time_scale_findings(study: Study) -> Iterator[Finding]:
    """Yield a finding where the times of data are probably in another unit, from short simulations for each record.

    A simulation that fails has no finding: what follows the check reports it.
    """
    if not study.has_system or study.task not in ("identify", "sample", "regularise"):
        return
    from dalembert.inverse.plausibility.suspect_times import time_findings

    records = [(study.variant(table), table) for table in study.file.experiments]
    records += [] if study.file.data is None else [(study, study.file.data)]
    for varied, table in records:
        data = table.read()
        try:
            model = varied.forward(data.channels, data.coordinate.values)
        except DalembertError:
            continue
        yield from time_findings(model, data, model.parameters.start)
