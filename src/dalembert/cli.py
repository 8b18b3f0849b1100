"""The command line: ``dalembert new | run | resume | check | list | report | compare | studio | compile | schema``.

Exit codes: 0 done, 1 the solver could not, 2 the input is wrong, 130 stopped by the user.
"""

import os
import sys
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, NoReturn, TextIO

import typer
from typer.core import TyperGroup

from dalembert import __version__

if TYPE_CHECKING:
    from rich.console import Console

    from dalembert.study.run.folder import RunFolder
    from dalembert.study.tasks.task import Outcome


class _Commands(TyperGroup):
    """Commands whose errors become sentences and exit codes."""

    def invoke(self, ctx: Any) -> Any:
        with _exit_codes():
            return super().invoke(ctx)


app = typer.Typer(
    name="dalembert",
    cls=_Commands,
    help="Simulate mechanical systems, identify their parameters from measured motion, and bound what is uncertain.",
    no_args_is_help=True,
    pretty_exceptions_enable=False,
    context_settings={"help_option_names": ["-h", "--help"]},
)

DONE, SOLVER_COULD_NOT, INPUT_WRONG, STOPPED = 0, 1, 2, 130

StudyFile = Annotated[Path, typer.Argument(metavar="STUDY.toml", help="The study file.", show_default=False)]
Run = Annotated[
    Path, typer.Argument(metavar="RUN", help="Folder of the run, or its name in runs/.", show_default=False)
]

Cluster = Annotated[
    str | None,
    typer.Option(metavar="ADDRESS", help="Scheduler of a Dask cluster for the simulations: tcp://HOST:8786."),
]


def main() -> None:
    """Run the command line."""
    app()


def _version(wanted: bool) -> None:
    if wanted:
        typer.echo(f"dalembert {__version__}")
        raise typer.Exit


Version = Annotated[bool, typer.Option("--version", help="Show the version.", is_eager=True, callback=_version)]


@app.callback()
def _options(version: Version = False) -> None:
    pass


@app.command()
def new(
    template: Annotated[
        str | None,
        typer.Argument(metavar="TEMPLATE", help="The template; if it is left out, all are listed.", show_default=False),
    ] = None,
    folder: Annotated[
        Path | None,
        typer.Argument(metavar="FOLDER", help="New folder for the study; by default it has the name of the template."),
    ] = None,
) -> None:
    """Create a study from a template."""
    from dalembert.study.template import begin, templates

    if template is None:
        for entry in templates().values():
            typer.echo(f"{entry.name:10}{entry.title}: {entry.description}")
        typer.echo("Create a study with: dalembert new TEMPLATE FOLDER")
    else:
        typer.echo(f"Run it with: dalembert run {begin(template, folder or Path(template))}")


@app.command()
def run(
    study: Annotated[
        Path,
        typer.Argument(
            metavar="STUDY.toml", help="The study file, or the folder of a run to repeat.", show_default=False
        ),
    ],
    out: Annotated[
        Path | None,
        typer.Option(help="Folder of the run. By default runs/NAME, or NAME-2 and so on if that is taken."),
    ] = None,
    force: Annotated[bool, typer.Option("--force", help="Replace the run that is in the folder.")] = False,
    seed: Annotated[int | None, typer.Option(min=0, help="Seed of all random numbers, instead of the study's.")] = None,
    cluster: Cluster = None,
) -> None:
    """Run the task of a study in a new run folder."""
    from dalembert.study import RunFolder, load, run_study
    from dalembert.study.run.progress import Watch
    from dalembert.study.run.runner import unknowns

    _begin(cluster)
    read = RunFolder(study).kept() if RunFolder(study).is_run else load(study)
    if seed is not None:
        read = read.with_seed(seed)
    with Watch(_console(sys.stderr, soft_wrap=True), unknowns(read)) as watch:
        folder, outcome = run_study(read, out, force=force, listener=watch, executor=cluster)
    _ended(folder, outcome)


@app.command()
def resume(run: Run, cluster: Cluster = None) -> None:
    """Continue a run that was killed or stopped. The result has the same bits as without the interruption."""
    from dalembert.study import resume_run
    from dalembert.study.run.progress import Watch
    from dalembert.study.run.runner import unknowns

    _begin(cluster)
    folder = _folder(run)
    with Watch(_console(sys.stderr, soft_wrap=True), unknowns(folder.kept())) as watch:
        outcome = resume_run(folder, listener=watch, executor=cluster)
    _ended(folder, outcome)


@app.command()
def check(
    study: StudyFile,
    limit: Annotated[float, typer.Option(min=0, metavar="SECONDS", help="Time for simulations.")] = 30.0,
) -> None:
    """Check a study, list the channels of its mechanism, and estimate the number of simulations and the time."""
    from dalembert.errors import ModelError
    from dalembert.study import load, plan
    from dalembert.study.channels import channel_lines
    from dalembert.study.run.duration import within
    from dalembert.study.run.model_findings import model_lines
    from dalembert.study.run.progress import duration_text
    from dalembert.study.run.validation import forecast
    from dalembert.study.sources import source_lines
    from dalembert.study.text.table import placed

    read = load(study)
    with placed(study.name), placed(study.name, ModelError):
        typer.echo(f"{study}: valid; it {plan(read)}")
        for line in (*model_lines(read), *source_lines(read), *channel_lines(read)):
            typer.echo(line)
        try:
            for sentence in within(limit, lambda: forecast(read, limit)):
                typer.echo(sentence)
        except TimeoutError:
            typer.echo(f"The check ends at its time limit, {duration_text(limit)}, during a simulation. Raise --limit.")
            _leave(DONE)
        except KeyboardInterrupt:
            typer.echo("stopped", err=True)
            _leave(STOPPED)
        except BrokenPipeError:
            _leave(DONE)


@app.command("list")
def list_runs(
    runs: Annotated[Path, typer.Option(help="Folder that holds the runs.")] = Path("runs"),
) -> None:
    """List the runs with their states and best values."""
    from dalembert.study.run.listing import rows, table

    runs_listed = rows(runs)
    if not runs_listed:
        typer.echo(f"no runs in {runs}")
    else:
        _console(sys.stdout, width=None if sys.stdout.isatty() else 200).print(table(runs_listed))


@app.command()
def report(run: Run) -> None:
    """Write the report of a run again from its result."""
    from dalembert.study import report_run

    typer.echo(f"report: {report_run(_folder(run))}")


@app.command()
def compare(
    runs: Annotated[
        list[Path],
        typer.Argument(metavar="RUN...", help="Folders of runs, or their names in runs/.", show_default=False),
    ],
    out: Annotated[Path, typer.Option(help="File of the report.")] = Path("comparison.html"),
    leave_out: Annotated[
        str | None, typer.Option(metavar="WHAT", help="What is predicted from all else: values, blocks or experiments.")
    ] = None,
) -> None:
    """Rank identified models of the same data by their predictions, and report if the difference means nothing."""
    from dalembert.study.run.compare_runs import compare_runs

    comparison = compare_runs([_folder(run) for run in runs], leave_out)
    typer.echo(comparison.summary())
    typer.echo(f"report: {comparison.report(out)}")


@app.command()
def studio(
    folder: Annotated[
        Path, typer.Argument(help="Folder with studies/ and runs/, which are created if they do not exist.")
    ] = Path(),
    host: Annotated[
        str, typer.Option(help="Address to listen at; beyond this machine a token is needed.")
    ] = "127.0.0.1",
    port: Annotated[int, typer.Option(min=0, max=65535, help="Port; 0 selects a free one.")] = 8080,
    token: Annotated[str, typer.Option(help="Secret that a browser needs; created if it is left out.")] = "",
    browser: Annotated[bool, typer.Option(help="Open the page in a browser.")] = True,
) -> None:
    """Edit, start, watch and compare studies and runs in a browser."""
    from dalembert.errors import InputError

    try:
        import nicegui  # noqa: F401
    except ImportError:
        raise InputError(
            "the studio needs NiceGUI, which is not installed; run: pip install 'dalembert[studio]'"
        ) from None
    if not folder.is_dir():
        raise InputError(f"there is no folder {folder}; make it, or name another")
    from dalembert.studio.processes import prepare

    prepare()  # while this process imports the pages
    from dalembert.studio import serve

    serve(folder, host, port, token, browser)


@app.command("compile")
def compile_(
    vectors: Annotated[
        bool, typer.Option("--all", help="Also compile what computes eight samples or derivatives side by side.")
    ] = False,
) -> None:
    """Compile the usual kernels now on all cores, for example for an image or the shared disk of a cluster.

    Batches, fits of three and more parameters, and rare components compile the others when they first need them.
    """
    from dalembert.kernels.everything import package_kernels
    from dalembert.kernels.objects import cache_folder
    from dalembert.kernels.preparation import prepare

    kernels = package_kernels(vectors)
    prepare(kernels)
    typer.echo(f"{len(kernels)} kernels are ready in {cache_folder()}")


@app.command()
def schema() -> None:
    """Print the JSON schema of study files, for editors."""
    from dalembert.study.schema import schema_text

    typer.echo(schema_text(), nl=False)


def _console(stream: TextIO, **options: Any) -> "Console":
    from rich.console import Console

    class Unread(Console):
        def on_broken_pipe(self) -> None:
            self.quiet = True
            _without_reader()

    return Unread(file=stream, **options)


def _ended(folder: "RunFolder", outcome: "Outcome") -> None:
    try:
        typer.echo("\n".join([outcome.summary, *map(str, outcome.of_run)]))
        typer.echo(f"report: {folder.report}")
    except BrokenPipeError:
        _without_reader()
    if not outcome.success:
        raise typer.Exit(SOLVER_COULD_NOT)


def _folder(run: Path) -> "RunFolder":
    from dalembert.errors import InputError, unknown
    from dalembert.study.run.folder import RunFolder, find_runs

    named = RunFolder(Path("runs") / run)
    if run.exists():
        return RunFolder(run)
    if named.is_run:
        return named
    root = Path("runs") if run.parent == Path() else run.parent
    sentence = unknown("run", run.name, [folder.path.name for folder in find_runs(root)], f"folder {root}")
    raise InputError(f"{sentence}{'' if sentence.endswith('?') else '.'} 'dalembert list' shows all")


@contextmanager
def _exit_codes() -> Iterator[None]:
    from dalembert.errors import DalembertError, SolveError, StorageError

    try:
        yield
    except DalembertError as error:
        code = SOLVER_COULD_NOT if isinstance(error, SolveError | StorageError) else INPUT_WRONG
        _complain(str(error), code)
    except KeyboardInterrupt as stop:
        _complain(f"stopped; continue by: dalembert resume {stop.args[0]}" if stop.args else "stopped", STOPPED)
    except BrokenPipeError:
        _without_reader()
        raise typer.Exit(DONE) from None
    except OSError as error:
        _complain(f"{error.strerror or error}: {error.filename or 'a file of the run'}", SOLVER_COULD_NOT)


def _without_reader() -> None:
    nowhere = os.open(os.devnull, os.O_WRONLY)
    for stream in (sys.stdout, sys.stderr):
        try:
            stream.flush()
        except BrokenPipeError:
            os.dup2(nowhere, stream.fileno())


def _leave(code: int) -> NoReturn:
    with suppress(BrokenPipeError):
        sys.stdout.flush()
    os._exit(code)


def _complain(message: str, code: int) -> None:
    typer.echo(message, err=True)
    raise typer.Exit(code)


def _begin(cluster: str | None) -> None:
    import logging
    import signal

    def stop(number: int, frame: object) -> None:
        raise KeyboardInterrupt

    signal.signal(signal.SIGTERM, stop)
    if cluster is not None:
        logging.disable(logging.ERROR)  # the error that ends the run says that a cluster is lost


if __name__ == "__main__":
    sys.exit(main())
