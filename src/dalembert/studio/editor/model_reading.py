"""What a text is as the model of a study that names its file."""

from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

from dalembert.errors import DalembertError
from dalembert.studio.editor.cursor import tolerant
from dalembert.studio.editor.outline import Outline
from dalembert.studio.editor.reading import OF_FILES, Mistake, Reading, mistake
from dalembert.studio.editor.watched_files import stamps_of
from dalembert.studio.worker import Kept

if TYPE_CHECKING:
    from dalembert.study import Study
    from dalembert.study.loader import StudyError

_AT_FILE = "[model], file: "


def model_reading(kept: Kept, study: Path, text: str) -> Reading:
    """Read a text as the model of a study, in the process of the model's page. ``study`` is the study file, as it is on
    the disk; ``text`` is that of the model file, which is not written.
    """
    for kind in OF_FILES:
        kept.drop(kind)
    used: dict[str, Path] = {}
    return replace(_read(kept, study, text, used), files=stamps_of([study, *used.values()]))


def study_with_model(kept: Kept, study: Path, text: str, used: dict[str, Path] | None = None) -> "Study":
    """Return a study with the text of its model file, read once. ``used`` takes the other files that the study names,
    if it is read now.
    """
    from dalembert.study import load

    return kept.newest("study", (study, text), lambda: load(study, name=study.stem, model=text.encode(), used=used))


def _read(kept: Kept, study: Path, text: str, used: dict[str, Path]) -> Reading:
    from dalembert.study import plan
    from dalembert.study.loader import StudyError
    from dalembert.study.run.model_findings import model_findings

    try:
        study_here = study_with_model(kept, study, text, used)
        does = f"As the model of {study.name}, it {plan(study_here)}."
        return Reading(text, Outline.of(study_here, text), does, model_findings(study_here))
    except StudyError as error:
        return Reading(text, mistakes=tuple(_mistakes(error, study, text)))
    except DalembertError as error:
        return Reading(text, mistakes=(mistake(text, (), str(error).replace(f"{study.parent}/", "")),))


def _mistakes(error: "StudyError", study: Path, text: str) -> Iterator[Mistake]:
    """Mistakes of the text at their lines; those of the study at the first line, with its name."""
    tables = tolerant(text)
    for place, sentence in error.mistakes:
        shown = sentence.replace(f"{study.parent}/", "")
        if shown.startswith(_AT_FILE):
            yield mistake(text, (), shown.removeprefix(_AT_FILE))
        elif place[:1] == ("model",) or (place[:1] == ("constants",) and "constants" in tables):
            yield mistake(text, place, shown)
        else:
            yield Mistake((), 1, f"{study.name}: {shown}")
