"""Methods compared on the same box."""

import numpy as np
import pytest

from dalembert.errors import ClusterError, InputError, SolveError
from dalembert.forward import PythonModel
from dalembert.surrogate import TotalDegree
from dalembert.uncertainty import Chebyshev, MonteCarlo, Scan, Vertex, compare, propagate
from small_models import DECAY, TIMES
from support import says

HILL = PythonModel(lambda x: np.stack([1 - x**2 + 0 * TIMES, x + TIMES], axis=1), {"x": (-2.0, 2.0)}, ["a", "b"], TIMES)
BOX = {"x": (-1.0, 1.0)}
WAVE = PythonModel(lambda w: np.cos(w * TIMES), {"w": (1.0, 9.0)}, ["x"], TIMES)


def test_rows_tell_widths_and_distances_from_the_reference():
    comparison = compare(HILL, BOX, ["vertex", Scan(3)], reference="scan")
    vertex, scan3, scan = comparison.rows
    assert [row.method for row in comparison.rows] == ["vertex", "scan (points_each=3)", "scan"]
    assert comparison.reference == "scan"
    assert (vertex.width, scan.width) == (1.0, 1.5)
    assert (vertex.largest, vertex.rms) == (1.0, 0.5)  # of four bounds a sample, one is wrong, by 1
    assert (scan3.largest, scan.largest, scan.rms) == (0.0, 0.0, 0.0)
    assert [row.runs for row in comparison.rows] == [2, 3, 21]
    assert [row.kind for row in comparison.rows] == ["inner bound"] * 3
    assert all(row.seconds >= 0 and row.success for row in comparison.rows)


def test_a_reference_among_the_methods_is_not_run_twice():
    comparison = compare(HILL, BOX, ["optimise", "vertex"])
    assert [result.method for result in comparison.results] == ["optimise", "vertex"]


def test_each_result_is_that_of_propagate():
    comparison = compare(DECAY, {"size": 1.0, "rate": (0.5, 1.0)}, [MonteCarlo(20)], reference="vertex", seed=5)
    alone = propagate(DECAY, {"size": 1.0, "rate": (0.5, 1.0)}, MonteCarlo(20), seed=5)
    assert comparison.results[0].lower.tobytes() == alone.lower.tobytes()


def test_a_method_that_gives_no_bounds_is_told_and_the_others_stay():
    comparison = compare(WAVE, {"w": (3.0, 7.0)}, [Chebyshev(TotalDegree(2)), "vertex"], reference="scan")
    assert [result.method for result in comparison.results] == ["vertex", "scan"]
    ((method, reason),) = comparison.refused
    assert method.startswith("chebyshev (scheme=TotalDegree(order=2")
    assert reason.startswith("the surrogate of order 2 is wrong by about")
    line = next(line for line in comparison.summary().splitlines() if line.startswith(method))
    assert line.endswith(reason)


def test_a_reference_that_gives_no_bounds_is_an_error():
    with pytest.raises(SolveError, match="the surrogate of order 2 is wrong by about"):
        compare(WAVE, {"w": (3.0, 7.0)}, ["vertex"], reference=Chebyshev(TotalDegree(2)))


def test_a_cluster_that_lost_a_method_ends_the_comparison(monkeypatch):
    answered = []

    def lost(self, vectors):
        answered.append(len(vectors))
        if len(answered) == 1:
            raise ClusterError("the cluster lost a part")
        return evaluate(self, vectors)

    evaluate = PythonModel.evaluate
    monkeypatch.setattr(PythonModel, "evaluate", lost)
    with pytest.raises(ClusterError, match="lost a part"):
        compare(WAVE, {"w": (3.0, 7.0)}, ["vertex"], reference="scan")
    assert len(answered) == 1


def test_a_method_given_twice_is_refused():
    with pytest.raises(InputError, match=says("compare: method 'vertex' is given 2 times; give each once")):
        compare(HILL, BOX, ["vertex", Vertex()], reference="scan")


def test_wrong_intervals_are_told_before_anything_runs():
    with pytest.raises(InputError, match=says("intervals: unknown parameter 'y'; known: x")):
        compare(HILL, {"y": 1.0}, ["vertex"], reference="scan")


def test_the_summary_is_a_table_with_a_note_a_method():
    lines = compare(HILL, BOX, ["vertex"], reference="scan").summary().splitlines()
    assert lines[0].split("  ")[0] == "method"
    assert lines[2].split()[:6] == ["vertex", "inner", "bound", "1", "1", "0.5"]
    assert lines[3].split()[:4] == ["scan", "inner", "bound", "1.5"]
    assert lines[3].endswith("the reference")
    assert "vertex: The bounds are the extremes over the corners of the box." in "\n".join(lines)
