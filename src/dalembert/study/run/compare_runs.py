"""Runs of several models of the same data, ranked by how well they predict."""

from collections.abc import Sequence
from contextlib import suppress
from typing import TYPE_CHECKING

from dalembert.errors import DataError, InputError
from dalembert.study.run.folder import RunFolder
from dalembert.threads import single_thread

if TYPE_CHECKING:
    from dalembert.inverse import Fit, ModelComparison, Posterior


def compare_runs(folders: Sequence[RunFolder], leave_out: str | None = None) -> "ModelComparison":
    """Return the comparison of the fits or posteriors of runs, by the names of their folders; ``leave_out`` as in
    :func:`dalembert.inverse.compare_models`.
    """
    from dalembert.inverse import compare_models

    results: dict[str, Fit | Posterior] = {}
    for folder in folders:
        name = folder.path.name if folder.path.name not in results else str(folder.path)
        results[name] = fit_or_posterior(folder)
    with single_thread():
        return compare_models(results, leave_out=leave_out)


def fit_or_posterior(folder: RunFolder) -> "Fit | Posterior":
    """Return the fit or the posterior of a run."""
    from dalembert.inverse import Fit, Posterior

    for kind in (Fit, Posterior):
        with suppress(DataError):
            return kind.load(folder.result)
    raise InputError(
        f"run {folder.path.name!r} has no fit to samples and no posterior; compare runs of the task [identify], or of "
        "the task [sample]"
    )
