"""What a text is as a study: the study and what it does, or its mistakes with their places and lines."""

import re
import tomllib
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from dalembert.errors import DalembertError
from dalembert.findings import Finding
from dalembert.studio.editor.cursor import tolerant
from dalembert.studio.editor.lines import Place, line_of
from dalembert.studio.editor.model_kind import model_file
from dalembert.studio.editor.outline import Outline
from dalembert.studio.editor.watched_files import Stamp, stamps_of
from dalembert.studio.worker import Kept

if TYPE_CHECKING:
    from dalembert.study import Study

_PLACE = re.compile(r"\[{1,2}([\w.]+)\]{1,2}(?: '([^']+)')?(?:, (\w+))?")
"""Beginning of a sentence about a table and a key."""
_CONSTANT = re.compile(r"\[constants\](?:,|:) ([\w-]+): ")
"""Beginning of a sentence about a constant."""
OF_FILES = ("study", "channels", "comparison", "measured positions")
"""Kinds of things that a process keeps and that depend on files which a text names; user's functions are among them."""


@dataclass(frozen=True)
class Mistake:
    """What is wrong at a place of a study's text. ``place`` has tables, keys and numbers of entries; it is empty if
    only the line, from 1, is known.
    """

    place: Place
    line: int
    sentence: str


@dataclass(frozen=True)
class Reading:
    """A text and the study that it is, None if there are mistakes. ``does`` is a sentence that says what a run of the
    study does; it is empty if there are mistakes. ``findings`` are about the model. ``files`` are the other files that
    the text names, also a text with mistakes, with their stamps when it was read.
    """

    text: str
    study: Outline | None = None
    does: str = ""
    findings: tuple[Finding, ...] = ()
    mistakes: tuple[Mistake, ...] = ()
    files: Mapping[Path, Stamp] = field(default_factory=dict)


def read(path: Path, text: str) -> Reading:
    """Read a text as the study of a path, which is not written."""
    return reading(Kept(), path, text)


def reading(kept: Kept, path: Path, text: str) -> Reading:
    """Read a text as :func:`read` does, in the process of the study's page, where the study is kept."""
    for kind in OF_FILES:
        kept.drop(kind)
    used: dict[str, Path] = {}
    result = _read(kept, path, text, used)
    return replace(result, files=stamps_of(used.values()))


def _read(kept: Kept, path: Path, text: str, used: dict[str, Path]) -> Reading:
    """Read a text, and note the other files that it names."""
    from dalembert.study import plan
    from dalembert.study.loader import StudyError
    from dalembert.study.run.model_findings import model_findings

    try:
        study = study_of(kept, path, text, used)
        does = f"It {plan(study)}."
        return Reading(text, Outline.of(study, text), does, model_findings(study))
    except StudyError as error:
        places = ((place, sentence.replace(f"{path.parent}/", "")) for place, sentence in error.mistakes)
        return Reading(text, mistakes=tuple(mistake(text, *entry) for entry in places))
    except DalembertError as error:
        sentence = str(error).replace(f"{path}: ", "").replace(f"{path.parent}/", "")
        return Reading(text, mistakes=(mistake(text, (), sentence),))


def study_of(kept: Kept, path: Path, text: str, used: dict[str, Path] | None = None) -> "Study":
    """Return the study of a text, read once as long as the files that it names are the same. ``used`` takes the other
    files that the text names, if it is read now.
    """
    study, stamps = kept.newest("study", (path, text), lambda: _loaded(path, text, used))
    if stamps != _stamps(study):
        kept.drop("study")
        study, _ = kept.newest("study", (path, text), lambda: _loaded(path, text, used))
    return study


def _loaded(path: Path, text: str, used: dict[str, Path] | None) -> "tuple[Study, dict[Path, int]]":
    """The study, and when its other files were changed."""
    from dalembert.study import load

    study = load(path, name=path.stem, content=text.encode(), used=used)
    return study, _stamps(study)


def _stamps(study: "Study") -> dict[Path, int]:
    return {file: file.stat().st_mtime_ns for file in study.files.values() if file.is_file()}


def mistake(text: str, place: Place, sentence: str) -> Mistake:
    """Return a mistake at the place that its sentence begins with, such as ``[[model.joint]] 'pin', b``, or at a place.
    A mistake of a model in a separate file is at the key that names the file.
    >>> mistake('[model]\\n[[model.joint]]\\nname = "pin"\\nb = 1\\n', ("model",), "[[model.joint]] 'pin', b: wrong")
    Mistake(place=('model', 'joint', 0, 'b'), line=4, sentence="[[model.joint]] 'pin', b: wrong")
    """
    place = max(place, _named(text, sentence), key=len)
    document = tolerant(text)
    if (file := model_file(document)) and _is_of_file(document, place, sentence):
        place, sentence = ("model", "file"), f"{file}: {sentence}"
    return Mistake(place, line_of(text, place) if place else _line_in(sentence, text), sentence)


def _is_of_file(document: Mapping[str, Any], place: Place, sentence: str) -> bool:
    """Whether a mistake is one of the tables that a model file holds, and not of the key that names it."""
    match = _PLACE.match(sentence)
    named = place or (tuple(match[1].split(".")) if match else ())
    if constant := _CONSTANT.match(sentence):
        constants = document.get("constants")
        return not (isinstance(constants, Mapping) and constant[1] in constants)
    return named[:1] == ("model",) and not sentence.startswith("[model], file: ")


def _line_in(sentence: str, text: str) -> int:
    """The line that a sentence of the TOML reader names."""
    if "(at end of document)" in sentence:
        return max(1, len(text.splitlines()))
    match = re.search(r"\(at line (\d+), column \d+\)", sentence)
    return int(match[1]) if match else 1


def _named(text: str, sentence: str) -> Place:
    """The place of the table and the key that a sentence begins with; an empty one if there is none."""
    match = _PLACE.match(sentence)
    if match is None:
        return ()
    table, name, key = match.groups()
    place: Place = tuple(table.split("."))
    if name is not None:
        number = _number_of(text, place, name)
        if number is None:
            return ()
        place = (*place, number)
    return (*place, key) if key else place


def _number_of(text: str, tables: Place, name: str) -> int | None:
    """Number of the entry with a name in a list of tables."""
    try:
        entries: Any = tomllib.loads(text)
        for table in tables:
            entries = entries[table]
        return [entry.get("name") for entry in entries].index(name)
    except (ValueError, KeyError, TypeError, AttributeError):
        return None
