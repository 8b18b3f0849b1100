"""Runs the examples of README.md and of the documentation, each file's in one empty folder."""

import subprocess
import sys
import tomllib
from collections.abc import Iterator
from pathlib import Path

import pytest
from sybil import Example, Sybil
from sybil.parsers.markdown import CodeBlockParser, PythonCodeBlockParser, SkipParser


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
    command = [Path(sys.executable).with_name("dalembert"), "check", file]
    run = subprocess.run(command, check=False, capture_output=True, text=True)
    return None if run.returncode == 0 else f"dalembert check ended with {run.returncode}:\n{run.stdout}{run.stderr}"


pytest_collect_file = Sybil(
    parsers=[PythonCodeBlockParser(), CodeBlockParser("toml", check_study), SkipParser()],
    patterns=["*.md"],
    fixtures=["empty_folder"],
).pytest()
