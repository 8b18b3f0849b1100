"""The picture of a study: its model, as it begins."""

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

from dalembert.errors import DalembertError, InputError
from dalembert.report.pictures import message_picture, picture
from dalembert.study.loader import load
from dalembert.study.tables.structure_builder import StructureBuilder
from dalembert.study.tables.study import Study


def picture_or_message(path: Path) -> str:
    """Return the picture of a study file, or one that says why there is none."""
    try:
        return study_picture(load(path)) or message_picture("No drawing: the model has no shape")
    except MemoryError:  # of the process that draws, which says so
        raise
    except DalembertError as error:
        what = "the study has errors" if isinstance(error, InputError) else "the model cannot be built"
        return message_picture(f"No drawing: {what}")
    except Exception as error:  # the user's function may raise anything
        return message_picture(f"No drawing: the model raised {type(error).__name__}")


def study_picture(study: Study, label: str | None = None) -> str | None:
    """Return the picture of a study's model as SVG; None for a model that has no shape, such as a Python function. The
    mechanism is assembled at the starts of the parameters. A structure is drawn before it is reduced. ``label``:
    description for screen readers.
    """
    if study.file.model.forward is not None:
        return None
    label = label or f"Drawing of the model: {study.title}"
    return picture(unreduced(study)(**study.parameters.mapping(study.parameters.start)), label)


def unreduced(study: Study) -> Callable[..., Any]:
    """Return the builder of the model, without what costs time and cannot be seen."""
    builder = study.builder
    if not isinstance(builder, StructureBuilder) or builder.model.structure is None:
        return builder
    table = builder.model.structure.model_copy(update={"reduction": None, "damping": None})
    return replace(builder, model=builder.model.model_copy(update={"structure": table}))
