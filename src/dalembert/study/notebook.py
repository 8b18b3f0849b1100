"""What a notebook shows of a study."""

from dalembert.parameter import Parameter
from dalembert.report.notebook import Summary
from dalembert.study.picture import picture_or_message
from dalembert.study.run.runner import plan
from dalembert.study.tables.study import Study
from dalembert.tables import labelled, shown


def html_of(study: Study) -> str:
    """Return the HTML of a study: its picture, what it does, and its parameters."""
    facts = {"task": study.task.replace("_", " "), "it does": plan(study)}
    facts |= {labelled(item.name, item.unit): _range(item) for item in study.parameters.declared}
    return Summary(
        study.title, sentences=[study.file.study.description], facts=facts, pictures=[picture_or_message(study.path)]
    ).html()


def _range(item: Parameter) -> str:
    return f"{shown(float(item.lower))} to {shown(float(item.upper))}"
