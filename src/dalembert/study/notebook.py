"""What a notebook shows of a study."""

from dalembert.report.notebook import Summary
from dalembert.study.picture import picture_or_message
from dalembert.study.run.runner import plan
from dalembert.study.tables.study import Study
from dalembert.tables import labelled, shown


def html_of(study: Study) -> str:
    """Return the HTML of a study: its picture, what it does, and its parameters."""
    facts = {"task": study.task.replace("_", " "), "it does": plan(study)}
    facts |= {
        labelled(item.name, item.unit): f"{shown(float(item.lower))} to {shown(float(item.upper))}"
        for item in study.parameters.declared
    }
    return Summary(
        study.title, sentences=[study.file.study.description], facts=facts, pictures=[picture_or_message(study.path)]
    ).html()
