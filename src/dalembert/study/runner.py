"""Run a study in a folder of its own: events while it runs, then a result and a report, and its state throughout."""

import traceback
from collections.abc import Callable
from pathlib import Path
from time import perf_counter

from dalembert import __version__
from dalembert.errors import DalembertError, InputError, SolveError
from dalembert.files import write_text
from dalembert.study.duration import duration
from dalembert.study.events import Event, EventLog
from dalembert.study.folder import FAILED, FINISHED, INPUT, INTERRUPTED, RUNNING, RunFolder, new_folder
from dalembert.study.study import Study
from dalembert.study.tasks import TASKS, Outcome

Listener = Callable[[Event], None]


def run_study(
    study: Study,
    out: Path | None = None,
    *,
    force: bool = False,
    listener: Listener | None = None,
) -> tuple[RunFolder, Outcome]:
    """Do what a study says.

    Parameters
    ----------
    study : Study
    out : Path, optional
        Folder of the run; ``runs/<name>``, or that with the next free number, if not given.
    force : bool
        Replace the run that is there.
    listener : callable, optional
        Called with each event.

    Returns
    -------
    RunFolder, Outcome

    Raises
    ------
    DalembertError
        What stopped the run; the folder's state says the same.
    """
    folder = new_folder(study.name, out, force=force)
    about = {"study": study.name, "title": study.title, "task": study.task, "version": __version__}
    with folder.locked(), EventLog(folder.events, (listener,) if listener else ()) as log:
        folder.keep(study)
        folder.set_state(RUNNING, **about)
        began = perf_counter()
        try:
            log.emit("run-started", **about)
            outcome = TASKS[study.task].run(study, log.emit)
            outcome.save(folder.result)
            outcome.report(folder.report)
        except BaseException as error:
            state, message = _ending(error)
            if state == FAILED and not isinstance(error, DalembertError):
                write_text(folder.path / "error.txt", traceback.format_exc())
            log.emit("run-ended", state=state, message=message)
            folder.set_state(state, message=message, **about)
            raise
        state = FINISHED if outcome.success else FAILED
        log.emit("run-ended", state=state, message=outcome.status, seconds=round(perf_counter() - began, 3))
        folder.set_state(state, message=outcome.status, best=outcome.best, **about)
    return folder, outcome


def plan(study: Study) -> str:
    """What a study would run, in a sentence; the model is built once, so that it is known to be well posed."""
    return TASKS[study.task].plan(study)


def takes(study: Study) -> str:
    """About how long a study would take, from one timed evaluation, in a sentence."""
    return duration(TASKS[study.task].effort(study))


def foreseen(study: Study) -> tuple[str, ...]:
    """Sentences on what a study would tell, from a look at its first guesses."""
    return TASKS[study.task].foreseen(study)


def unknowns(study: Study) -> tuple[str, ...]:
    """Names of the values that the events of a run tell."""
    return TASKS[study.task].unknowns(study)


def report_run(folder: RunFolder) -> Path:
    """Write a run's report anew, from its result.

    Raises
    ------
    InputError
        If the folder is no run's, or the run has no result.
    """
    state = folder.state()["state"]
    if not folder.result.is_file():
        raise InputError(f"{folder.path} has no result: the run is {state}; run its study again")
    study = folder.kept()
    TASKS[study.task].load(study, folder.result).report(folder.report)
    return folder.report


def _ending(error: BaseException) -> tuple[str, str]:
    """State and message of a run that an error ended."""
    if isinstance(error, KeyboardInterrupt):
        return INTERRUPTED, "stopped by the user"
    if isinstance(error, DalembertError):
        return (FAILED if isinstance(error, SolveError) else INPUT), str(error)
    return FAILED, f"{type(error).__name__}: {error}"
