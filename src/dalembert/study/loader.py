"""From a TOML file to a checked study; all mistakes at once, each with its file, table and key."""

import tomllib
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

from pydantic import ValidationError

from dalembert.errors import InputError, no_text, unknown
from dalembert.study.schema import study_file, words_of
from dalembert.study.schema_file import LARGEST, MODEL_FILE
from dalembert.study.tables.parameters import series_in
from dalembert.study.tables.study import Study
from dalembert.study.tables.study_file import StudyFile
from dalembert.study.tasks import TASKS
from dalembert.study.text.expressions import kinds_of
from dalembert.study.text.messages import mistakes
from dalembert.study.text.spaces import elsewhere, is_in_space
from dalembert.study.text.table import Context
from dalembert.units import is_quantity


class StudyError(InputError):
    """A study file with mistakes: ``message`` has one line a mistake. ``mistakes``: the place of each, by its tables,
    keys and numbers of entries, and its sentence.
    """

    def __init__(self, message: str, mistakes: list[tuple[tuple[str | int, ...], str]]) -> None:
        super().__init__(message)
        self.mistakes = mistakes


def load(
    path: str | Path,
    *,
    name: str = "",
    folder: Path | None = None,
    files: Mapping[str, Path] | None = None,
    content: bytes | None = None,
    model: bytes | None = None,
    used: dict[str, Path] | None = None,
) -> Study:
    """Read and check a study file.

    Parameters
    ----------
    path : path
    name : str
        Name of the study; that in the file, or the file's own, if not given.
    folder : Path, optional
        Where the files that it names are looked for; its own folder if not given.
    files : mapping of str to Path, optional
        Files that it names and that lie elsewhere.
    content : bytes, optional
        Of the file, in place of what is on the disk.
    model : bytes, optional
        Content of the model file that it names, in place of what is on the disk.
    used : dict of str to Path, optional
        Takes the files that the study names, also those of a study with mistakes.

    Raises
    ------
    InputError
        With one line a mistake.
    """
    path = Path(path)
    context = Context(folder or path.parent, files=dict(files or {}), used={} if used is None else used)
    content, document = _read(path) if content is None else _document(path, content)
    if document.keys() <= set(MODEL_FILE):
        problem_text, more = "the file holds no tables", ""
        if document:
            problem_text, more = (
                "no task is given",
                f"; a study in another file names a model by file = '{path.name}' in [model]",
            )
        tasks = ", ".join(f"[{name}]" for name in TASKS)
        sentence = f"{problem_text}; a study needs a [model] and one task, one of {tasks}{more}"
        raise StudyError(f"{path.name}: {sentence}", [((), sentence)])
    shared = _with_model_file(document, context, path, model)
    names = {name for table in ("parameters", "constants") for name in _table(document, table)}
    context.series = series_in(_table(document, "parameters"))
    single = (names - set(context.series)).union(*context.series.values())
    context.names = kinds_of(document, sorted(single), context.series)
    try:
        file = _validated(document, context)
    except ValidationError as error:
        errors = _of_other_space(document, context) or mistakes(error, document, context)
        lines = [f"{shared if shared and place[:1] == ('model',) else path.name}: {text}" for place, text in errors]
        raise StudyError("\n".join(dict.fromkeys(lines)), errors) from None
    _refuse_other_kinds(document, context, path)
    return Study(path, content, file, dict(context.used), name or file.study.name or path.stem)


def _refuse_other_kinds(document: dict[str, Any], context: Context, path: Path) -> None:
    shared = _table(document, "constants")
    for entry in document.get("experiments", []):
        constants = _table(entry, "constants")
        plain = [name for name in constants if name in shared and context.names.get(name) is None]
        quantities = {name: constants[name] for name in plain if is_quantity(str(constants[name]))}
        if not quantities:
            continue
        varied = {**document, "constants": {**shared, **quantities}}
        names = kinds_of(varied, context.names, context.series)
        inner = replace(context, names=names, used={}, _keys={})
        try:
            _validated(varied, inner)
        except ValidationError as error:
            errors = mistakes(error, varied, inner)
            lines = [f"{path.name}: [[experiments]] {entry.get('name')!r}, constants: {text}" for _, text in errors]
            raise StudyError("\n".join(dict.fromkeys(lines)), errors) from None


def _validated(document: dict[str, Any], context: Context) -> StudyFile:
    """The tables of a document. The whole schema, with all kinds, reports mistakes."""
    try:
        return study_file(words_of(document)).model_validate(document, context=context)
    except ValidationError:
        return study_file().model_validate(document, context=context)


def _of_other_space(document: dict[str, Any], context: Context) -> list[tuple[tuple[str | int, ...], str]]:
    try:
        _validated(elsewhere(document), replace(context, used={}, _keys={}))
    except ValidationError:
        return []
    advice = (
        "in the plane; leave out space = true" if is_in_space(document["model"]) else "in space; write space = true"
    )
    return [(("model",), f"[model]: its components are those of a mechanism {advice}")]


def _read(path: Path) -> tuple[bytes, dict[str, Any]]:
    try:
        if path.is_dir():
            inside = sorted(path.glob("*.toml"))
            raise InputError(f"{path} is a folder; expected a study file{f' such as {inside[0]}' if inside else ''}")
        if path.stat().st_size > LARGEST:
            raise InputError(f"{path} has more than {LARGEST} bytes; expected a study file")
        return _document(path, path.read_bytes())
    except FileNotFoundError:
        near = [entry.name for entry in path.parent.glob("*.toml")] if path.parent.is_dir() else []
        where = "" if path.parent == Path() else f"folder {path.parent}"
        raise InputError(unknown("study file", path.name, near, where)) from None
    except OSError as error:
        raise InputError(f"{path} cannot be read: {error.strerror}") from None


def _document(path: Path, content: bytes) -> tuple[bytes, dict[str, Any]]:
    try:
        return content, tomllib.loads(content.decode("utf-8"))
    except UnicodeDecodeError as error:
        raise InputError(no_text(path, error)) from None
    except (RecursionError, ValueError) as error:
        raise InputError(f"{path}: no valid TOML: {error}") from None


def _with_model_file(document: dict[str, Any], context: Context, path: Path, content: bytes | None) -> str:
    """Put the tables of ``[model] file = "..."`` in their place; the other file's name, or none."""
    model_file = _table(document, "model").get("file")
    if model_file is None:
        return ""
    if not isinstance(model_file, str) or len(document["model"]) > 1:
        raise _wrong_file(
            path,
            f"{model_file!r} was given; expected the name of a TOML file, and no other key beside it in [model]",
        )
    try:
        file = context.file(model_file)
        _, shared = _read(file) if content is None else _document(file, content)
    except InputError as error:
        raise _wrong_file(path, str(error)) from None
    for table in shared:
        if table not in MODEL_FILE:
            raise _wrong_file(
                path,
                f"{model_file}: [{table}] is in a model file; expected [model] and [constants] there, "
                "and the rest in the study file",
            )
    if "file" in _table(shared, "model") or "model" not in shared:
        raise _wrong_file(path, f"{model_file}: expected a [model] table with the model itself")
    document["model"] = shared["model"]
    constants_here = _table(document, "constants")  # first, so that the model's constants may use the study's
    taken = {*constants_here, *_table(document, "parameters")}
    constants = constants_here | {
        name: value for name, value in _table(shared, "constants").items() if name not in taken
    }
    if constants:
        document["constants"] = constants
    return model_file


def _wrong_file(path: Path, sentence: str) -> StudyError:
    sentence = f"[model], file: {sentence}"
    return StudyError(f"{path.name}: {sentence}", [(("model", "file"), sentence)])


def _table(document: Mapping[str, Any], name: str) -> dict[str, Any]:
    table = document.get(name)
    return table if isinstance(table, dict) else {}
