"""Runs the examples of README.md and of the documentation, notebooks too, each file's in one empty folder."""

import doctest
import os
import shlex
import subprocess
import sys
import tomllib
from collections.abc import Iterator
from pathlib import Path

import pytest
from notebook_text import markdown
from sybil import Document, Example, Sybil
from sybil.parsers.markdown import CodeBlockParser, PythonCodeBlockParser, SkipParser

collect_ignore = ["docs/conf.py", "docs/mathml.py"]
"""It is Sphinx's, which the tests do without."""
SLOW_PAGES = {"posterior.md", "raw-records.md", "real-measurements.md", "ten-minutes.md"}
"""Pages whose examples take more than ten seconds: `make verify` runs them."""
LONG_TESTS = frozenset((Path(__file__).parent / "tests" / "long_tests.txt").read_text().splitlines())
"""Tests that take more than a second, which `tools/long_tests.py` lists: `make verify` runs them."""


@pytest.hookimpl(tryfirst=True)
def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    for item in items:
        if item.path.name in SLOW_PAGES or item.nodeid in LONG_TESTS:
            item.add_marker("slow")


@pytest.fixture(scope="module")
def empty_folder(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Path]:
    with pytest.MonkeyPatch.context() as patch:
        folder = tmp_path_factory.mktemp("example")
        patch.chdir(folder)
        yield folder


def check_study(example: Example) -> str | None:
    """What ``dalembert check`` has to say against a study file; its data files are made up where there are none."""
    file = Path("study.toml")
    file.write_text(example.parsed)
    study = tomllib.loads(example.parsed)
    for data in (study.get("data"), *study.get("experiments", ())):
        if not data or Path(data["file"]).exists():
            continue
        columns = [data.get("time", "t"), *data["columns"].values()]
        rows = [",".join(columns), *(",".join([str(time)] * len(columns)) for time in (0.0, 0.5, 1.0))]
        Path(data["file"]).write_text("\n".join(rows))
    code, output = outcome("dalembert check study.toml")
    return None if code == 0 else f"dalembert check ended with {code}:\n{output}"


def outcome(command: str) -> tuple[int, str]:
    """Exit code and output of a command of this environment, on a terminal of 120 columns."""
    name, *arguments = shlex.split(command)
    run = subprocess.run(
        [Path(sys.executable).with_name(name), *arguments],
        check=False,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
        env={**os.environ, "COLUMNS": "120"},
    )
    return run.returncode, run.stdout


def check_session(example: Example) -> str | None:
    """What differs from a session on a terminal: a line ``$ command``, then what it prints, ``...`` for any text.

    A command must end with 0, unless what it prints is shown.
    """
    for part in example.parsed.removeprefix("$ ").split("\n$ "):
        command, _, shown = part.partition("\n")
        code, output = outcome(command)
        flags = doctest.ELLIPSIS | doctest.NORMALIZE_WHITESPACE
        same = doctest.OutputChecker().check_output(shown, output, flags) if shown.strip() else code == 0
        if not same:
            return f"'{command}' ended with {code} and printed\n{output}where the page shows\n{shown}"
    return None


class Notebook(Document):
    """A notebook, parsed as the Markdown of its cells."""

    def __init__(self, text: str, path: str) -> None:
        super().__init__(markdown(text), path)


pytest_collect_file = Sybil(
    parsers=[
        PythonCodeBlockParser(),
        CodeBlockParser("toml", check_study),
        CodeBlockParser("console", check_session),
        SkipParser(),
    ],
    patterns=["*.md", "*.ipynb"],
    document_types={".ipynb": Notebook},
    fixtures=["empty_folder"],
).pytest()
