"""How long a run still takes."""

from dalembert.studio.runs.remaining import Remaining


def event(second: int, simulations: int | None = None, kind: str = "iteration") -> dict:
    found = {"event": kind, "at": f"2026-01-01T00:00:{second:02}+00:00"}
    return found if simulations is None else found | {"simulations": simulations}


def test_it_is_known_from_the_speed_where_the_end_is_known():
    left = Remaining()
    left.take(event(0, kind="run-started"), 0, None)
    assert left.sentence() == ""
    for second in (1, 2, 3):
        left.take(event(second, kind="swept"), 10 * second, 100)
    assert left.sentence() == "about 7 s left"


def test_a_method_that_decides_on_its_way_has_an_upper_limit():
    left = Remaining()
    for second in (1, 3):
        left.take(event(second, 20 * second), 0, None)
    assert left.sentence() == ""
    left.most = 260
    assert left.sentence() == "at most 10 s left"
    left.most = 60
    assert left.sentence() == ""


def test_what_was_repeated_after_a_pause_does_not_count():
    left = Remaining(most=1000)
    left.take(event(0, 0), 0, None)
    left.take(event(1, 500), 0, None)
    left.take(event(2, kind="run-resumed"), 0, None)
    left.take(event(10, 500), 0, None)
    assert left.sentence() == ""
    left.take(event(20, 600), 0, None)
    assert left.sentence() == "at most 40 s left"
