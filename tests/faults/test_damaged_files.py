"""Files of a run that were damaged: cut off, overwritten, with flipped bits. No wrong number and no traceback."""

import json
from pathlib import Path

import numpy as np
import pytest

from dalembert.errors import InputError
from dalembert.forward import Checkpoint
from dalembert.study import RunFolder, load, report_run, resume_run, run_study
from dalembert.study.run.events import EventLog, read_events
from dalembert.study.run.listing import rows
from dalembert.study.run.runner import Stopped

MODEL = """
import numpy as np
from pathlib import Path
from dalembert.forward import PythonModel
TIMES = np.linspace(0, 1, 40)

def decay(parameters):
    return PythonModel(response, parameters, ["x"], TIMES)

def response(rate, height):
    if Path("asked").is_file():
        with open("asked", "a") as asked:
            asked.write(".")
        if Path("asked").stat().st_size == 30:
            raise KeyboardInterrupt
    return height * np.exp(-rate * TIMES)
"""
STUDY = """
[parameters]
rate = { lower = 0.5, upper = 2.0 }
height = { lower = 0.5, upper = 2.0 }
[model]
forward = "decay.py:decay"
[sweep]
at = 0.0
channels = ["x"]
over = { rate = { count = 20 }, height = { count = 20 } }
"""


def damages(content: bytes, seed: int, count: int) -> list[bytes]:
    """A content cut off at many lengths, overwritten from somewhere on, all random, and with a few flipped bits."""
    random = np.random.default_rng(seed)
    found = [b"", b"\n", random.bytes(len(content)), b"no such file" * 50]
    found += [content[: int(part * len(content))] for part in np.linspace(0, 1, count, endpoint=False)]
    for _ in range(count):
        begin, length = int(random.integers(len(content))), int(random.integers(1, 600))
        found.append(content[:begin] + random.bytes(length) + content[begin + length :])
        flipped = bytearray(content)
        for at in random.integers(len(content), size=random.integers(1, 4)):
            flipped[at] ^= 1 << int(random.integers(8))
        found.append(bytes(flipped))
    for at in range(0, 100, max(1, 100 // count)):  # the header of a database
        flipped = bytearray(content)
        flipped[min(at, len(content) - 1)] ^= 1 << int(random.integers(8))
        found.append(bytes(flipped))
    return found


COUNTS = [pytest.param(25), pytest.param(250, marks=pytest.mark.slow)]


@pytest.mark.parametrize("count", COUNTS)
def test_a_damaged_checkpoint_gives_right_results_or_none(count, tmp_path):
    path, random = tmp_path / "checkpoint", np.random.default_rng(0)
    kept = {bytes([number]): (random.random((30, number % 7 + 1)), np.arange(number)) for number in range(60)}
    with Checkpoint(path) as checkpoint:
        for key, arrays in kept.items():
            checkpoint.keep(key, arrays, 0.5)
    content, told = path.read_bytes(), []
    recalled = []
    for case in damages(content, 1, count):
        path.write_bytes(case)
        told.clear()
        found = 0
        with Checkpoint(path, told.append) as checkpoint:
            for key, arrays in kept.items():
                answer = checkpoint.recall(key)
                if answer is None:
                    checkpoint.keep(key, arrays, 0.5)
                else:
                    found += 1
                    assert [one.tobytes() for one in answer] == [one.tobytes() for one in arrays]
        recalled.append(found)
        asides = sorted(tmp_path.glob("checkpoint.damaged-*"))
        assert len(told) == len([one for one in asides if not one.name.endswith("-journal")])
        for aside in asides:
            aside.unlink()
        with Checkpoint(path, pytest.fail) as checkpoint:  # all is there again
            assert all(checkpoint.recall(key) is not None for key in kept)
        path.unlink()
    assert max(recalled[4:]) >= 55
    assert min(recalled) == 0
    assert any(0 < number < 55 for number in recalled)


def test_a_damaged_checkpoint_is_a_warning_where_nobody_listens(tmp_path):
    (tmp_path / "checkpoint").write_bytes(b"garbage" * 300)
    with pytest.warns(RuntimeWarning, match=r"damaged and was kept as checkpoint\.damaged-1"):
        Checkpoint(tmp_path / "checkpoint").close()


@pytest.fixture
def stopped(tmp_path, monkeypatch):
    """Content of the files of a run that was stopped in its midst, and the result of one that was not."""
    monkeypatch.chdir(tmp_path)
    Path("decay.py").write_text(MODEL)
    Path("decay.toml").write_text(STUDY)
    whole, _ = run_study(load("decay.toml"), Path("runs/whole"))
    Path("asked").touch()
    with pytest.raises(Stopped):
        run_study(load("decay.toml"), Path("runs/part"))
    Path("asked").unlink()
    folder = RunFolder(Path("runs/part"))
    kept = {path: path.read_bytes() for path in folder.path.rglob("*") if path.is_file()}
    return folder, kept, whole


def told(event: dict) -> tuple | None:
    """What an event of the sweep says; None of another one."""
    return (event.get("parameter"), event.get("value")) if event["event"] == "swept" else None


def refused(folder: RunFolder, heard: list[dict]) -> str:
    """Why a run cannot be resumed; nothing if it was."""
    try:
        resume_run(folder, listener=heard.append)
    except InputError as error:
        return str(error)
    return ""


def restored(folder: RunFolder, kept: dict[Path, bytes]) -> None:
    for path in folder.path.rglob("*"):
        if path.is_file() and path not in kept:
            path.unlink()
    for path, content in kept.items():
        path.write_bytes(content)


@pytest.mark.parametrize("name", ["checkpoint", "events.jsonl", "state.json"])
@pytest.mark.parametrize("count", [pytest.param(1), pytest.param(40, marks=pytest.mark.slow)])
def test_a_resumed_run_with_a_damaged_file_ends_with_the_same_bits(stopped, name, count):
    folder, kept, whole = stopped
    path, resumed = folder.path / name, 0
    for case in damages(kept[path], 2, count):
        restored(folder, kept)
        path.write_bytes(case)
        heard: list[dict] = []
        (_, row) = sorted(rows(Path("runs")), key=lambda row: row["run"] == "part")
        assert row["run"] == "part"
        refusal = refused(folder, heard)
        if refusal:  # what state.json says decides whether a run can be resumed
            assert name == "state.json"
            assert "begun with" in refusal or "the run has finished" in refusal
            continue
        resumed += 1
        assert folder.result.read_bytes() == whole.result.read_bytes()
        swept, expected = ([told(event) for event in read_events(one.events)] for one in (folder, whole))
        swept, expected = ([one for one in events if one] for events in (swept, expected))
        if name == "events.jsonl":  # a flipped digit is not seen
            assert 40 - 3 <= len(swept) <= 40
            assert sum(one != other for one, other in zip(swept, expected, strict=False)) <= 3 or len(swept) < 40
        else:
            assert swept == expected
        asides = list(folder.path.glob("*.damaged-1"))
        said = [event["message"] for event in heard if event["event"] == "run-damaged"]
        assert len(said) == len(asides)
        assert all(f"{path} is damaged and was kept as {name}.damaged-1" in sentence for sentence in said)
        assert all(aside.read_bytes() == case for aside in asides)
    assert resumed >= (1 if name == "state.json" else len(damages(kept[path], 2, count)))


def test_a_log_that_is_damaged_in_its_midst_keeps_its_beginning(tmp_path):
    path = tmp_path / "events.jsonl"
    with EventLog(path) as log:
        for number in range(5):
            log.emit("swept", value=number)
    lines = path.read_bytes().splitlines(keepends=True)
    path.write_bytes(b"".join([*lines[:2], b"\xff\x00garbage\n", *lines[3:]]))
    assert [event["value"] for event in read_events(path)] == [0, 1, 3, 4]
    heard = []
    with EventLog(path, (heard.append,)) as log:
        for number in range(5):
            log.emit("swept", value=number)
    events = list(read_events(path))
    assert [event.get("value") for event in events] == [0, 1, None, 2, 3, 4]
    assert "Its first 2 events could be read" in events[2]["message"]
    assert [event.get("value") for event in heard] == [None, 0, 1, 2, 3, 4]


def test_a_damaged_state_is_that_of_the_events(stopped):
    folder, _, whole = stopped
    for one, state in ((folder, "interrupted"), (whole, "finished")):
        (one.path / "state.json").write_bytes(b"\x00\xff{garbage")
        assert one.state()["state"] == state
        assert one.state()["task"] == "sweep"
    (folder.path / "events.jsonl").write_bytes(b"garbage\n")
    assert folder.state() == {"state": "damaged"}


@pytest.mark.parametrize("count", [pytest.param(5), pytest.param(60, marks=pytest.mark.slow)])
def test_a_damaged_result_is_never_reported(stopped, count):
    _, _, whole = stopped
    content = whole.result.read_bytes()
    for case in damages(content, 3, count):
        if case == content:
            continue
        whole.result.write_bytes(case)
        with pytest.raises(InputError, match=r"the run is damaged: result\.nc is missing, or was changed"):
            report_run(whole)
    whole.result.write_bytes(content)
    assert report_run(whole).is_file()


@pytest.mark.parametrize("name", ["study.toml", "inputs/0-decay.py", "inputs.json"])
def test_damaged_inputs_do_not_run(stopped, name):
    folder, kept, _ = stopped
    path = folder.path / name
    for case in damages(kept[path], 4, 1):
        restored(folder, kept)
        path.write_bytes(case)
        refusal = refused(folder, [])
        assert "the run is damaged" in refusal or name == "inputs.json"
        assert refusal or json.loads(path.read_bytes())
