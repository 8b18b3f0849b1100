"""Runs: the folder that they leave, the result that can be read again, and the rules about folders that are there."""

import hashlib
import json
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
import xarray as xr

from dalembert.errors import InputError
from dalembert.findings import Finding, stored_findings
from dalembert.forward import Checkpoint
from dalembert.study import RunFolder, load, report_run, run_study
from dalembert.study.run.events import read_events
from dalembert.study.run.folder import find_runs, new_folder
from dalembert.study.run.listing import rows
from dalembert.study.tasks import Outcome
from support import says

DECAY = """
import numpy as np
from dalembert.forward import PythonModel

times = np.linspace(0, 1, 11)

def decay(parameters):
    return PythonModel(response, parameters, ["x", "y"], times)

def response(rate, height):
    if np.real(rate) > 2.5:
        raise ValueError("too fast")
    x = height * np.exp(-rate * times)
    return np.stack([x, 2 * x], axis=1)
"""
SWEEP = """
[study]
title = "Decay"
description = "A decay."
[parameters]
rate = { lower = 0.5, upper = "2 1/s" }
height = { lower = "100 mm", upper = 1.0, start = 0.3 }
[model]
forward = "decay.py:decay"
[sweep]
at = 0.5
channels = ["y", "x"]
over = { rate = { count = 4 }, height = [0.2, "300 mm"] }
"""


@pytest.fixture
def study(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "decay.py").write_text(DECAY)
    (tmp_path / "decay.toml").write_text(SWEEP)
    return Path("decay.toml")


def test_a_run_leaves_all_it_promises(study):
    folder, outcome = run_study(load(study))
    assert folder.path == Path("runs/decay")
    assert outcome.success
    assert folder.study.read_bytes() == study.read_bytes()
    assert sorted(path.name for path in folder.path.iterdir()) == [
        *("events.jsonl", "inputs", "inputs.json", "lock", "report.html"),
        *("result.nc", "settings.json", "state.json", "study.toml"),
    ]
    kept = json.loads(folder.inputs.read_text())["files"]["decay.py"]
    assert hashlib.sha256((folder.path / kept["copy"]).read_bytes()).hexdigest() == kept["sha256"]
    state = folder.state()
    assert (state["state"], state["task"], state["title"]) == ("finished", "sweep", "Decay")
    events = list(read_events(folder.events))
    assert [event["event"] for event in events] == ["run-started", *["swept"] * 6, "run-ended"]
    assert events[-2]["done"] == events[-2]["total"] == 6
    assert json.loads(folder.settings.read_text())["parameters"]["height"]["lower"] == 0.1


def test_the_result_is_netcdf_with_units(study):
    folder, _ = run_study(load(study))
    with xr.open_dataset(folder.result, group="rate", engine="h5netcdf") as curve:
        rate = np.linspace(0.5, 2.0, 4)
        assert curve["rate"].attrs["units"] == "1/s"
        np.testing.assert_allclose(curve["x"], 0.3 * np.exp(-0.5 * rate), rtol=1e-14)
        np.testing.assert_allclose(curve["d(y)"], -0.3 * np.exp(-0.5 * rate), rtol=1e-14)
    with xr.open_dataset(folder.result, group="height", engine="h5netcdf") as curve:
        np.testing.assert_allclose(curve["height"], [0.2, 0.3])


def test_two_runs_give_the_same_bits(study):
    first, _ = run_study(load(study))
    second, _ = run_study(load(study))
    assert second.path == Path("runs/decay-2")
    assert first.result.read_bytes() == second.result.read_bytes()


def test_a_report_is_made_anew_from_the_result(study):
    folder, _ = run_study(load(study))
    before = folder.report.read_text()
    folder.report.unlink()
    study.unlink()
    Path("decay.py").unlink()  # the run has its own copy
    assert report_run(folder) == folder.report
    assert folder.report.read_text() == before
    assert "Decay" in before


def test_a_report_needs_a_run_and_a_result(study):
    with pytest.raises(
        InputError, match=says("nowhere is no run folder: it has no state.json; name a run that 'dalembert list' shows")
    ):
        report_run(RunFolder(Path("nowhere")))
    folder, _ = run_study(load(study))
    folder.result.unlink()
    with pytest.raises(InputError, match=r"^runs/decay has no result: the run is finished; run its study again$"):
        report_run(folder)


def test_a_failed_point_is_marked_and_the_rest_returns(study):
    study.write_text(SWEEP.replace('"2 1/s"', '"3 1/s"'))
    folder, outcome = run_study(load(study))
    assert not outcome.success
    assert outcome.status.endswith("rate, height. 6 points; 1 of them failed, see events.jsonl.")
    assert folder.state()["state"] == "failed"
    failures = [event["failure"] for event in read_events(folder.events) if event.get("failure")]
    assert failures == ["ValueError: too fast (decay.py, line 12)"]
    with xr.open_dataset(folder.result, group="rate", engine="h5netcdf") as curve:
        assert np.isnan(curve["x"]).values.tolist() == [False, False, False, True]


def test_a_study_that_cannot_run_leaves_no_folder(study):
    study.write_text(SWEEP.replace("at = 0.5", "at = 0.51"))
    with pytest.raises(InputError, match=r"^\[sweep\], at: 0.51 was given.*no sample there"):
        run_study(load(study))
    assert not Path("runs").exists()


@pytest.mark.parametrize("out", [None, Path("mine")])
def test_a_run_that_is_refused_late_does_not_block_the_next(study, out):
    wrong = DECAY.replace("def response(rate, height):", "def response(rate, height):\n    return np.zeros((3, 3))")
    Path("decay.py").write_text(wrong)
    for _ in range(2):
        with pytest.raises(InputError, match="returned an array of shape"):
            run_study(load(study), out)
        folder = RunFolder(out or Path("runs/decay"))
        assert folder.state()["state"] == "input"
        assert "returned an array of shape" in folder.state()["message"]
    Path("decay.py").write_text(DECAY)
    again, outcome = run_study(load(study), out)
    assert (again.path, outcome.success) == (folder.path, True)


def test_a_refused_run_with_results_is_kept(study):
    folder = new_folder("decay")
    folder.set_state("input", message="the study's Python code raised it", version="")
    with Checkpoint(folder.checkpoint) as checkpoint:
        checkpoint.keep(b"one", (np.zeros(2),))
    with pytest.raises(InputError, match=r"^runs/decay holds a run \(input\)"):
        run_study(load(study), folder.path)
    assert run_study(load(study))[0].path == Path("runs/decay-2")


def test_an_error_of_ours_leaves_its_traceback_in_the_folder(study, monkeypatch):
    monkeypatch.setattr("dalembert.study.tasks.sweep.Sweep.save", lambda *_: 1 / 0)
    with pytest.raises(ZeroDivisionError):
        run_study(load(study))
    folder = RunFolder(Path("runs/decay"))
    assert (folder.state()["state"], folder.state()["message"]) == ("failed", "ZeroDivisionError: division by zero")
    assert "Traceback" in (folder.path / "error.txt").read_text()
    assert not folder.result.exists()


def test_a_folder_that_is_taken(study):
    out = Path("mine")
    first, _ = run_study(load(study), out)
    with pytest.raises(InputError) as caught:
        run_study(load(study), out)
    assert str(caught.value) == (
        "mine holds a run (finished); give --force to replace it, or choose another folder with --out"
    )
    (out / "inputs" / "left-over").write_text("")
    second, _ = run_study(load(study), out, force=True)
    assert first == second
    assert [path.name for path in (out / "inputs").iterdir()] == ["0-decay.py"]


def test_force_replaces_the_default_folder(study):
    run_study(load(study))
    folder, _ = run_study(load(study), force=True)
    assert folder.path == Path("runs/decay")
    assert len(find_runs(Path("runs"))) == 1


def test_a_folder_that_is_no_run_is_never_emptied(study, tmp_path):
    precious = tmp_path / "precious"
    precious.mkdir()
    (precious / "letter.txt").write_text("keep")
    for force in (False, True):
        with pytest.raises(InputError) as caught:
            new_folder("decay", precious, force=force)
        assert str(caught.value) == (
            f"{precious} holds files that are no run's; choose an empty or new folder with --out"
        )
    with pytest.raises(InputError, match=r"is a file; expected a folder for the run$"):
        new_folder("decay", precious / "letter.txt")
    assert (precious / "letter.txt").read_text() == "keep"


def test_a_folder_at_work_is_left_alone(study):
    folder, _ = run_study(load(study))
    with folder.locked():
        folder.set_state("running")
        assert folder.state()["state"] == "running"
        with pytest.raises(
            InputError, match=r"^a run is active in runs/decay; wait for it, stop it, or choose another"
        ):
            run_study(load(study), folder.path, force=True)
    assert folder.state()["state"] == "killed"


IDENTIFY = """
[parameters]
rate = { lower = 0.5, upper = 2.0 }
height = { lower = 0.1, upper = 1.0 }
spare = { lower = 0.1, upper = 1.0 }
[model]
forward = "decay.py:decay"
[data]
file = "x.csv"
columns = { x = "x" }
deviations = { x = 0.01 }
[identify]
"""


def test_the_state_has_findings_and_deviations_so_that_a_list_loads_no_result(study):
    Path("decay.py").write_text(DECAY.replace("(rate, height)", "(rate, height, spare)"))
    times = np.linspace(0, 1, 11)
    noisy = 0.4 * np.exp(-times) + 0.01 * np.random.default_rng(0).standard_normal(11)
    np.savetxt("x.csv", np.column_stack([times, noisy]), delimiter=",", header="t,x", comments="")
    study.write_text(IDENTIFY)
    folder, outcome = run_study(load(study))
    folder.result.unlink()
    state = json.loads((folder.path / "state.json").read_text())
    deviations = state["best"]["deviations"]
    assert 0 < deviations["rate"] < 0.5
    assert deviations["spare"] is None
    findings = state["findings"]
    assert findings == stored_findings(outcome.findings)
    assert any(finding["severity"] == "warning" and "'spare'" in finding["message"] for finding in findings)
    assert [finding["message"] for finding in findings] == [finding.message for finding in outcome.findings]
    (row,) = rows(Path("runs"))
    doubtful = [finding for finding in findings if finding["severity"] == "warning"]
    assert row["findings"] == f"{len(doubtful)} warning{'s' * (len(doubtful) > 1)}"
    assert "'spare'" in row["messages"]


def test_findings_of_a_result_and_its_other_doubts_are_each_told_once():
    one = Finding("one", "warning", {}, "One.", "Do something.")
    note = Finding("note", "note", {}, "Note.")
    result = SimpleNamespace(findings=(one, note), doubts=(Finding("two", "warning", {}, "Two."), one))
    assert [(each.code, each.message) for each in Outcome(None, result).findings] == [
        ("one", "One."),
        ("note", "Note."),
        ("two", "Two."),
    ]
    assert Outcome(None, object()).findings == ()


def test_the_list_of_runs(study):
    run_study(load(study))
    folder = new_folder("other")
    folder.set_state("finished", task="identify", best={"misfit": 1.23456e-8, "values": {"theta": 0.785398163}})
    found = rows(Path("runs"))
    assert [(row["run"], row["task"], row["state"], row["best"]) for row in found] == [
        ("decay", "sweep", "finished", ""),
        ("other", "identify", "finished", "misfit 1.235e-08, theta = 0.785398"),
    ]
    assert rows(Path("no-such-folder")) == []
