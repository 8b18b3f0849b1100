"""The folder that the studio works in: its studies, their files, and their runs."""

import os
import re
import unicodedata
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path
from shutil import rmtree

from dalembert.errors import InputError, no_text, require_known, unknown
from dalembert.files import free_path, replacing, write_text
from dalembert.studio.editor.cursor import tolerant
from dalembert.studio.editor.model_kind import model_file
from dalembert.studio.studies.documents import table_names
from dalembert.study import schema_file
from dalembert.study.run.folder import RunFolder, find_runs
from dalembert.study.schema_file import LARGEST, SHARED, task_names

NAME = re.compile(r"""(?![ .-])[^/\\:*?"<>|]{1,100}(?<![ .])""")
"""What a study, a file or a run may be called on every system. A dot first would hide it."""
LONGEST = 200
"""Bytes of a name; files have at most 255, with what is added to them."""
MOST_BYTES = 200_000_000
"""Of an uploaded file."""
OF_A_MODEL = frozenset(("model", "constants"))
"""Tables of a file that holds the model of several studies."""


@dataclass(frozen=True)
class Workspace:
    """Studies in ``studies/NAME/*.toml`` and runs in ``runs/NAME`` below a folder."""

    root: Path
    _known: set[Path] = field(default_factory=set, init=False, repr=False, compare=False)
    """Files that were studies, or were opened as such, since the studio began; they stay listed with their errors."""

    @property
    def runs_folder(self) -> Path:
        return self.root / "runs"

    def runs(self) -> list[RunFolder]:
        """All runs, by name."""
        return find_runs(self.runs_folder)

    def run(self, name: str) -> RunFolder:
        """The run of a name."""
        known = {folder.path.name: folder for folder in self.runs()}
        require_known("run", name, known)
        return known[name]

    def new_run(self, name: str) -> Path:
        """Folder for another run of a study: ``runs/NAME``, or that with the next free number."""
        return free_path(self.runs_folder / checked(name))

    def studies(self) -> list[str]:
        """All study files as ``"folder/file"``, without ``.toml``, by name."""
        files = self._files()
        self._known.update(path for path in files.values() if _is_study(path))
        return [name for name, path in files.items() if path in self._known]

    def _files(self) -> dict[str, Path]:
        """All TOML files in folders of studies, by their names without ``.toml``; hidden ones are left out."""
        paths = sorted((self.root / "studies").glob("*/*.toml"))
        shown = [path for path in paths if not (path.name.startswith(".") or path.parent.name.startswith("."))]
        return {f"{path.parent.name}/{path.stem}": path for path in shown}

    def free(self, name: str) -> str:
        """The name itself, or with the next number with which no study is there."""
        return free_path(self.root / "studies" / name).name

    def study(self, name: str) -> Path:
        """The file of a study. A file that is opened in this way counts as a study, whatever it holds."""
        path = self._files().get(name)
        if path is None:
            raise InputError(unknown("study", name, self.studies()))
        self._known.add(path)
        return path

    def model_of(self, name: str) -> Path:
        """The file that the saved text of a study names for its model."""
        path = self.study(name)
        try:
            file = model_file(tolerant(path.read_text(encoding="utf-8")))
        except (OSError, ValueError):
            file = ""
        if not file:
            raise InputError(f"{path.name} names no model file; its model is in the study itself")
        model_path = Path(os.path.normpath(path.parent / file))
        if not model_path.is_relative_to(self.root / "studies") or model_path.suffix != ".toml":
            raise InputError(f"{file} is no TOML file in the folder of the studies; edit it with another program")
        return model_path

    def create(self, name: str, content: str, beside: Callable[[Path], object] = lambda folder: None) -> str:
        """Make a new study with its text and the schema beside it; return its name as :meth:`studies` gives it.
        ``beside`` writes further files into the folder. If it fails, there is no new study.
        """
        name = checked(name)
        folder = self.root / "studies" / name
        if folder.exists():
            raise InputError(f"there is a study {name!r} already; choose another name")
        folder.mkdir(parents=True)
        try:
            self.write(folder / "study.toml", content)
            schema_file.write(folder)
            beside(folder)
        except BaseException:
            rmtree(folder, ignore_errors=True)
            raise
        return f"{name}/study"

    def write(self, path: Path, content: str) -> None:
        """Write a study's text."""
        if len(content.encode()) > LARGEST:
            raise InputError(f"{path.name} has more than {LARGEST} bytes; expected a study file")
        write_text(path, content)

    def put(self, study: str, name: str, content: bytes) -> Path:
        """Write a file, such as measured data, into the folder of a study; return its path. ``study`` is
        ``"folder/file"``, as :meth:`studies` lists it. A file of this name is replaced.
        """
        name = checked(name)
        if Path(name).suffix.lower() in (".py", ".pyc", ".so", ".toml"):
            raise InputError(f"{name!r} is no data file; put programs and studies into the folder yourself")
        if len(content) > MOST_BYTES:
            raise InputError(f"{name!r} has {len(content)} bytes; expected at most {MOST_BYTES}")
        path = self.study(study).parent / name
        with replacing(path) as temporary:
            temporary.write_bytes(content)
        return path


def checked(name: str) -> str:
    """Return the name with composed characters; raise InputError if no study, file or run may have it."""
    name = unicodedata.normalize("NFC", name)
    if not (NAME.fullmatch(name) and name.isprintable() and len(name.encode()) <= LONGEST):
        raise InputError(
            f"{name[:100]!r} cannot be a name here; expected at most 100 characters ({LONGEST} bytes) without "
            '/ \\ : * ? " < > | and without a dot or a space at either end or a hyphen at the start'
        )
    return name


def as_text(content: bytes, name: str) -> str:
    """Text of an uploaded study."""
    if len(content) > LARGEST:
        raise InputError(f"{name} has more than {LARGEST} bytes; expected a study file")
    try:
        return content.decode("utf-8")
    except UnicodeDecodeError as error:
        raise InputError(no_text(name, error)) from None


def _is_study(path: Path) -> bool:
    """Whether a TOML file is a study, possibly with mistakes; models and tables of expected numbers are none."""
    if path.name == "study.toml":
        return True
    names = table_names(path)
    if not names:  # its text was deleted, or cannot be read
        return True
    if names <= OF_A_MODEL:
        return False
    is_task_of_study = not names.isdisjoint(task_names()) and not names.isdisjoint(SHARED)
    return "model" in names or "study" in names or is_task_of_study
