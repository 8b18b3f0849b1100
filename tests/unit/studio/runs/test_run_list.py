"""The rows of the table of runs."""

import json
import os

import pytest

from dalembert.errors import InputError
from dalembert.studio.runs.run_list import RunList
from dalembert.studio.runs.run_note import LONGEST, NOTE, Note, read_note, write_note
from dalembert.study.run.folder import RunFolder
from support import says

STATE = {
    "state": "finished",
    "since": "2026-01-02T03:04:05+00:00",
    "message": "Converged.",
    "best": {"misfit": 0.5, "values": {"drag": 0.2}, "deviations": {"drag": 0.01}},
    "findings": [
        {"code": "a", "severity": "warning", "message": "The residuals are correlated."},
        {"code": "b", "severity": "note", "message": "There are few samples."},
    ],
    "study": "swing",
    "title": "A swing",
    "task": "identify",
    "seconds": 7.5,
}


@pytest.fixture
def runs(tmp_path):
    """The runs' folder with one run, and what is no run."""
    (tmp_path / "notes.txt").touch()
    (tmp_path / "other").mkdir()
    (tmp_path / ".trash").mkdir()
    write(tmp_path / "first", STATE)
    return tmp_path


def write(folder, state, events=()):
    folder.mkdir(exist_ok=True)
    (folder / "state.json").write_text(json.dumps(state))
    if events:
        (folder / "events.jsonl").write_text("".join(json.dumps(event) + "\n" for event in events))


def test_values_have_the_units_of_the_study(runs):
    best = {"values": {"drag": 0.2, "angle": 1.0}, "deviations": {"angle": 0.01}}
    write(runs / "first", STATE | {"best": best})
    study = '[parameters]\ndrag = { lower = 0, upper = 1, unit = "N*m*s" }\nangle = { lower = 0, upper = "90 deg" }\n'
    (runs / "first" / "study.toml").write_text(study)
    (row,) = RunList(runs).rows()
    assert row["values"] == "drag = 0.2 N*m*s, angle = 57.2958 ± 0.57 deg"


def test_a_row(runs):
    write_note(runs / "first", Note("worn bearing", ("rig 2", "cold")))
    (row,) = RunList(runs).rows()
    assert row == {
        "id": str((runs / "first").stat().st_ino),
        "run": "first",
        "study": "swing",
        "title": "A swing",
        "task": "identify",
        "state": "finished",
        "message": "Converged.",
        "findings": "1 warning, 1 note",
        "severity": 1001,
        "doubts": ["The residuals are correlated."],
        "values": "drag = 0.2 ± 0.01",
        "misfit": 0.5,
        "duration": 7.5,
        "date": "2026-01-02 03:04:05",
        "tags": "rig 2, cold",
        "note": "worn bearing",
    }


@pytest.mark.parametrize(("kept", "name"), [('{"folder": "/bench/rocker"}', "rocker"), ("{}", "study"), ("", "study")])
def test_a_study_in_the_file_study_has_the_name_of_its_folder(runs, kept, name):
    write(runs / "first", {**STATE, "study": "study"})
    (runs / "first" / "inputs.json").write_text(kept)
    (row,) = RunList(runs).rows()
    assert row["study"] == name


def test_the_newest_run_is_first(runs):
    write(runs / "newer", STATE | {"since": "2026-01-03T00:00:00+00:00"})
    write(runs / "older", STATE | {"since": "2025-01-03T00:00:00+00:00"})
    assert [row["run"] for row in RunList(runs).rows()] == ["newer", "first", "older"]


def test_a_run_is_read_again_only_when_its_files_change(runs, monkeypatch):
    listed, read = RunList(runs), []
    state = RunFolder.state
    monkeypatch.setattr(RunFolder, "state", lambda folder: read.append(folder.path.name) or state(folder))
    for _ in range(3):
        listed.rows()
    assert read == ["first"]
    write_note(runs / "first", Note("seen"))
    assert listed.rows()[0]["note"] == "seen"
    write(runs / "first", STATE | {"state": "failed"})
    os.utime(runs / "first" / "state.json", ns=(1, 1))
    assert listed.rows()[0]["state"] == "failed"
    assert read == ["first"] * 3


def test_a_renamed_run_keeps_its_id(runs):
    listed = RunList(runs)
    before = listed.rows()[0]["id"]
    (runs / "first").rename(runs / "second")
    (row,) = listed.rows()
    assert (row["id"], row["run"]) == (before, "second")


def test_a_run_that_is_going_on(runs):
    write(runs / "first", {"state": "running", "since": "2026-01-02T03:04:05+00:00", "process": 1, "seconds": 2.0})
    with RunFolder(runs / "first").locked():
        (row,) = RunList(runs).rows()
        assert (row["state"], row["misfit"], row["findings"]) == ("running", None, "")
        assert row["duration"] > 2.0
        events = [{"event": "iteration", "best": 0.25}]
        write(runs / "first", {"state": "running", "since": "2026-01-02T03:04:05+00:00", "process": 1}, events)
        (row,) = RunList(runs).rows()
        assert (row["misfit"], row["duration"]) == (0.25, None)
    assert RunList(runs).rows()[0]["state"] == "killed"


def test_a_paused_run(runs):
    write(runs / "first", STATE | {"state": "interrupted"})
    (runs / "first" / "pause").touch()
    assert RunList(runs).rows()[0]["state"] == "paused"


def test_a_folder_without_runs(tmp_path):
    assert RunList(tmp_path / "nothing").rows() == []


def test_damaged_files(runs):
    (runs / "first" / "state.json").write_text("{")
    (runs / "first" / NOTE).write_text('["x"]')
    (row,) = RunList(runs).rows()
    assert (row["state"], row["note"], row["tags"]) == ("damaged", "", "")
    assert read_note(runs / "first") == Note()


def test_a_note_that_is_too_long_is_refused(runs):
    with pytest.raises(InputError, match=says("the note has more than 2000 characters; shorten it")):
        write_note(runs / "first", Note("x" * LONGEST, ("y",)))


def test_the_rows_that_were_read_last_are_known_without_files(runs):
    found = RunList(runs)
    assert found.known == []
    rows = found.rows()
    (runs / "first" / "state.json").unlink()
    assert found.known == rows
