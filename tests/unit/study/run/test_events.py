"""The stream of events."""

import json
import math

import numpy as np
import pytest

from dalembert.study.run.events import EventLog, last_progress, read_events


def test_events_are_json_lines_in_order(tmp_path):
    path, seen = tmp_path / "events.jsonl", []
    with EventLog(path, (seen.append,)) as log:
        log.emit("a", best=math.inf, values=np.array([1.0, math.nan]), count=np.int64(3), ok=np.bool_(True))
        log.emit("b", text="line\nbreak", nested={"x": (1, [2.5])}, place=tmp_path)
        assert len(path.read_text().splitlines()) == 2  # while the log is open
    lines = [json.loads(line, parse_constant=pytest.fail) for line in path.read_text().splitlines()]
    assert lines == seen == list(read_events(path))
    assert [line["n"] for line in lines] == [0, 1]
    assert {key: lines[0][key] for key in ("best", "values", "count", "ok")} == {
        "best": None,
        "values": [1.0, None],
        "count": 3,
        "ok": True,
    }
    assert lines[1]["nested"] == {"x": [1, [2.5]]}


def test_a_line_cut_short_is_left_out_and_then_replaced(tmp_path):
    path = tmp_path / "events.jsonl"
    with EventLog(path) as log:
        log.emit("a")
        log.emit("b")
    with path.open("a") as file:
        file.write('{"n": 2, "event": "c')
    assert [event["event"] for event in read_events(path)] == ["a", "b"]
    with EventLog(path) as log:
        for kind in "abd":
            log.emit(kind)
    assert [(event["n"], event["event"]) for event in read_events(path)] == [(0, "a"), (1, "b"), (2, "d")]


def test_the_last_progress_is_found_at_the_end_of_a_long_file(tmp_path):
    path = tmp_path / "events.jsonl"
    assert last_progress(path) is None
    with EventLog(path) as log:
        for number in range(3000):
            log.emit("iteration", best=1.0 / (number + 1))
        for _ in range(100):
            log.emit("other")
    event = last_progress(path)
    assert event is not None
    assert event["best"] == 1.0 / 3000
    assert last_progress(path, tail=300) is None


def test_a_resumed_run_tells_again_what_it_does_and_writes_only_what_is_new(tmp_path):
    path, heard = tmp_path / "events.jsonl", []
    with EventLog(path) as log:
        for kind in ("run-started", "iteration", "iteration"):
            log.emit(kind)
    with EventLog(path, (lambda event: heard.append(event["event"]),)) as log:
        for kind in ("run-resumed", "iteration", "iteration", "iteration", "run-ended"):
            log.emit(kind)
    assert heard == ["run-resumed", "iteration", "iteration", "iteration", "run-ended"]
    written = [(event["n"], event["event"]) for event in read_events(path)]
    assert written == list(
        enumerate(["run-started", "iteration", "iteration", "run-resumed", "iteration", "run-ended"])
    )
