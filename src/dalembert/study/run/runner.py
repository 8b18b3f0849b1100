"""Run a study in a folder of its own: events while it runs, then a result and a report, and its state throughout."""

import os
import traceback
from collections.abc import Callable, Iterator, Sequence
from contextlib import suppress
from dataclasses import replace
from math import inf
from pathlib import Path
from time import monotonic, perf_counter

from dalembert import __version__
from dalembert.errors import DalembertError, InputError, SolveError, StorageError, not_begun, users_place
from dalembert.files import write_text
from dalembert.findings import stored_findings
from dalembert.forward import Checkpoint, Executor, connected
from dalembert.forward.cluster import noted, worker_versions
from dalembert.kernels.preparation import observed
from dalembert.study.run.computed_with import mixed_versions, refuse_other_sources, this_process
from dalembert.study.run.duration import StartFailed, duration, storage, timed, too_long
from dalembert.study.run.events import LOST, STORAGE, Event, EventLog, plain
from dalembert.study.run.folder import DAMAGED, FAILED, FINISHED, INPUT, INTERRUPTED, RUNNING, RunFolder, new_folder
from dalembert.study.run.interrupts import kept_interrupts
from dalembert.study.run.model_findings import model_findings
from dalembert.study.run.spoken import spoken
from dalembert.study.run.time_scales import time_scale_findings
from dalembert.study.run.validation import plan
from dalembert.study.tables.study import Study
from dalembert.study.tasks import TASKS, Outcome
from dalembert.study.text.functions import users_code
from dalembert.threads import one_thread
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
    with observed(_noting(compiled, listener)):
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


def _executed(
    study: Study,
    folder: RunFolder,
    beginning: str,
    listener: Listener | None,
    compiled: Sequence[Compilation] = (),
) -> Outcome:
    """Do what a study says in a folder that is held, and say so in its state and its events."""
    about = {"study": study.name, "title": study.title, "task": study.task, "version": __version__}
    with EventLog(folder.events, (listener,) if listener else ()) as log:
        earlier = float(folder.state().get("seconds") or 0.0) if folder.is_run else 0.0
        folder.set_state(RUNNING, **about, process=os.getpid(), seconds=earlier)
        folder.pause.unlink(missing_ok=True)
        began = perf_counter()
        try:
            log.emit(beginning, **about)
            folder.add_computed_with(this_process(versions()))
            for done, total in compiled:
                log.emit("run-compiling", done=done, total=total)
            with observed(lambda done, total, _: log.emit("run-compiling", done=done, total=total)):
                with (
                    kept_interrupts(),
                    connected(study.executor) as client,
                    noted(client, lambda workers: folder.add_computed_with(this_process(workers))),
                    Checkpoint(folder.checkpoint, lambda sentence: log.emit(LOST, message=sentence)) as checkpoint,
                    users_code(),
                    one_thread(),
                ):
                    for workers in [] if client is None else worker_versions(client):
                        folder.add_computed_with(this_process(workers))
                    task = TASKS[study.task]
                    study = replace(study, executor=client)
                    if task.keeps_responses and (size := storage(task.effort(study))):
                        log.emit(STORAGE, message=size)
                    outcome = task.run(replace(study, checkpoint=checkpoint), log.emit)
                outcome = _with_findings(outcome, folder)
                outcome.save(folder.result)
                outcome.report(folder.report)
        except BaseException as error:
            state, message = _ending(error)
            with suppress(StorageError):  # the error itself says it, and a run without a state was killed
                if state != INTERRUPTED and (not isinstance(error, DalembertError) or users_place(error.__cause__)):
                    write_text(folder.path / "error.txt", traceback.format_exc())
                log.emit("run-ended", state=state, message=message)
            with suppress(StorageError):  # the state may fit where the event does not
                folder.set_state(state, message=message, **about, seconds=_since(began, earlier))
            if isinstance(error, KeyboardInterrupt):
                raise Stopped(folder.path) from None
            raise
        state = FINISHED if outcome.success else FAILED
        ended = {"state": state, "message": outcome.status, "digests": folder.digests()}
        log.emit("run-ended", **ended, seconds=_since(began))
        findings = plain(stored_findings(outcome.findings))
        folder.set_state(**ended, best=outcome.best, findings=findings, **about, seconds=_since(began, earlier))
        folder.checkpoint.unlink(missing_ok=True)
    return outcome


def _since(began: float, earlier: float = 0.0) -> float:
    """Seconds since ``began``, a value of ``perf_counter``, and those that a run took before it was resumed."""
    return round(earlier + perf_counter() - began, 3)


def _noting(compiled: list[Compilation], listener: Listener | None) -> Callable[[int, int, str], None]:
    """Progress of compilation, noted for a log that does not exist yet, and passed on as events."""

    def progress(done: int, total: int, _: str) -> None:
        compiled.append((done, total))
        if listener is not None:
            listener({"event": "run-compiling", "done": done, "total": total})

    return progress


def looked(study: Study, limit: float = inf) -> Iterator[str]:
    """Yield sentences on how long a study takes and what comes out, from few simulations.

    Parameters
    ----------
    study : Study
    limit : float
        Seconds. What takes longer is left out, and a sentence says so.

    Raises
    ------
    DalembertError
        What the first simulations of a run would raise.
    """
    task, began = TASKS[study.task], monotonic()
    with users_code(), one_thread():
        yield from (f"Warning: {finding}" for finding in time_scale_findings(study))
        effort = task.effort(study)
        try:
            timing = timed(effort)
        except StartFailed as error:
            yield f"Warning: the simulation at the first guesses fails: {error}. Check the model or change the start."
            return
        yield duration(effort, timing)
        if size := storage(effort):
            yield size
        long = too_long(effort, timing)
        if long is not None:
            yield f"Warning: {long}"
        trials, count = task.trials(study), task.foresight(study)
        needed, left = (trials + count) * timing.each, limit - (monotonic() - began)
        if needed > left:
            yield (
                f"The check ends before its time limit, {spoken(limit)}: what it would simulate next takes "
                f"{spoken(needed)}. Raise --limit."
            )
            return
        if trials:
            plan(study, trials)
        if count:
            yield from task.foreseen(study)


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
    state = folder.state()
    if not folder.result.is_file():
        raise InputError(f"{folder.path} has no result: the run is {state['state']}; run its study again")
    study = folder.kept()
    for name, digest in (state.get("digests") or {}).items():
        folder.check(folder.path / name, digest)
    with users_code(), one_thread():
        _with_findings(TASKS[study.task].load(study, folder.result), folder).report(folder.report)
    return folder.report


def _with_findings(outcome: Outcome, folder: RunFolder) -> Outcome:
    known = outcome.findings
    of_run = (*mixed_versions(folder.computed_with()), *model_findings(outcome.study))
    return replace(outcome, of_run=tuple(finding for finding in of_run if finding not in known))


def _ending(error: BaseException) -> tuple[str, str]:
    if isinstance(error, KeyboardInterrupt):
        return INTERRUPTED, "stopped by the user"
    if isinstance(error, DalembertError):
        return (FAILED if isinstance(error, SolveError | StorageError) else INPUT), str(error)
    return FAILED, f"{type(error).__name__}: {error}"
