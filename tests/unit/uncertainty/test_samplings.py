"""Extremes over chosen points: which points, which bounds, and what the later ones still widened."""

import numpy as np
import pytest

from dalembert.errors import InputError
from dalembert.forward import PythonModel
from dalembert.intervals import Box
from dalembert.uncertainty import LatinHypercube, MonteCarlo, Scan, Vertex, propagate
from small_models import DECAY, TIMES
from support import says

HILL = PythonModel(lambda x, y: np.array([1 - x**2 + y]), {"x": (-2.0, 2.0), "y": (-1.0, 1.0)}, ["z"], np.zeros(1))
BOX = {"x": (-1.0, 1.0), "y": (0.0, 0.5)}


def test_the_vertices_bound_a_monotone_response_exactly():
    bands = propagate(DECAY, {"size": (1.0, 2.0), "rate": (0.5, 1.0)}, "vertex")
    np.testing.assert_allclose(bands.lower[:, 0], np.exp(-TIMES), rtol=1e-15)
    np.testing.assert_allclose(bands.upper[:, 0], 2 * np.exp(-TIMES / 2), rtol=1e-15)
    assert bands.at_lower[5, 0].tolist() == [1.0, 1.0]
    assert bands.at_upper[5, 0].tolist() == [2.0, 0.5]
    assert (bands.kind, bands.runs, bands.error) == ("inner bound", 4, None)


def test_the_vertices_miss_a_hill_and_a_grid_finds_its_top():
    vertices, grid = propagate(HILL, BOX, "vertex"), propagate(HILL, BOX, Scan(5))
    assert (vertices.lower.item(), vertices.upper.item()) == (0.0, 0.5)
    assert (grid.lower.item(), grid.upper.item()) == (0.0, 1.5)
    assert grid.at_upper.tolist() == [[[0.0, 0.5]]]
    assert grid.runs == 25


def test_the_error_of_a_grid_is_unknown_and_the_difference_from_every_other_point_a_finding():
    peak = PythonModel(lambda x: np.array([np.exp(-((x - 0.25) ** 2))]), {"x": (-2.0, 2.0)}, ["z"], np.zeros(1))
    grid = propagate(peak, {"x": (-1.0, 1.0)}, Scan(9))
    assert grid.upper.item() == 1.0
    assert grid.error is None
    (finding,) = grid.findings
    assert (finding.code, finding.severity) == ("unknown-error", "note")
    assert finding.values["widened"] == pytest.approx((1 - np.exp(-0.0625)) / grid.width.item())
    assert finding.values["gap"] == pytest.approx(1 / 8)
    assert str(finding).endswith("9 runs cannot exclude a bump, pit or step narrower than 12 % of the interval of 'x'.")
    assert "widened" not in propagate(peak, {"x": (-1.0, 1.0)}, Scan(4)).findings[0].values


@pytest.mark.parametrize("method", [MonteCarlo(400), LatinHypercube(400)], ids=["monte-carlo", "latin-hypercube"])
def test_random_points_stay_inside_and_tell_what_their_second_half_widened(method):
    bands = propagate(HILL, BOX, method, seed=4)
    assert bands.runs == 400
    assert bands.at_lower.min(axis=(0, 1)).tolist() >= [-1.0, 0.0]
    assert 0 <= bands.lower.item() < 0.2
    assert 1.4 < bands.upper.item() <= 1.5
    first, rest = method.points(Box.of(BOX), 4)
    half, whole = (HILL.evaluate(points).only()[:, 0, 0] for points in (first, np.concatenate([first, rest])))
    widened = max(half.min() - whole.min(), whole.max() - half.max())
    assert bands.error is None
    assert bands.findings[0].values["widened"] == pytest.approx(widened / bands.width.item())


@pytest.mark.parametrize("method", ["monte-carlo", "latin-hypercube"])
def test_random_points_follow_the_seed_bit_for_bit(method):
    same, again, other = (propagate(HILL, BOX, method, seed=seed) for seed in (1, 1, 2))
    assert same.lower.tobytes() == again.lower.tobytes()
    assert same.lower.tobytes() != other.lower.tobytes()


def test_a_latin_hypercube_has_one_point_in_every_slice():
    points = np.concatenate(LatinHypercube(50).points(Box.of(BOX), 0))
    assert sorted(np.floor(25 * (points[:, 0] + 1)).astype(int)) == list(range(50))
    assert sorted(np.floor(100 * points[:, 1]).astype(int)) == list(range(50))


def test_a_number_known_exactly_takes_no_more_points():
    box = Box.of({"x": (0.0, 1.0), "y": 2.0})
    assert Vertex().points(box, 0)[1].tolist() == [[0.0, 2.0], [1.0, 2.0]]
    assert sorted(np.concatenate(Scan(3).points(box, 0)).tolist()) == [[0.0, 2.0], [0.5, 2.0], [1.0, 2.0]]


@pytest.mark.parametrize(
    ("wrong", "sentence"),
    [
        (lambda: Scan(1), "Scan: points_each is 1; expected a whole number of at least 2"),
        (lambda: MonteCarlo(1), "MonteCarlo: runs is 1; expected a whole number of at least 2"),
        (lambda: LatinHypercube(0), "LatinHypercube: runs is 0; expected a whole number of at least 2"),
        (
            lambda: propagate(HILL, BOX, Vertex(most_runs=3)),
            "method 'vertex': 2 points for each of 2 intervals are 4 runs, more than most_runs = 3; raise it, or use "
            "Taylor() or Optimise()",
        ),
        (
            lambda: propagate(HILL, BOX, Scan(1001)),
            "method 'scan': 1001 points for each of 2 intervals are 1002001 runs, more than most_runs = 1000000; "
            "raise it, or use fewer points a parameter, or Optimise()",
        ),
    ],
)
def test_settings_that_cannot_be_meant_are_answered_in_a_sentence(wrong, sentence):
    with pytest.raises(InputError, match=says(sentence)):
        wrong()
