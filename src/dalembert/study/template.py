"""Studies to begin with."""

import tomllib
from dataclasses import dataclass
from importlib.resources import files
from pathlib import Path

from dalembert.errors import InputError, require_known
from dalembert.files import write_text
from dalembert.study import schema_file

TEMPLATES = files("dalembert.study") / "templates"


@dataclass(frozen=True)
class Template:
    """A study to begin with; ``name``: what a study made from it is called, unless it is given another name; ``files``:
    texts of the files beside it, by name.
    """

    name: str
    title: str
    description: str
    text: str
    files: dict[str, str]


def templates() -> dict[str, Template]:
    """Studies to begin with, by their names."""
    result = {}
    for folder in sorted(TEMPLATES.iterdir(), key=lambda entry: entry.name):
        texts = {entry.name: entry.read_text(encoding="utf-8") for entry in folder.iterdir()}
        text, name = texts.pop("study.toml"), folder.name.partition("-")[2]
        about = tomllib.loads(text)["study"]
        result[name] = Template(name, about["title"], about["description"], text, texts)
    return result


def begin(template: str, folder: Path) -> Path:
    """Write a template's files and the schema into a new folder; the path of its study, which has the folder's name."""
    known = templates()
    require_known("template", template, known)
    try:
        folder.mkdir(parents=True)
    except FileExistsError:
        raise InputError(f"{folder} is there already; name another folder for the study") from None
    except OSError as error:
        raise InputError(f"the folder {folder} cannot be made: {error.strerror}; name another") from None
    study = folder / f"{folder.resolve().name}.toml"
    write_text(study, known[template].text)
    schema_file.write(folder)
    for name, text in known[template].files.items():
        write_text(folder / name, text)
    return study
