"""A user's note and tags of a run: a small file in the run's folder."""

import json
from dataclasses import dataclass
from pathlib import Path

from dalembert.errors import InputError
from dalembert.files import write_text

NOTE = "note.json"
LONGEST = 2000
"""Characters of a note, and of all tags."""


@dataclass(frozen=True)
class Note:
    """What a user wrote about a run."""

    text: str = ""
    tags: tuple[str, ...] = ()


def read_note(run: Path) -> Note:
    """Return the note of a run; an empty one if there is none, or if the file is damaged."""
    try:
        given = json.loads((run / NOTE).read_text(encoding="utf-8"))
        return Note(str(given.get("note", "")), tuple(map(str, given.get("tags", ()))))
    except (OSError, ValueError, AttributeError, TypeError):
        return Note()


def write_note(run: Path, note: Note) -> None:
    """Write the note of a run."""
    if len(note.text) + sum(map(len, note.tags)) > LONGEST:
        raise InputError(f"the note has more than {LONGEST} characters; shorten it")
    write_text(run / NOTE, json.dumps({"note": note.text, "tags": note.tags}, indent=1, ensure_ascii=False) + "\n")


def tags_of(text: str) -> tuple[str, ...]:
    """Return the tags of a text with commas, each once.
    >>> tags_of("rig 2, cold,, cold ")
    ('rig 2', 'cold')
    """
    return tuple(dict.fromkeys(filter(None, map(str.strip, text.split(",")))))
