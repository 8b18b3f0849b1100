"""Findings about the model of a study, which do not depend on a result."""

from collections.abc import Iterator

from dalembert.findings import Finding
from dalembert.study.study import Study


def model_findings(study: Study) -> tuple[Finding, ...]:
    """Return the findings about the mechanism of a study: what the import of a robot left out, elements that lock."""
    robot = study.file.model.robot_table
    if robot is not None:
        return robot.tree.findings
    return study.system().findings if study.has_system else ()


def model_lines(study: Study) -> Iterator[str]:
    """Yield the findings about the model for a terminal."""
    for finding in model_findings(study):
        yield f"{finding.severity.capitalize()}: {finding}"
