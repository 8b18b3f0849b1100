"""Findings about the model of a study, which do not depend on a result."""

from collections.abc import Iterator

from dalembert.findings import Finding
from dalembert.study.tables.study import Study
from dalembert.study.tables.unused import few, unused_parameters
from dalembert.study.tasks import TASKS
from dalembert.study.tasks.requirements import needs_robot


def model_findings(study: Study) -> tuple[Finding, ...]:
    """Return the findings about the mechanism of a study: what the import of a robot left out, elements that lock."""
    unused = _unused(study)
    robot = study.file.model.robot_table
    if robot is not None and needs_robot in TASKS[study.task].needs:  # the task makes no mechanism of the robot
        return (*unused, *robot.tree.findings)
    return (*unused, *(study.system().findings if study.has_system else ()))


def _unused(study: Study) -> tuple[Finding, ...]:
    names = unused_parameters(study.file)
    if not names:
        return ()
    message = f"No number of the model depends on {few(names)}."
    advice = "Use each parameter in the model, or remove it from [parameters]."
    return (Finding("unused-parameters", "warning", {"parameters": ", ".join(names)}, message, advice),)


def model_lines(study: Study) -> Iterator[str]:
    """Yield the findings about the model for a terminal."""
    for finding in model_findings(study):
        yield f"{finding.severity.capitalize()}: {finding}"
