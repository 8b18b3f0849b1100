"""Second-order expansions around runs: their curvatures from gradients, and their maxima in boxes."""

import numpy as np
import pytest

from dalembert.uncertainty import expansions
from dalembert.uncertainty.expansions import Expansions, expand, maxima


def quadratic(directions, outputs, runs, seed=0):
    """Runs of quadratic outputs, and their Hessians."""
    random = np.random.default_rng(seed)
    hessians = random.standard_normal((outputs, directions, directions))
    hessians += hessians.transpose(0, 2, 1)
    linear = random.standard_normal((outputs, directions))
    points = random.uniform(-1, 1, (runs, directions))
    slopes = linear + np.einsum("oij,rj->roi", hessians, points)
    values = np.einsum("oi,ri->ro", linear, points) + np.einsum("ri,oij,rj->ro", points, hessians, points) / 2
    return Expansions(points, values, slopes), hessians


@pytest.mark.parametrize("directions", [1, 2, 5])
def test_gradients_of_neighbours_give_the_curvature_of_a_quadratic_response(directions):
    known, hessians = quadratic(directions, outputs=3, runs=20)
    found = known.curvatures(np.arange(3))
    np.testing.assert_allclose(found, np.broadcast_to(hessians, found.shape), atol=1e-11)


def test_an_expansion_foretells_every_other_run_of_a_quadratic_response():
    known, _ = quadratic(3, outputs=2, runs=12)
    curvatures = known.curvatures(np.arange(2))
    steps = (known.points[5] - known.points)[:, None]
    np.testing.assert_allclose(
        known.values + expand(known.slopes, curvatures, steps), known.values[[5] * 12], atol=1e-11
    )


def test_a_single_run_knows_no_curvature():
    known, _ = quadratic(2, outputs=3, runs=1)
    curvatures = known.curvatures(np.arange(3))
    assert curvatures.tolist() == np.zeros((1, 3, 2, 2)).tolist()
    assert known.doubts(np.arange(3), curvatures).tolist() == [[0.0, 0.0, 0.0]]


def test_an_expansion_is_doubted_by_its_error_at_its_neighbours():
    """x³ from runs at 0 and ±½: gradients tell no curvature at 0, and the error is that of the whole cubic."""
    x = np.array([[0.0], [0.5], [-0.5]])
    known = Expansions(x, x**3, 3 * x[:, :, None] ** 2)
    curvatures = known.curvatures(np.arange(1))
    assert curvatures[0].item() == pytest.approx(0, abs=1e-12)
    assert known.doubts(np.arange(1), curvatures)[0].item() == pytest.approx(1.0)


def test_an_exact_expansion_is_not_doubted():
    known, _ = quadratic(3, outputs=2, runs=12)
    assert np.max(known.doubts(np.arange(2), known.curvatures(np.arange(2)))) < 1e-10


def test_outputs_come_in_chunks_that_cover_them_once(monkeypatch):
    monkeypatch.setattr(expansions, "CHUNK", 100)
    known, _ = quadratic(2, outputs=7, runs=12)
    chunks = list(known.chunks())
    assert [len(chunk) for chunk in chunks] == [2, 2, 2, 1]
    assert np.concatenate(chunks).tolist() == list(range(7))


def test_maxima_of_concave_expansions_agree_with_a_fine_scan():
    random = np.random.default_rng(1)
    roots = random.standard_normal((50, 2, 2))
    hessians = -roots @ roots.transpose(0, 2, 1)
    slopes = random.standard_normal((50, 2))
    lower, upper = np.tile([-0.7, -0.4], (50, 1)), np.tile([0.5, 0.8], (50, 1))
    found = maxima(slopes, hessians, lower, upper)
    assert np.all((lower <= found) & (found <= upper))
    axes = np.linspace(-0.7, 0.5, 241), np.linspace(-0.4, 0.8, 241)
    grid = np.stack(np.meshgrid(*axes, indexing="ij"), -1).reshape(-1, 2)
    scanned = expand(slopes[:, None], hessians[:, None], grid).max(axis=1)
    reached = expand(slopes, hessians, found)
    assert np.all(reached >= scanned - 1e-9)
    np.testing.assert_allclose(reached, scanned, atol=1e-3)


def test_an_expansion_that_bends_upwards_is_largest_at_an_end():
    found = maxima(np.array([[0.1], [-0.1]]), np.full((2, 1, 1), 3.0), -np.ones((2, 1)), np.ones((2, 1)))
    assert found.tolist() == [[1.0], [-1.0]]
