"""The studies of a workspace by their folders, with what they say about themselves and their last runs."""

import re
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path

from dalembert.studio.runs.study_runs import LastRun, last_runs
from dalembert.studio.studies.documents import document_of, name_in
from dalembert.studio.workspace import Workspace
from dalembert.study.schema_file import task_names

EXPECTED = "expected.toml"
"""File with the numbers that must come out of the studies of a folder: such studies are examples."""

_MARKED = re.compile(r"\[([^]]+)\]\([^)]*\)|\*(\S[^*]*)\*|`([^`]*)`")
"""Links, emphasis and code in Markdown, with their texts."""


@dataclass(frozen=True)
class Entry:
    """A study file, ``"folder/file"``. Title, description and task are empty if the file has none; ``last`` is None if
    it was never run.
    """

    name: str
    title: str
    description: str
    task: str
    last: LastRun | None

    @property
    def heading(self) -> str:
        """The title, or else the name."""
        return self.title or self.name.removesuffix("/study")


@dataclass(frozen=True)
class StudyFolder:
    """A folder with studies, the one that stands for them first. Title and description are those of its ``README.md``,
    or of its first study. ``example`` is True if its results are known.
    """

    name: str
    title: str
    description: str
    entries: tuple[Entry, ...]
    example: bool

    def matches(self, words: str) -> bool:
        """Return True if the folder or one of its studies has all words of a search."""
        texts = [self.name, self.title, self.description]
        texts += [text for entry in self.entries for text in (entry.name, entry.title, entry.description, entry.task)]
        return has_words(texts, words)


def has_words(texts: Iterable[str], words: str) -> bool:
    """Return True if some of the texts have each word of a search.
    >>> has_words(["A motion of a mechanism", "A pendulum"], "PENDULUM motion"), has_words([], "x")
    (True, False)
    """
    known = " ".join(texts).casefold()
    return all(word in known for word in words.casefold().split())


def study_folders(workspace: Workspace) -> list[StudyFolder]:
    """Return all folders with studies, by name."""
    runs, entries = last_runs(workspace.runs_folder), {}
    for name in workspace.studies():
        path = workspace.root / "studies" / f"{name}.toml"
        document = document_of(path) or {}
        about = document.get("study")
        about = about if isinstance(about, dict) else {}
        task = next((key for key in document if key in task_names()), "")
        title, description = (" ".join(str(about.get(key, "")).split()) for key in ("title", "description"))
        last = runs.get((path.parent.resolve(), name_in(path)))
        entries.setdefault(name.partition("/")[0], []).append(Entry(name, title, description, task, last))
    return [_folder(workspace.root / "studies" / name, entries_here) for name, entries_here in entries.items()]


def _folder(path: Path, entries: list[Entry]) -> StudyFolder:
    ordered = sorted(entries, key=lambda entry: not entry.name.endswith("/study"))
    first = ordered[0]
    title, description = _readme(path / "README.md")
    shown = description or first.description
    return StudyFolder(path.name, title or first.heading, shown, tuple(ordered), (path / EXPECTED).is_file())


def _readme(path: Path) -> tuple[str, str]:
    """Heading and first paragraph of a Markdown file; empty if there are none."""
    try:
        heading, *paragraphs = path.read_text(encoding="utf-8").strip().split("\n\n")
    except (OSError, ValueError):
        return "", ""
    if not heading.startswith("# "):
        return "", ""
    first = " ".join(_MARKED.sub(r"\1\2\3", paragraphs[0]).split()) if paragraphs else ""
    return heading.removeprefix("# ").strip(), first if first[:1].isalnum() else ""
