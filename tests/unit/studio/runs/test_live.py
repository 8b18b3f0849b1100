"""A run's events as a page reads them while they come."""

import json
from itertools import pairwise

from dalembert.studio.runs.figures import followed
from dalembert.studio.runs.live import POINTS, SHOWN, Live


def line(number: int, **details: object) -> str:
    event = {
        "n": number,
        "event": "iteration",
        "start": 0,
        "simulations": number,
        "best": 1 / (number + 1),
        "samples": 9,
    }
    return json.dumps(event | {"values": [float(number)]} | details) + "\n"


def test_events_are_read_once_and_only_whole_lines(tmp_path):
    path = tmp_path / "events.jsonl"
    live = Live(path)
    assert not live.advance()
    path.write_text(line(0) + line(1)[:20])
    assert live.advance()
    assert live.count == 1
    assert not live.advance()
    path.write_text(line(0) + line(1))
    assert live.advance()
    assert (live.count, live.best, live.values) == (2, 0.5, [1.0])
    live.name(("rate",))
    path.write_text(line(0) + line(1) + line(2))
    live.advance()
    assert live.progress[0] == "start 1 · 2 simulations · best 0.3333 · rate = 2"


def test_a_long_run_keeps_a_short_curve(tmp_path):
    path = tmp_path / "events.jsonl"
    path.write_text("".join(line(number) for number in range(10_000)))
    live = Live(path)
    live.advance()
    assert live.count == 10_000
    assert POINTS // 2 <= len(live.convergence) <= POINTS
    assert len(live.recent) == SHOWN
    assert live.best == 1e-4
    assert [y for _, y in live.convergence] == sorted((y for _, y in live.convergence), reverse=True)


def test_a_curve_grows_to_the_end_when_other_events_stand_between(tmp_path):
    path = tmp_path / "events.jsonl"
    other = json.dumps({"n": 0, "event": "started"}) + "\n"
    path.write_text("".join(line(number) + other for number in range(3000)))
    live = Live(path)
    live.advance()
    assert live.convergence[-1][0] > 2900
    assert live.visited[-1][0] > 2900


def test_a_misfit_over_more_samples_begins_another_curve(tmp_path):
    path = tmp_path / "events.jsonl"
    path.write_text(line(0, best=1e-9, samples=4) + line(1, best=0.1, samples=9))
    live = Live(path)
    live.advance()
    assert (live.best, live.convergence) == (0.1, [(1, 0.1)])


def test_a_curve_grows_with_its_points_and_a_family_with_its_peaks(tmp_path):
    path = tmp_path / "events.jsonl"
    points = [
        {"event": "followed", "frequency": 1.0 + k, "amplitude": 0.1 * k, "dof": "m.x", "done": 0.1} for k in (0, 1)
    ]
    lost = {"event": "followed", "frequency": 3.0, "amplitude": None, "dof": "m.x", "done": 0.2}
    path.write_text("".join(json.dumps(event) + "\n" for event in (*points, lost)))
    live = Live(path)
    live.advance()
    assert (live.followed, live.axes) == ([(1.0, 0.0), (2.0, 0.1)], ("frequency (Hz)", "m.x (m)"))
    assert live.progress == ("3 Hz · not found · 20% of the way", 20, 100)
    swept = {"event": "swept", "parameter": "load", "value": 2.0, "dof": "m.x", "amplitude": 0.3, "done": 1, "total": 4}
    path.write_text(json.dumps(swept) + "\n")
    live = Live(path)
    live.advance()
    assert (live.followed, live.axes) == ([(2.0, 0.3)], ("load", "peak of m.x (m)"))


def test_a_long_path_keeps_a_short_curve(tmp_path):
    path = tmp_path / "events.jsonl"
    points = [{"event": "followed", "frequency": k, "amplitude": 0.1, "dof": "m", "done": 0.1} for k in range(5000)]
    path.write_text("".join(json.dumps(event) + "\n" for event in points))
    live = Live(path)
    live.advance()
    assert POINTS // 2 <= len(live.followed) <= POINTS
    gaps = {second[0] - first[0] for first, second in pairwise(live.followed)}
    assert len(gaps) == 1


def test_a_curve_that_is_followed_again_with_more_harmonics_begins_anew(tmp_path):
    path = tmp_path / "events.jsonl"
    point = {"event": "followed", "amplitude": 0.1, "dof": "m", "done": 0.1}
    points = [{**point, "frequency": k, "harmonics": harmonics} for harmonics in (3, 7) for k in range(harmonics)]
    path.write_text("".join(json.dumps(event) + "\n" for event in points))
    live = Live(path)
    live.advance()
    assert [place for place, _ in live.followed] == list(range(7))


def test_what_was_followed_is_drawn_with_its_last_point():
    figure = followed([(1.0, 0.1), (2.0, 0.4), (1.5, 0.5)], ("frequency (Hz)", "m.x (m)"))
    line, end = figure.data
    assert (list(line.x), list(line.y)) == ([1.0, 2.0, 1.5], [0.1, 0.4, 0.5])
    assert (list(end.x), list(end.y)) == ([1.5], [0.5])
    assert (figure.layout.xaxis.title.text, figure.layout.yaxis.title.text) == ("frequency (Hz)", "m.x (m)")
