"""Paths of equilibria as results: the line with critical points, findings, tables, drawings and files."""

from dataclasses import replace

import numpy as np
import pytest

import dalembert.multibody as mb
from dalembert.errors import InputError
from dalembert.multibody import CriticalPoint, EquilibriumPath
from flat_arch import flat_arch


@pytest.fixture(scope="module")
def path() -> EquilibriumPath:
    return mb.equilibrium_path(flat_arch, 0.0, 10.0, channels=["apex.centre.y"], parameter="push", unit="N")


def made(stable: list[bool], critical: list[tuple[float, int]], **changes: object) -> EquilibriumPath:
    """A path of one unknown, with critical points (load, point before it)."""
    count = len(stable)
    points = tuple(CriticalPoint(load, "branch", np.zeros(2), np.ones(2), after=after) for load, after in critical)
    whole = EquilibriumPath(
        np.arange(float(count)), np.array(stable), points, np.zeros((count, 2)), "end", count - 1.0, "push", "N",
        ("a.x",), ("m",), np.arange(float(count))[:, None], np.array([[load] for load, _ in critical]).reshape(-1, 1),
    )  # fmt: skip
    return replace(whole, **changes)  # type: ignore[arg-type]


def test_the_line_passes_through_the_critical_points(path: EquilibriumPath) -> None:
    line = path.line
    np.testing.assert_allclose(line.loads[line.critical], [point.load for point in path.critical])
    heights = line.values[:, 0]
    assert np.all(np.diff(heights) < 0.0)
    between = (heights[:-1] <= heights[line.critical[0]]) & (heights[1:] >= heights[line.critical[1]])
    np.testing.assert_array_equal(line.stable, ~between)


@pytest.mark.parametrize(
    ("stable", "critical", "segments"),
    [
        ([True, True, False], [(1.5, 1)], [True, True, False]),
        ([True, False, False], [(0.2, 0), (0.6, 0)], [True, False, False, False]),
        ([False, True], [(0.2, 0), (0.6, 0)], [False, False, True]),
        ([False, False], [(0.5, 0)], [False, False]),
        ([True, True], [], [True]),
    ],
)
def test_stability_changes_at_critical_points(stable, critical, segments) -> None:
    assert made(stable, critical).line.stable.tolist() == segments


def test_a_path_is_read_as_it_was_written(path: EquilibriumPath, tmp_path) -> None:
    for number, written in enumerate((path, made([True, True], []))):
        written.save(tmp_path / f"{number}.nc")
        read = EquilibriumPath.load(tmp_path / f"{number}.nc")
        for name in ("loads", "stable", "x", "values", "critical_values"):
            np.testing.assert_array_equal(getattr(read, name), getattr(written, name))
        assert read.summary() == written.summary()
        assert [point.after for point in read.critical] == [point.after for point in written.critical]
        for own, other in zip(read.critical, written.critical, strict=True):
            np.testing.assert_array_equal(own.shape, other.shape)


def test_a_path_from_a_file_has_its_channels_alone(path: EquilibriumPath) -> None:
    stored = replace(path, build=None)
    np.testing.assert_array_equal(stored.channels(["apex.centre.y"]), path.channels(["apex.centre.y"]))
    with pytest.raises(InputError, match=r"unknown channel 'apex\.centre\.x'"):
        stored.channels(["apex.centre.x"])
    with pytest.raises(InputError, match=r"no model to draw\. Give it its function"):
        stored.drawing([0])


def test_the_drawing_has_a_frame_for_each_node(path: EquilibriumPath) -> None:
    rows = [0, int(path.line.critical[0]), len(path.line.loads) - 1]
    drawing = path.drawing(rows)
    np.testing.assert_array_equal(drawing.times, rows)
    np.testing.assert_allclose(drawing.lines["apex"][:, 0, 1], path.line.values[rows, 0], atol=1e-12)


def test_the_summary_has_the_critical_points(path: EquilibriumPath) -> None:
    text = path.summary()
    assert "3.82988" in text
    assert "with 2 limit points." in text
    assert path.facts()["limit point 2"] == "−3.82988 N"
    assert path.success


def test_unstable_equilibria_are_a_note(path: EquilibriumPath) -> None:
    (finding,) = path.findings
    assert (finding.code, finding.severity) == ("unstable-equilibria", "note")
    assert finding.values["load"] == path.critical[0].load
    assert finding.values["points"] == np.count_nonzero(~path.stable)


@pytest.mark.parametrize(
    ("changes", "code", "sentence"),
    [
        ({"ended": "points"}, "path-incomplete", "The path ends after 3 points at 2 N, before 2 N."),
        ({"ended": "away"}, "path-incomplete", "The load went away from its end"),
        ({"ended": "lost"}, "path-incomplete", "No equilibrium was found beyond 2 N: the path stops before 2 N."),
    ],
)
def test_a_path_that_ends_early_is_incomplete(changes, code, sentence) -> None:
    short = made([True, True, True], [], **changes)
    (finding,) = short.findings
    assert (finding.code, finding.severity) == (code, "warning")
    assert sentence in finding.message
    assert not short.success


def test_critical_points_that_are_not_exact_are_doubted() -> None:
    rough = CriticalPoint(0.5, "symmetric part", np.zeros(2), np.ones(2), gap=0.1)
    codes = [finding.code for finding in replace(made([True, True], [(0.5, 0)]), critical=(rough,)).findings]
    assert codes == ["critical-point-gap", "follower-loads"]


def test_a_listener_gets_each_point_and_an_unknown_channel_is_refused_first() -> None:
    seen: list[tuple[float, bool]] = []
    path = mb.equilibrium_path(flat_arch, 0.0, 3.0, on_point=lambda load, stable: seen.append((load, stable)))
    assert [load for load, _ in seen] == path.loads.tolist()
    with pytest.raises(InputError, match=r"unknown channel 'apex\.x'"):
        mb.equilibrium_path(flat_arch, 0.0, 3.0, channels=["apex.x"])
