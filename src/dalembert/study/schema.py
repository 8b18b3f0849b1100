"""The whole study file: its tables, and that they fit together."""

from collections.abc import Iterator, Mapping
from functools import lru_cache
from typing import Any

from pydantic import (
    create_model,
    model_validator,
)

from dalembert.study.catalogue import Words, balance, kind_names
from dalembert.study.components import buildable_table
from dalembert.study.experiments import wrong_experiments
from dalembert.study.inputs import wrong_inputs
from dalembert.study.model_table import model_table
from dalembert.study.solvers import solver
from dalembert.study.study_file import StudyFile
from dalembert.study.table import StudyTable, problem
from dalembert.study.tasks import TASKS


class CheckedStudyFile(StudyFile):
    """A study: a model, and one task."""

    @model_validator(mode="after")
    def _check(self) -> "CheckedStudyFile":
        both = sorted(set(self.parameters) & set(self.constants))
        if both:
            raise problem(f"{', '.join(both)} is both a parameter and a constant; give each name once")
        if len(self.tasks) != 1:
            names = " and ".join(f"[{name}]" for name in self.tasks)
            given = f"{names} are given" if names else "no task is given"
            raise problem(f"{given}; a study has one task, one of {', '.join(f'[{name}]' for name in TASKS)}")
        (name,) = self.tasks
        wrong = [*wrong_experiments(self), *wrong_inputs(self), *_wrong_settings(self), *TASKS[name].wrong(self)]
        if wrong:
            raise problem(*wrong)
        return self

    @property
    def vibrates(self) -> bool:
        told = self.harmonic_balance is not None or any(TASKS[name].of_structures for name in self.tasks)
        return self.model.is_structure or (self.model.function is not None and told)

    @property
    def tasks(self) -> Mapping[str, StudyTable]:
        return {name: table for name in TASKS if (table := getattr(self, name, None)) is not None}


def _wrong_settings(file: StudyFile) -> list[str]:
    """Sentences about tables of settings that are not for this model."""
    wrong = []
    if file.vibrates and file.solver is not None:
        wrong.append("[solver] integrates mechanisms; a structure over frequency takes [harmonic_balance], or neither")
    if file.harmonic_balance is not None and not file.vibrates:
        wrong.append("[harmonic_balance] is for structures over frequency, and here is another model; leave it out")
    for where, table in (("[data]", file.data), ("[bands]", file.bands)):
        if table is None:
            continue
        if file.vibrates and table.frequency is None and not table.universal:
            wrong.append(f"{where}: the key 'frequency' is missing; expected the name of the column of frequencies")
        if file.model.forward is None and not file.vibrates and table.frequency is not None:
            wrong.append(f"{where}, frequency: the samples of a mechanism lie along time; name its column by time")
    return wrong


@lru_cache(maxsize=16)
def study_file(words: Words = None) -> type[CheckedStudyFile]:
    """The study file with all tables and kinds that there are, or with those that words name.

    Most of the kinds take some time to be imported and to be made tables of, and a document uses few of them.
    """
    fields: dict[str, Any] = {
        name: (task.table() | None, None) for name, task in TASKS.items() if words is None or name in words
    }
    fields["model"] = (model_table(words), ...)
    if words is None or "solver" in words:
        fields["solver"] = (solver(words) | None, None)
    if words is None or "harmonic_balance" in words:
        fields["harmonic_balance"] = (buildable_table(balance()) | None, None)
    return create_model("Study", __base__=CheckedStudyFile, __doc__=CheckedStudyFile.__doc__, **fields)


def words_of(document: Mapping[str, Any]) -> frozenset[str]:
    """Names that choose tables and kinds: tables of a document and of its model, and kinds that are named anywhere."""
    model = document.get("model")
    tables = {*document, *(model if isinstance(model, Mapping) else ())}
    return frozenset(tables | {*kind_names()}.intersection(_texts(document)))


def _texts(value: Any) -> Iterator[str]:
    """All keys and texts in a document."""
    if isinstance(value, str):
        yield value
    elif isinstance(value, Mapping):
        yield from value
        yield from _texts(list(value.values()))
    elif isinstance(value, list):
        for entry in value:
            yield from _texts(entry)


def json_schema() -> dict[str, Any]:
    """JSON schema of a study file, for editors."""
    schema = study_file().model_json_schema()
    return {"$schema": "https://json-schema.org/draft/2020-12/schema", "title": "dalembert study", **schema}
