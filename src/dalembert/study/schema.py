"""The schema of study files, with all tasks and kinds that there are."""

import json
from collections.abc import Iterator, Mapping
from functools import cache, lru_cache
from typing import Any, ClassVar

from pydantic import create_model
from pydantic.json_schema import GenerateJsonSchema

from dalembert.study.tables.catalogue import Words, kind_names, solver
from dalembert.study.tables.dataclass_tables import buildable_table
from dalembert.study.tables.model_table import model_key
from dalembert.study.tables.study_file import StudyFile
from dalembert.study.tasks import TASKS
from dalembert.study.text.spaces import IN_SPACE, is_in_space
from dalembert.study.text.table import StudyTable


class _KnownFile(StudyFile):
    """A study file with the tasks that there are."""

    known_tasks: ClassVar[Mapping[str, Any]] = TASKS


@lru_cache(maxsize=16)
def study_file(words: Words = None) -> type[StudyFile]:
    """The study file with all tables and kinds that there are, or with those that words name.

    Most of the kinds take some time to be imported and to be made tables of, and a document uses few of them.
    """
    fields: dict[str, Any] = {
        name: (_task_table(name) | None, None) for name in TASKS if words is None or name in words
    }
    fields["model"] = (model_key(words), ...)
    if words is None or "solver" in words:
        fields["solver"] = (solver(words) | None, None)
    if words is None or "harmonic_balance" in words:
        from dalembert.vibration import HarmonicBalance

        fields["harmonic_balance"] = (buildable_table(HarmonicBalance) | None, None)
    return create_model("Study", __base__=_KnownFile, __doc__=StudyFile.__doc__, **fields)


@cache
def _task_table(name: str) -> type[StudyTable]:
    return TASKS[name].table()


def words_of(document: Mapping[str, Any]) -> frozenset[str]:
    """Names that choose tables and kinds: tables of a document and of its model, and kinds that are named anywhere."""
    model = document.get("model")
    tables = {*document, *(model if isinstance(model, Mapping) else ())} - {IN_SPACE}
    tables |= {IN_SPACE} if is_in_space(model) else set()
    return frozenset(tables | kind_names().intersection(_texts(document)))


def _texts(value: Any) -> Iterator[str]:
    if isinstance(value, str):
        yield value
    elif isinstance(value, Mapping):
        yield from value
        yield from _texts(list(value.values()))
    elif isinstance(value, list):
        for entry in value:
            yield from _texts(entry)


class _Schema(GenerateJsonSchema):
    """JSON schema as TOML needs it: no null, and no titles of keys, which would repeat their names.

    A choice by a function may have branches that a value fits at once, such as a word and a number with a unit.
    """

    def field_title_should_be_set(self, schema: Any) -> bool:
        return False

    def nullable_schema(self, schema: Any) -> dict[str, Any]:
        return self.generate_inner(schema["schema"])

    def default_schema(self, schema: Any) -> dict[str, Any]:
        result = super().default_schema(schema)
        return {key: value for key, value in result.items() if key != "default" or value not in (None, [], {})}

    def tagged_union_schema(self, schema: Any) -> dict[str, Any]:
        result = super().tagged_union_schema(schema)
        return (
            result
            if "discriminator" in result
            else {("anyOf" if key == "oneOf" else key): result[key] for key in result}
        )


def schema_text() -> str:
    """JSON schema of a study file, as one line of text."""
    return json.dumps(json_schema(), separators=(",", ":"), ensure_ascii=False) + "\n"


def json_schema() -> dict[str, Any]:
    """JSON schema of a study file, for editors."""
    schema = study_file().model_json_schema(schema_generator=_Schema)
    return {"$schema": "https://json-schema.org/draft/2020-12/schema", "title": "dalembert study", **schema}
