"""What a text is as a study: the study and what it does, or its mistakes with their places and lines."""

import re
import tempfile
from dataclasses import dataclass
from pathlib import Path

from dalembert.errors import DalembertError
from dalembert.studio.lines import Place, line_of
from dalembert.study import load, plan
from dalembert.study.loader import StudyError
from dalembert.study.study import Study


@dataclass(frozen=True)
class Mistake:
    """What is wrong at a place of a study's text.

    Parameters
    ----------
    place : tuple of str or int
        Tables, keys and numbers of entries; empty if only the line is known.
    line : int
        From 1.
    sentence : str
    """

    place: Place
    line: int
    sentence: str


@dataclass(frozen=True)
class Reading:
    """A text and the study that it is.

    Parameters
    ----------
    text : str
    study : Study, optional
        None if there are mistakes.
    does : str
        What a run of the study does, as a sentence; empty if there are mistakes.
    mistakes : tuple of Mistake
    """

    text: str
    study: Study | None = None
    does: str = ""
    mistakes: tuple[Mistake, ...] = ()


def read(path: Path, text: str) -> Reading:
    """Read a text as the study of a path, without writing to its folder."""
    with tempfile.TemporaryDirectory() as folder:
        draft = Path(folder) / path.name
        try:
            draft.write_text(text, encoding="utf-8")
            study = load(draft, name=path.stem, folder=path.parent)
            return Reading(text, study, f"It {plan(study)}.")
        except StudyError as error:
            found = [Mistake(place, line_of(text, place), sentence) for place, sentence in error.mistakes]
            return Reading(text, mistakes=tuple(found))
        except DalembertError as error:
            sentence = str(error).replace(f"{draft}: ", "").replace(f"{draft}", path.name)
            return Reading(text, mistakes=(Mistake((), _line_in(sentence, text), sentence),))


def _line_in(sentence: str, text: str) -> int:
    """The line that a sentence of the TOML reader names."""
    if "(at end of document)" in sentence:
        return max(1, len(text.splitlines()))
    found = re.search(r"\bline (\d+)", sentence)
    return int(found[1]) if found else 1
