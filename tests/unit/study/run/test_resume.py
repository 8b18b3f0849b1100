"""What is refused when a run is to be resumed, and what a run leaves for it."""

import json
from pathlib import Path

import numpy as np
import pytest
from rich.console import Console

import dalembert as da
from dalembert.errors import InputError, SolveError
from dalembert.forward import Checkpoint, PythonModel, Recorded
from dalembert.study import RunFolder, load, report_run, resume_run, run_study
from dalembert.study.run import duration
from dalembert.study.run.events import read_events
from dalembert.study.run.folder import new_folder
from dalembert.study.run.listing import rows
from dalembert.study.run.progress import Watch
from dalembert.study.run.runner import Stopped
from dalembert.threads import threads, with_threads
from dalembert.versions import versions
from faults.kills import content
from pages import read_page
from support import says

MODEL = """
import numpy as np
from pathlib import Path
from dalembert.forward import PythonModel

def decay(parameters):
    return PythonModel(response, parameters, ["x"], np.linspace(0, 1, 3))

def response(rate):
    if not Path("go").exists():
        raise KeyboardInterrupt
    return np.exp(-rate * np.linspace(0, 1, 3))
"""
STUDY = """
[parameters]
rate = { lower = 0.5, upper = 2.0 }
[model]
forward = "decay.py:decay"
[propagate]
method = "vertex"
"""


@pytest.fixture
def study(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "decay.py").write_text(MODEL)
    (tmp_path / "decay.toml").write_text(STUDY)
    return load(tmp_path / "decay.toml")


@pytest.fixture
def stopped(study, tmp_path):
    """The folder of a run that the user stopped."""
    with pytest.raises(Stopped) as stop:
        run_study(study)
    (tmp_path / "go").touch()
    return RunFolder(stop.value.args[0])


def test_a_stopped_run_goes_on(stopped):
    assert stopped.state()["state"] == "interrupted"
    assert stopped.checkpoint.is_file()
    assert resume_run(stopped).success
    assert stopped.state()["state"] == "finished"
    assert not stopped.checkpoint.exists()
    kinds = [json.loads(line)["event"] for line in stopped.events.read_text().splitlines()]
    assert kinds[0] == "run-started"
    assert kinds.count("run-resumed") == 1


def test_a_run_states_the_size_of_its_checkpoint_before_it_simulates(study, tmp_path, monkeypatch, capsys):
    """3 samples of 128 simulations at once have 3,072 bytes."""
    (tmp_path / "go").touch()
    monkeypatch.setattr(duration, "SMALL", 3073)
    folder, _ = run_study(study)
    assert not [event for event in read_events(folder.events) if event["event"] == "run-storage"]
    monkeypatch.setattr(duration, "SMALL", 3072)
    with Watch(Console(width=200)) as watch:
        folder, _ = run_study(study, listener=watch)
    kinds = [event["event"] for event in read_events(folder.events)]
    assert kinds.index("run-started") < kinds.index("run-storage") < kinds.index("ran")
    assert "The checkpoint takes up to 3.1 kB until the run ends." in capsys.readouterr().out


def test_a_finished_run_is_not_resumed(stopped):
    resume_run(stopped)
    sentence = (
        f"{stopped.path}: the run has finished, so there is nothing to resume; write its report again with "
        f"'dalembert report {stopped.path}'"
    )
    with pytest.raises(InputError, match=says(sentence)):
        resume_run(stopped)


def test_a_run_of_another_version_is_not_resumed(stopped):
    state = stopped.path / "state.json"
    state.write_text(json.dumps(json.loads(state.read_text()) | {"version": "0.0.1"}))
    with pytest.raises(InputError, match=r"begun with dalembert 0\.0\.1, and this is .*: what both compute may differ"):
        resume_run(stopped)


def began_with(folder, **changed):
    """State that other versions began a run."""
    settings = json.loads(folder.settings.read_text())
    settings["computed_with"] = [{**settings["computed_with"][0], **changed}]
    folder.settings.write_text(json.dumps(settings))


def test_a_run_of_other_source_files_is_not_resumed(stopped):
    """Of two checkouts of one version, for example."""
    began_with(stopped, sources="0123456789ab")
    sentence = (
        f"{stopped.path}: this is dalembert {da.__version__} with other source files (digest {versions()['sources']}, "
        "not 0123456789ab) as at the start of the run: what both compute may differ; run the study again, or resume it "
        "with the version that began it"
    )
    with pytest.raises(InputError, match=says(sentence)):
        resume_run(stopped)


@pytest.mark.parametrize("package", ["numpy", "scipy", "numba"])
def test_a_run_of_another_version_of_a_package_is_doubted(stopped, package):
    began_with(stopped, **{package: "1.0"})
    outcome = resume_run(stopped)
    (finding,) = [finding for finding in outcome.findings if finding.code == "mixed-versions"]
    assert (finding.severity, finding.values) == (
        "warning",
        {"package": package, "versions": f"1.0, {versions()[package]}"},
    )
    assert stopped.state()["findings"][0]["code"] == "mixed-versions"
    assert [process[package] for process in stopped.computed_with()] == ["1.0", versions()[package]]
    for _ in range(2):
        assert finding.message in read_page(stopped.report).text
        report_run(stopped)


def test_a_run_without_readable_settings_is_not_resumed(stopped):
    stopped.settings.write_text("{")
    with pytest.raises(InputError, match=r"the run is damaged: settings\.json is missing, or was changed"):
        resume_run(stopped)


THREADED = """
import numpy as np
from dalembert.forward import PythonModel

NUMBERS = np.random.default_rng(0).standard_normal(100_000)

def summed(parameters):
    return PythonModel(lambda rate: np.array([rate * (NUMBERS @ NUMBERS)]), parameters, ["x"], np.zeros(1))
"""


def test_the_bits_do_not_depend_on_the_threads_of_linear_algebra(tmp_path, monkeypatch):
    """The order of the sums of a long scalar product depends on them."""
    monkeypatch.chdir(tmp_path)
    (tmp_path / "summed.py").write_text(THREADED)
    (tmp_path / "summed.toml").write_text(STUDY.replace("decay.py:decay", "summed.py:summed"))
    results, sums = [], []
    for number in (1, 2):
        with with_threads(number):
            folder, _ = run_study(load(tmp_path / "summed.toml"))
            assert threads() == number
            numbers = np.random.default_rng(0).standard_normal(100_000)
            sums.append(numbers @ numbers)
        results.append(content(folder.result))
        assert folder.computed_with() == [{**versions(), "linear_algebra_threads": 1}]
    if sums[0] == sums[1]:
        pytest.skip("this library of linear algebra orders sums alike with one and two threads")
    assert results[0] == results[1]


def test_a_run_that_goes_on_is_not_resumed(stopped):
    stopped.set_state("running", version="")
    with stopped.locked(), pytest.raises(InputError, match="the run is active; wait for it, or stop it"):
        resume_run(stopped)


def test_the_folder_of_a_stopped_run_says_how_to_go_on(stopped):
    sentence = (
        f"{stopped.path} holds a run (interrupted); continue it by 'dalembert resume {stopped.path}', give --force "
        "to replace it, or choose another folder with --out"
    )
    with pytest.raises(InputError, match=says(sentence)):
        new_folder("decay", stopped.path)


def test_what_a_run_left_that_was_killed_before_it_began_is_taken_over(study, tmp_path):
    left = tmp_path / "left"
    left.mkdir()
    for name in ("lock", "study.toml", "events.jsonl", ".settings-abc.json"):
        (left / name).touch()
    (tmp_path / "go").touch()
    folder, _ = run_study(study, left)
    assert folder.state()["state"] == "finished"
    assert not (left / ".settings-abc.json").exists()


def test_failures_are_kept_too(tmp_path):
    asked = []

    def fails(rate):
        asked.append(float(np.real(rate)))
        if np.real(rate) > 1:
            raise SolveError("too fast")
        return np.exp(-rate * np.linspace(0, 1, 3))

    model = PythonModel(fails, {"rate": (0.1, 2.0)}, ["x"], np.linspace(0, 1, 3))
    for _ in range(2):
        with Checkpoint(tmp_path / "checkpoint") as checkpoint:
            recorded = Recorded(model, checkpoint)
            assert recorded.evaluate(np.array([[0.5], [1.5]])).failures == (None, "too fast")
            with pytest.raises(SolveError, match="too fast"):
                recorded.linearise(np.array([1.5]))
            values, slopes = recorded.linearise(np.array([0.5]))
            assert recorded.jacobian(np.array([0.5])).tobytes() == slopes.tobytes()
            assert recorded.first(2).evaluate(np.array([[0.5]])).values.tobytes() == values[:2].tobytes()
    once = len(asked)
    assert asked.count(1.5) == 2
    with Checkpoint(tmp_path / "checkpoint") as checkpoint:
        Recorded(model, checkpoint, "another").evaluate(np.array([[0.5]]))
        assert checkpoint.spared == 0
        Recorded(model, checkpoint).evaluate(np.array([[0.5]]))
        assert checkpoint.spared > 0
    assert len(asked) == once + 1


def test_a_file_that_is_no_checkpoint(tmp_path):
    (tmp_path / "checkpoint").write_text("something else" * 100)
    with pytest.warns(RuntimeWarning, match=r"checkpoint is damaged and was kept as checkpoint\.damaged-1\. 0 results"):
        checkpoint = Checkpoint(tmp_path / "checkpoint")
    with checkpoint:
        assert checkpoint.recall(b"one") is None
    assert (tmp_path / "checkpoint.damaged-1").read_text() == "something else" * 100


DAMAGE = "runs/a: the run is damaged: {} is missing, or was changed; run its study again, in another folder"


@pytest.mark.parametrize("content", [b'{"state": "finis', b"\xff\xfe", b"[]", b"{}"])
def test_a_damaged_state_is_listed_and_told(content, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    folder = RunFolder(Path("runs/a"))
    folder.path.mkdir(parents=True)
    (folder.path / "state.json").write_bytes(content)
    (row,) = rows(Path("runs"))
    assert (row["run"], row["state"]) == ("a", "damaged")
    with pytest.raises(InputError, match=says(DAMAGE.format("state.json"))):
        resume_run(folder)
    with pytest.raises(InputError, match=says(DAMAGE.format("inputs.json"))):
        folder.kept()


def test_a_folder_that_is_no_run_is_not_resumed(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    with pytest.raises(
        InputError, match=says("plain is no run folder: it has no state.json; name a run that 'dalembert list' shows")
    ):
        RunFolder(Path("plain")).kept()
