"""Run a study in a new folder: its events, its state, its result and its report."""

import os
import traceback
from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, replace
from pathlib import Path
from time import perf_counter
from typing import Any

from dalembert import __version__
from dalembert.errors import DalembertError, InputError, SolveError, StorageError, not_begun, users_place
from dalembert.files import write_text
from dalembert.findings import stored_findings
from dalembert.forward import Checkpoint, Executor, connected
from dalembert.forward.cluster import noted, worker_versions
from dalembert.kernels.preparation import observed
from dalembert.study.run.computed_with import mixed_versions, refuse_other_sources, this_process
from dalembert.study.run.duration import storage
from dalembert.study.run.events import LOST, STORAGE, Event, EventLog, plain
from dalembert.study.run.folder import DAMAGED, FAILED, FINISHED, INPUT, INTERRUPTED, RUNNING, RunFolder, new_folder
from dalembert.study.run.interrupts import kept_interrupts
from dalembert.study.run.model_findings import model_findings
from dalembert.study.run.validation import plan
from dalembert.study.tables.study import Study
from dalembert.study.tasks import TASKS, Outcome
from dalembert.study.text.functions import users_code
from dalembert.threads import single_thread
from dalembert.versions import versions

Listener = Callable[[Event], None]
Compilation = tuple[int, int]  # how many kernels are compiled, of how many


class Stopped(KeyboardInterrupt):
    """The user stopped a run; its argument is the run's folder."""


def run_study(
    study: Study,
    out: Path | None = None,
    *,
    force: bool = False,
    listener: Listener | None = None,
    executor: Executor = None,
) -> tuple[RunFolder, Outcome]:
    """Run the task of a study in a new folder.

    The run checks its plan, keeps the study and its files, computes, and writes the result and the report.

    Parameters
    ----------
    study : Study
    out : Path, optional
        Folder of the run; ``runs/<name>``, or that with the next free number, if not given.
    force : bool
        Replace the run that is there.
    listener : callable, optional
        Called with each event.
    executor : str or distributed.Client, optional
        Address of a Dask cluster, or a client of one, to which batches of simulations go.

    Returns
    -------
    RunFolder, Outcome

    Raises
    ------
    DalembertError
        What is wrong with the study, before there is a folder; or what stopped the run, as the folder's state says.
    """
    compiled: list[Compilation] = []

    def note(done: int, total: int, _: str) -> None:
        compiled.append((done, total))  # for the log, which does not exist yet
        if listener is not None:
            listener({"event": "run-compiling", "done": done, "total": total})

    with observed(note):
        plan(study)
    with connected(executor) as client:
        folder = new_folder(study.name, out, force=force)
        try:
            with folder.locked():
                folder.keep(study)
                return folder, _executed(replace(study, executor=client), folder, "run-started", listener, compiled)
        except StorageError as error:
            raise error if folder.is_run else not_begun(error) from None


def resume_run(folder: RunFolder, *, listener: Listener | None = None, executor: Executor = None) -> Outcome:
    """Resume a run that was killed, stopped or failed; the result is that of a run without interruption.

    The study repeats its computations. Responses that the model returned before come from the checkpoint.

    Parameters
    ----------
    folder : RunFolder
    listener : callable, optional
        Called with each event, those of before included.
    executor : str or distributed.Client, optional
        As in :func:`run_study`; it may differ from that of the start.

    Raises
    ------
    InputError
        If the run has finished, is active, or was started with another version of the package.
    DalembertError
        What stopped the run; the folder's state says the same.
    """
    state = folder.state()
    if state["state"] == RUNNING:
        raise InputError(f"{folder.path}: the run is active; wait for it, or stop it")
    if state["state"] == DAMAGED:
        raise folder.damaged(folder.path / "state.json")
    if state["state"] == FINISHED:
        raise InputError(
            f"{folder.path}: the run has finished, so there is nothing to resume; write its report again with "
            f"'dalembert report {folder.path}'"
        )
    if state.get("version") != __version__:
        raise InputError(
            f"{folder.path}: the run was begun with dalembert {state.get('version')}, and this is {__version__}: what "
            "both compute may differ; run the study again, or resume it with the version that began it"
        )
    refuse_other_sources(folder)
    with folder.locked():
        folder.tidy()
        return _executed(replace(folder.kept(), executor=executor), folder, "run-resumed", listener)


@dataclass(frozen=True, eq=False)
class Attempt:
    """The part of a run that one process computes, from its start or from where it is resumed. ``folder``: locked;
    ``facts``: of the study, for the first event and for the state of the run; ``earlier``: seconds that the run took
    before it was resumed; ``began``: value of ``perf_counter`` at its start.
    """

    study: Study
    folder: RunFolder
    log: EventLog
    facts: Mapping[str, Any]
    earlier: float
    began: float

    def seconds(self, earlier: float = 0.0) -> float:
        """Return the seconds since the start, and those before it."""
        return round(earlier + perf_counter() - self.began, 3)

    def keep_state(self, state: str, **details: Any) -> None:
        """Write the state of the run after this part of it."""
        self.folder.set_state(state, **details, **self.facts, seconds=self.seconds(self.earlier))


def _executed(
    study: Study,
    folder: RunFolder,
    first_event: str,
    listener: Listener | None,
    compiled: Sequence[Compilation] = (),
) -> Outcome:
    """Start, compute, write, end: the run of a study in a locked folder."""
    with EventLog(folder.events, (listener,) if listener else ()) as log:
        facts = {"study": study.name, "title": study.title, "task": study.task, "version": __version__}
        earlier = float(folder.state().get("seconds") or 0.0) if folder.is_run else 0.0
        folder.set_state(RUNNING, **facts, process=os.getpid(), seconds=earlier)
        folder.pause.unlink(missing_ok=True)
        attempt = Attempt(study, folder, log, facts, earlier, perf_counter())
        try:
            log.emit(first_event, **attempt.facts)
            folder.add_computed_with(this_process(versions()))
            for done, total in compiled:
                log.emit("run-compiling", done=done, total=total)
            with observed(lambda done, total, _: log.emit("run-compiling", done=done, total=total)):
                outcome = _with_findings(_computed(attempt), folder)
                outcome.save(folder.result)
                outcome.report(folder.report)
        except BaseException as error:
            _end_by(error, attempt)
            if isinstance(error, KeyboardInterrupt):
                raise Stopped(folder.path) from None
            raise
        _end(outcome, attempt)
    return outcome


def _computed(attempt: Attempt) -> Outcome:
    study, folder, log = attempt.study, attempt.folder, attempt.log
    with (
        kept_interrupts(),
        connected(study.executor) as client,
        noted(client, lambda workers: folder.add_computed_with(this_process(workers))),
        Checkpoint(folder.checkpoint, lambda sentence: log.emit(LOST, message=sentence)) as checkpoint,
        users_code(),
        single_thread(),
    ):
        for workers in [] if client is None else worker_versions(client):
            folder.add_computed_with(this_process(workers))
        task = TASKS[study.task]
        study = replace(study, executor=client)
        if task.keeps_responses and (size := storage(task.effort(study))):
            log.emit(STORAGE, message=size)
        return task.run(replace(study, checkpoint=checkpoint), log.emit)


def _end(outcome: Outcome, attempt: Attempt) -> None:
    folder = attempt.folder
    state = FINISHED if outcome.success else FAILED
    ended = {"state": state, "message": outcome.status, "digests": folder.digests()}
    attempt.log.emit("run-ended", **ended, seconds=attempt.seconds())
    attempt.keep_state(**ended, best=outcome.best, findings=plain(stored_findings(outcome.findings)))
    folder.checkpoint.unlink(missing_ok=True)


def _end_by(error: BaseException, attempt: Attempt) -> None:
    """Write the state and the last event of a run that an error ends."""
    if isinstance(error, KeyboardInterrupt):
        state, message = INTERRUPTED, "stopped by the user"
    elif isinstance(error, DalembertError):
        state, message = FAILED if isinstance(error, SolveError | StorageError) else INPUT, str(error)
    else:
        state, message = FAILED, f"{type(error).__name__}: {error}"
    with suppress(StorageError):  # the error itself says it, and a run without a state was killed
        if state != INTERRUPTED and (not isinstance(error, DalembertError) or users_place(error.__cause__)):
            write_text(attempt.folder.path / "error.txt", traceback.format_exc())
        attempt.log.emit("run-ended", state=state, message=message)
    with suppress(StorageError):  # the state may fit where the event does not
        attempt.keep_state(state, message=message)


def unknowns(study: Study) -> tuple[str, ...]:
    """Names of the values in the events of a run."""
    return TASKS[study.task].unknowns(study)


def report_run(folder: RunFolder) -> Path:
    """Write a run's report anew, from its result.

    Raises
    ------
    InputError
        If the folder is no run's, or the run has no result.
    """
    state = folder.state()
    if not folder.result.is_file():
        raise InputError(f"{folder.path} has no result: the run is {state['state']}; run its study again")
    study = folder.kept()
    for name, digest in (state.get("digests") or {}).items():
        folder.check(folder.path / name, digest)
    with users_code(), single_thread():
        _with_findings(TASKS[study.task].load(study, folder.result), folder).report(folder.report)
    return folder.report


def _with_findings(outcome: Outcome, folder: RunFolder) -> Outcome:
    known = outcome.findings
    of_run = (*mixed_versions(folder.computed_with()), *model_findings(outcome.study))
    return replace(outcome, of_run=tuple(finding for finding in of_run if finding not in known))
