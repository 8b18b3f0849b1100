"""A study that is open on a page: its text and history, what it is, values, the selection, and its file."""

import time
from collections.abc import Callable
from hashlib import sha256
from pathlib import Path
from typing import Literal

import tomlkit
from tomlkit.exceptions import TOMLKitError

from dalembert.errors import InputError, no_text, require_known
from dalembert.files import free_path, write_text
from dalembert.parameters import Parameters
from dalembert.studio.editor.history import History
from dalembert.studio.editor.lines import Place
from dalembert.studio.editor.outline import Outline
from dalembert.studio.editor.reading import Mistake, Reading, mistake, read
from dalembert.studio.editor.watched_files import WatchedFiles
from dalembert.study.schema_file import LARGEST

Topic = Literal["text", "study", "mistakes", "values", "selection", "disk", "files"]
Disk = Literal["same", "changed", "gone"]


class ChangedOnDiskError(InputError):
    """A file that somebody else changed since it was read."""


class Draft:
    """The state of one open study. Panels follow its topics. Text typed within a short time by ``clock`` (s) is undone
    in one step. ``reading``: the text as a study when it was last checked; ``good``: the last study without mistakes;
    ``values``: current values of parameters in SI units, at first their start values; ``starts``: their first guesses.
    Local parameters and those of sensors have the names of a fit: ``"trial.angle"``, ``"AB.end.x delay"``.
    ``selection``: a place in the file, such as ``("model", "body", 0)``; ``disk``: the file compared with what was read
    or saved; ``watched_files``: those that the text names; :meth:`check_files` reports "files" after changes of them.
    """

    def __init__(self, path: Path, clock: Callable[[], float] = time.monotonic) -> None:
        self.path, self._clock = path, clock
        self._followers: dict[Topic, list[Callable[[], object]]] = {}
        self._read()
        self.text = self._saved
        self._history = History(self.text)
        self.reading = Reading("")
        self.good: Outline | None = None
        self.values: dict[str, float] = {}
        self.starts: dict[str, float] = {}
        self.selection: Place | None = None
        self.disk: Disk = "same"
        self.watched_files = WatchedFiles()
        self._later_mistakes: tuple[Mistake, ...] = ()

    @property
    def name(self) -> str:
        """Name of the study in the workspace, ``"folder/file"``."""
        return f"{self.path.parent.name}/{self.path.stem}"

    @property
    def study(self) -> Outline | None:
        """The study that the text is; None if it has mistakes."""
        return self.reading.study

    @property
    def mistakes(self) -> tuple[Mistake, ...]:
        """Mistakes of the text, and those that panels found."""
        return (*self.reading.mistakes, *self._later_mistakes)

    @property
    def saved(self) -> str:
        """The text of the file when it was last read or saved."""
        return self._saved

    @property
    def is_saved(self) -> bool:
        """Whether the text is that of the file when it was last read or saved."""
        return self.text == self._saved

    @property
    def can_undo(self) -> bool:
        return self._history.can_undo

    @property
    def can_redo(self) -> bool:
        return self._history.can_redo

    def follow(self, topic: Topic, callback: Callable[[], object]) -> Callable[[], None]:
        """Call a function after each change of a topic; return the function that ends this."""
        self._followers.setdefault(topic, []).append(callback)
        return lambda: self._followers[topic].remove(callback)

    def set_text(self, text: str, *, typed: bool = False) -> None:
        """Replace the text. What is ``typed`` without a pause is undone in one step."""
        if text == self.text:
            return
        self._history.add(text, self._clock() if typed else None)
        self._show(text)

    def recall(self, text: str) -> None:
        """Put a text that came too late to be taken before the present one, where :meth:`undo` finds it."""
        self._history.add(text)
        self._history.add(self.text)
        self._tell("text")

    def restore(self, text: str, saved: str) -> None:
        """Show a text that was not saved when its page was lost. ``saved`` is the text of the file that it was based
        on. If the file has another one, somebody else changed it.
        """
        if saved != self._saved:
            self._saved, self._digest = saved, sha256(saved.encode()).digest()
        self.set_text(text)
        self.check_disk(always=True)

    def edit(self, function: Callable[[tomlkit.TOMLDocument], object]) -> None:
        """Change the text by a function that changes the document; comments and order stay."""
        try:
            document = tomlkit.parse(self.text)
        except TOMLKitError as error:
            raise InputError(f"The text is not valid TOML: {error}. Correct it first.") from None
        function(document)
        self.set_text(tomlkit.dumps(document))

    def undo(self) -> None:
        """Take back the last change of the text, if there is one."""
        self._step(-1)

    def redo(self) -> None:
        """Repeat the change that was taken back, if there is one."""
        self._step(1)

    def check(self) -> None:
        """Read the text as a study."""
        self.take(read(self.path, self.text))

    def take(self, reading: Reading) -> None:
        """Accept what a text is as a study, unless the text has changed meanwhile."""
        if reading.text != self.text:
            return
        self.reading, self._later_mistakes = reading, ()
        self.watched_files.take(reading.files)
        if reading.study is not None:
            self._start_values(reading.study)
            self.good = reading.study
        self._tell("study")
        self._tell("mistakes")

    def find(self, sentence: str) -> None:
        """Add what is wrong with a study whose text is valid, such as a mechanism that cannot be assembled."""
        mistake_here = mistake(self.text, (), sentence)
        if mistake_here not in self._later_mistakes:
            self._later_mistakes = (*self._later_mistakes, mistake_here)
            self._tell("mistakes")

    def select(self, place: Place | None) -> None:
        """Select a place in the file."""
        if place != self.selection:
            self.selection = place
            self._tell("selection")

    def set_value(self, name: str, number: float) -> None:
        """Set the current value of a parameter (SI units), which changes no text."""
        require_known("parameter", name, self.values)
        if number != self.values[name]:
            self.values[name] = number
            self._tell("values")

    def save(self) -> None:
        """Write the text to the file."""
        self.check_disk(always=True)
        if self.disk == "changed":
            raise ChangedOnDiskError(
                f"{self.path.name} changed on disk and was not overwritten. "
                "Choose Reload, Keep mine or Save as a copy above the text."
            )
        self._write(self.path)
        self._saved, self._digest = self.text, sha256(self.text.encode()).digest()
        self._stamp = _stamp(self.path)
        self._note("same")
        self._tell("text")

    def save_copy(self) -> Path:
        """Write the text to a new file in the same folder and return its path."""
        path = self.path.with_name(f"{free_path(self.path.with_suffix(''), _taken).name}.toml")
        self._write(path)
        return path

    def check_disk(self, *, always: bool = False) -> None:
        """Compare the file with what was read or saved; its content only if time or size changed, or ``always``."""
        try:
            stamp = _stamp(self.path)
            if always or stamp != self._stamp:
                same = sha256(self.path.read_bytes()).digest() == self._digest
                self._stamp = stamp if same else self._stamp
                self._note("same" if same else "changed")
            elif self.disk == "gone":
                self._note("same")
        except OSError:
            self._note("gone")

    def check_files(self) -> None:
        """Look whether a file that the text names has changed."""
        if self.watched_files.have_changed():
            self._tell("files")

    def reload(self) -> None:
        """Take the text from the file. :meth:`undo` restores the replaced text."""
        self._read()
        self.set_text(self._saved)
        self._note("same")
        self._tell("text")

    def keep(self) -> None:
        """Keep the text, although the file changed: the next :meth:`save` replaces the file."""
        self._read()
        self._note("same")
        self._tell("text")

    def _show(self, text: str) -> None:
        self.text = text
        self._tell("text")

    def _step(self, by: int) -> None:
        text = self._history.step(by)
        if text is not None:
            self._show(text)

    def _start_values(self, study: Outline) -> None:
        """Take new start values; values that were set stay while the parameter's start and bounds do."""
        parameters, known = _parameters(study), () if self.good is None else _parameters(self.good).declared
        kept = {item.name for item in parameters.declared if item in known}
        self.starts = {name: float(value) for name, value in parameters.mapping(parameters.start).items()}
        values = self.starts | {name: value for name, value in self.values.items() if name in kept}
        if values != self.values:
            self.values = values
            self._tell("values")

    def _write(self, path: Path) -> None:
        if len(self.text.encode()) > LARGEST:
            raise InputError(f"The study has more than {LARGEST} bytes. Move data to files beside it.")
        write_text(path, self.text)

    def _read(self) -> None:
        """Read the file: its text with ends of lines as an editor has them, and by what a change is noticed."""
        try:
            self._stamp = _stamp(self.path)
            content = self.path.read_bytes()
            self._saved = content.decode("utf-8").replace("\r\n", "\n").replace("\r", "\n")
            self._digest = sha256(content).digest()
        except UnicodeDecodeError as error:
            raise InputError(no_text(self.path.name, error)) from None
        except OSError as error:
            raise InputError(f"{self.path.name} cannot be read: {error.strerror}.") from None

    def _note(self, disk: Disk) -> None:
        if disk != self.disk:
            self.disk = disk
            self._tell("disk")

    def _tell(self, topic: Topic) -> None:
        for callback in tuple(self._followers.get(topic, ())):
            callback()


def _parameters(study: Outline) -> Parameters:
    """Parameters of a study, of its sensors, and of single experiments."""
    items = (*study.parameters.declared, *(item for part in study.parts.values() for item in part))
    return Parameters(tuple({item.name: item for item in items}.values()))


def _stamp(path: Path) -> tuple[int, int]:
    """Time and size of a file."""
    status = path.stat()
    return status.st_mtime_ns, status.st_size


def _taken(path: Path) -> bool:
    """Whether a study has a name, given without its suffix."""
    return path.with_name(f"{path.name}.toml").exists()
