"""Studies by their folders, and the last run of each."""

import json
import os
import shutil
from pathlib import Path

import pytest

from dalembert.studio.runs.study_runs import LastRun, last_runs, study_of
from dalembert.studio.studies.study_list import study_folders
from dalembert.studio.workspace import Workspace
from dalembert.study.run.folder import RunFolder
from dalembert.study.template import begin

STUDIES = Path(__file__).parents[4] / "studies"


@pytest.fixture
def workspace(tmp_path):
    begin("identify", tmp_path / "studies" / "mine").rename(tmp_path / "studies" / "mine" / "study.toml")
    shutil.copytree(STUDIES / "duffing", tmp_path / "studies" / "duffing")
    return Workspace(tmp_path)


def add_run(root, name, folder, study, state="finished", at=1.0):
    path = root / "runs" / name
    path.mkdir(parents=True)
    (path / "inputs.json").write_text(json.dumps({"folder": str(folder), "name": study, "files": {}}))
    (path / "state.json").write_text(json.dumps({"state": state, "since": "2026-01-01T10:00:00+00:00"}))
    os.utime(path / "state.json", (at, at))


def test_folders_have_titles_descriptions_and_their_studies(workspace):
    examples, own = study_folders(workspace)
    assert (own.name, own.title, own.example) == ("mine", "Parameters from a measured motion", False)
    assert [(entry.name, entry.task) for entry in own.entries] == [("mine/study", "identify")]
    assert examples.example
    assert examples.title == "Duffing oscillator: past the folds"
    assert examples.description.startswith("A mass of 1 kg on a spring of 1 N/m that hardens")
    assert [entry.name for entry in examples.entries] == [
        "duffing/backbone", "duffing/branches", "duffing/fold", "duffing/levels", "duffing/track"
    ]  # fmt: skip


def test_descriptions_have_the_texts_of_links_and_no_marks(workspace):
    readme = workspace.root / "studies" / "mine" / "README.md"
    readme.write_text("# Bars\n\nBars of [a pendulum](../pendulum/README.md), *Multibody* dynamics, `study.toml`.\n")
    _, own = study_folders(workspace)
    assert own.description == "Bars of a pendulum, Multibody dynamics, study.toml."


def test_a_search_finds_words_of_any_study_of_a_folder(workspace):
    examples, own = study_folders(workspace)
    assert examples.matches("BACKBONE duffing")
    assert not own.matches("backbone")
    assert own.matches("")


def test_the_newest_run_of_a_study_is_its_last(workspace):
    mine = workspace.root / "studies" / "mine"
    add_run(workspace.root, "old", mine, "study", state="failed", at=10.0)
    add_run(workspace.root, "new", mine, "study", at=20.0)
    add_run(workspace.root, "other", mine.parent / "duffing", "duffing", at=30.0)
    assert last_runs(workspace.runs_folder)[(mine, "study")] == LastRun("new", "finished", "2026-01-01 10:00:00")
    examples, own = study_folders(workspace)
    assert own.entries[0].last.name == "new"
    assert [entry.last and entry.last.name for entry in examples.entries] == [None, None, "other", None, None]


def test_a_study_with_mistakes_and_damaged_runs_are_listed(workspace):
    broken = workspace.root / "studies" / "broken"
    broken.mkdir()
    (broken / "study.toml").write_text("a = [")
    (workspace.root / "runs" / "damaged").mkdir(parents=True)
    (workspace.root / "runs" / "damaged" / "state.json").write_text("")
    found = {folder.name: folder for folder in study_folders(workspace)}
    assert (found["broken"].title, found["broken"].entries[0].task) == ("broken", "")


def test_a_file_is_read_again_after_a_change(workspace):
    (own,) = [folder for folder in study_folders(workspace) if not folder.example]
    path = workspace.root / "studies" / "mine" / "study.toml"
    path.write_text(path.read_text().replace("Parameters from a measured motion", "Another title"))
    (changed,) = [folder for folder in study_folders(workspace) if not folder.example]
    assert (own.title, changed.title) == ("Parameters from a measured motion", "Another title")


def test_a_run_knows_its_study_while_it_is_there(workspace):
    mine, duffing = (workspace.root / "studies" / name for name in ("mine", "duffing"))
    for name, folder, study in (
        ("one", mine, "study"), ("two", duffing, "duffing"), ("gone", mine, "former"), ("far", Path("/bench"), "study")
    ):  # fmt: skip
        add_run(workspace.root, name, folder, study)
    found = {
        name: study_of(workspace, RunFolder(workspace.root / "runs" / name)) for name in ("one", "gone", "far", "no")
    }
    assert found == {"one": "mine/study", "gone": None, "far": None, "no": None}
    (mine / "study.toml").write_text('[study]\nname = "renamed"\n')
    assert study_of(workspace, RunFolder(workspace.root / "runs" / "one")) is None
