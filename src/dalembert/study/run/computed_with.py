"""What computed a run: versions and threads of linear algebra, and what is doubtful where they differ."""

from collections.abc import Iterator, Mapping, Sequence
from typing import Any

from dalembert.errors import InputError
from dalembert.findings import Finding
from dalembert.study.run.folder import RunFolder
from dalembert.threads import THREADS
from dalembert.versions import PACKAGES, difference, versions


def this_process(versions: Mapping[str, str]) -> dict[str, Any]:
    """Return the record of a process that computes a part of a run."""
    return {**versions, "linear_algebra_threads": THREADS}


def refuse_other_sources(folder: RunFolder) -> None:
    """Refuse to resume a run that other source files of the package began."""
    for process in folder.computed_with():
        if changes := difference(versions(), process):
            raise InputError(
                f"{folder.path}: this is {changes} as at the start of the run: what both compute may differ; run the "
                "study again, or resume it with the version that began it"
            )


def mixed_versions(processes: Sequence[Mapping[str, Any]]) -> Iterator[Finding]:
    """Yield the findings about packages of which a run had several versions."""
    for package in PACKAGES:
        versions_seen = list(dict.fromkeys(str(process[package]) for process in processes))
        if len(versions_seen) > 1:
            several = ", ".join(versions_seen)
            yield Finding(
                "mixed-versions",
                "warning",
                {"package": package, "versions": several},
                f"Parts of the run were computed with different versions of {package}: {several}. The last digits of "
                "the result may differ from those of one version.",
                "Install one version on all machines. Run the study again if you need the same bits.",
            )
