"""The picture of a study: its model, as it begins."""

from dataclasses import replace

from dalembert.report.pictures import picture
from dalembert.study.structure_builder import StructureBuilder
from dalembert.study.study import Study


def study_picture(study: Study, label: str | None = None) -> str | None:
    """Return the picture of a study's model as SVG; None for a model that has no shape, such as a Python function.

    The mechanism is assembled at the starts of the parameters. A structure is drawn before it is reduced.

    Parameters
    ----------
    study : Study
    label : str, optional
        Description for screen readers.

    Raises
    ------
    ModelError
        Where the mechanism cannot be assembled.
    """
    if study.file.model.forward is not None:
        return None
    label = label or f"Drawing of the model: {study.title}"
    return picture(_unreduced(study)(**study.parameters.mapping(study.parameters.start)), label)


def _unreduced(study: Study):
    """The builder of the model, without what costs time and cannot be seen."""
    builder = study.builder
    if not isinstance(builder, StructureBuilder) or builder.model.structure is None:
        return builder
    table = builder.model.structure.model_copy(update={"reduction": None, "damping": None})
    return replace(builder, model=builder.model.model_copy(update={"structure": table}))
