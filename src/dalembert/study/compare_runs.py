"""Runs of several models of the same data, ranked by how well they predict."""

from collections.abc import Sequence
from typing import TYPE_CHECKING

from dalembert.errors import DataError, InputError
from dalembert.study.folder import RunFolder

if TYPE_CHECKING:
    from dalembert.inverse import Fit, ModelComparison


def compare_runs(folders: Sequence[RunFolder], leave_out: str | None = None) -> "ModelComparison":
    """Return the comparison of the fits of runs, by the names of their folders.

    Parameters
    ----------
    folders : sequence of RunFolder
    leave_out : {"values", "blocks", "experiments"}, optional
        See :func:`dalembert.inverse.compare_models`.

    Raises
    ------
    InputError
        For a run that is no identification, two runs of one name, and fits that cannot be compared.
    """
    from dalembert.inverse import compare_models

    fits: dict[str, Fit] = {}
    for folder in folders:
        name = folder.path.name if folder.path.name not in fits else str(folder.path)
        fits[name] = fit_of(folder)
    return compare_models(fits, leave_out=leave_out)


def fit_of(folder: RunFolder) -> "Fit":
    """Return the fit of a run.

    Raises
    ------
    InputError
        For a run without a result, or of another task.
    """
    from dalembert.inverse import Fit

    try:
        return Fit.load(folder.result)
    except DataError:
        raise InputError(
            f"run {folder.path.name!r} has no fit to samples; compare runs of the task [identify]"
        ) from None
