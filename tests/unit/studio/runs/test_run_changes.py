"""Runs that are renamed, deleted, restored and continued as new studies."""

import pytest

from dalembert.errors import InputError
from dalembert.studio.runs.run_changes import (
    Deleted,
    continued,
    delete,
    empty_trash,
    rename,
    renamed_files,
    restore,
    study_text,
    trashed,
)
from dalembert.studio.workspace import Workspace
from dalembert.study import RunFolder, load, run_study
from support import says

STUDY = """# swings
[parameters]
rate = { lower = 0.5, upper = 2.0 }
[model]
forward = "../code/decay.py:decay"
[sweep]
at = 0.5
channels = ["x"]
sensitivities = false
over = { rate = { count = 3 } }
"""
MODEL = """
import numpy as np
from helper import times
from dalembert.forward import PythonModel

def decay(parameters):
    return PythonModel(lambda rate: np.exp(-rate * times()), parameters, ["x"], times())
"""
HELPER = "import numpy as np\ndef times():\n    return np.linspace(0, 1, 3)\n"


@pytest.fixture
def workspace(tmp_path):
    return Workspace(tmp_path)


@pytest.fixture
def finished(workspace, tmp_path):
    """A run "first" of a study whose model is in another folder."""
    for folder, name, text in (("code", "decay.py", MODEL), ("mine", "helper.py", HELPER), ("mine", "my.toml", STUDY)):
        (tmp_path / folder).mkdir(exist_ok=True)
        (tmp_path / folder / name).write_text(text)
    folder, _ = run_study(load(tmp_path / "mine" / "my.toml"), workspace.runs_folder / "first")
    return folder


def test_a_run_is_renamed(workspace, finished):
    rename(workspace, "first", "Spring 2 käfig")
    assert [one.path.name for one in workspace.runs()] == ["Spring 2 käfig"]


def test_a_run_is_deleted_and_restored(workspace, finished):
    deleted = delete(workspace, "first")
    assert workspace.runs() == []
    assert trashed(workspace) == [deleted]
    assert restore(workspace, deleted) == "first"
    assert workspace.run("first").kept().task == "sweep"
    assert trashed(workspace) == []
    with pytest.raises(InputError, match="the run 'first' is no longer in the trash"):
        restore(workspace, deleted)


def test_two_deleted_runs_of_one_name_are_both_kept(workspace, finished):
    first = delete(workspace, "first")
    run_study(load(workspace.root / "mine" / "my.toml"), workspace.runs_folder / "first")
    second = delete(workspace, "first")
    assert [restore(workspace, one) for one in (first, second)] == ["first", "first-2"]
    delete(workspace, "first")
    assert empty_trash(workspace) == 1
    assert trashed(workspace) == []


def test_what_is_refused(workspace, finished):
    (workspace.runs_folder / "second").mkdir()
    with pytest.raises(InputError, match=says("there is a run 'second' already; choose another name")):
        rename(workspace, "first", "second")
    with pytest.raises(InputError, match=r"'\.\./up' cannot be a name here"):
        rename(workspace, "first", "../up")
    with finished.locked():
        finished.set_state("running")
        for change in (lambda: rename(workspace, "first", "third"), lambda: delete(workspace, "first")):
            with pytest.raises(InputError, match=says("first is running; stop it first")):
                change()
    assert Deleted("first", finished.path) not in trashed(workspace)


def test_a_run_is_continued_as_a_new_study(workspace, finished):
    name = continued(workspace, finished, "another", study_text(finished).as_string())
    study = workspace.study(name)
    assert study.read_text() == STUDY.replace("../code/decay.py", "decay.py")
    assert sorted(path.name for path in study.parent.iterdir() if path.suffix != ".json") == [
        "decay.py",
        "helper.py",
        "study.toml",
    ]
    run_study(load(study), workspace.runs_folder / "second")
    finished.inputs.unlink()
    with pytest.raises(InputError, match=r"the run is damaged: inputs\.json is missing"):
        continued(workspace, finished, "third", STUDY)
    assert workspace.studies() == [name]


def test_a_run_is_repeated_with_its_files(workspace, finished):
    (workspace.root / "code" / "decay.py").unlink()
    repeated, outcome = run_study(finished.kept(), workspace.runs_folder / "again")
    assert outcome.success
    third, _ = run_study(RunFolder(repeated.path).kept(), workspace.runs_folder / "third")
    assert third.study.read_bytes() == finished.study.read_bytes()


def test_files_within_lists_are_renamed():
    text = 'a = ["x.csv", { file = "/rig/x.csv" }]\n[[b]]\nfile = "../m.py:f"\n'
    assert renamed_files(text, {"/rig/x.csv": "y.csv", "../m.py": "m.py"}) == text.replace("/rig/x", "y").replace(
        "../", ""
    )
