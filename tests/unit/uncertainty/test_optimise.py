"""Direct optimisation: extremes inside, on edges and at corners, all taken by runs."""

import numpy as np
import pytest
from inline_snapshot import snapshot

from dalembert.errors import InputError
from dalembert.forward import PythonModel
from dalembert.uncertainty import Optimise, propagate
from small_models import DECAY, TIMES
from support import says


def saddle(x, y):
    return np.array([x * y, 1 - (x - 0.3) ** 2 - 2 * (y + 0.2) ** 2 - (x - 0.3) * (y + 0.2), (x - 0.1) ** 2 + y])


MODEL = PythonModel(saddle, {"x": (-2.0, 2.0), "y": (-2.0, 2.0)}, ["z"], np.arange(3.0))
BOX = {"x": (-1.0, 1.5), "y": (-1.0, 1.0)}


def test_extremes_inside_on_an_edge_and_at_corners():
    bands = propagate(MODEL, BOX, "optimise")
    np.testing.assert_allclose(bands.upper[:, 0], [1.5, 1.0, 1.4**2 + 1], atol=1e-6)
    np.testing.assert_allclose(bands.lower[[0, 2], 0], [-1.5, -1.0], atol=1e-6)
    np.testing.assert_allclose(bands.at_upper[1, 0], [0.3, -0.2], atol=1e-3)
    np.testing.assert_allclose(bands.at_lower[2, 0], [0.1, -1.0], atol=1e-3)
    assert bands.kind == "inner bound"
    assert bands.success
    assert [item.code for item in bands.outcome] == ["search-finished"]
    (finding,) = bands.findings
    assert (bands.error, finding.code) == (None, "unknown-error")
    assert finding.values["expected gain"] <= 1e-6
    assert "cannot exclude a bump, pit or step narrower than" in str(finding)


def test_every_bound_is_taken_where_it_says():
    bands = propagate(DECAY, {"size": (1.0, 2.0), "rate": (0.5, 1.0)}, "optimise")
    for side in ("lower", "upper"):
        points = getattr(bands, f"at_{side}")[:, 0]
        taken = DECAY.evaluate(points).only()[np.arange(len(TIMES)), np.arange(len(TIMES))]
        np.testing.assert_array_equal(taken, getattr(bands, side))


def test_a_response_that_swings_within_the_box_is_bounded_everywhere():
    wave = PythonModel(lambda w: np.sin(w * TIMES), {"w": (1.0, 9.0)}, ["x"], TIMES)
    bands = propagate(wave, {"w": (3.0, 6.0)}, "optimise")
    phase = np.linspace(3 * TIMES, 6 * TIMES, 20001)
    np.testing.assert_allclose(bands.lower[:, 0], np.sin(phase).min(axis=0), atol=3e-6)
    np.testing.assert_allclose(bands.upper[:, 0], np.sin(phase).max(axis=0), atol=3e-6)


def test_runs_are_shared_by_all_outputs():
    """82 bounds of one parameter, each with its own extreme, take fewer than two runs each."""
    wave = PythonModel(lambda w: np.sin(w * TIMES), {"w": (1.0, 9.0)}, ["x"], TIMES)
    assert propagate(wave, {"w": (3.0, 4.0)}, "optimise").runs < 82 * 2 * 2


def test_sensitivities_count_as_runs():
    assert propagate(DECAY, {"size": 1.0, "rate": 1.0}, "optimise").runs == 1 + 2


def test_the_search_ends_at_the_most_runs_and_says_so():
    wave = PythonModel(lambda w: np.sin(w * TIMES), {"w": (1.0, 9.0)}, ["x"], TIMES)
    bands = propagate(wave, {"w": (3.0, 6.0)}, Optimise(most_runs=40))
    assert bands.runs == 40
    assert not bands.success
    assert bands.status == snapshot(
        "Every bound is the response of a run of the model, but the search stopped at most_runs = 40 before it was finished. Increase most_runs."
    )
    assert bands.findings[0].values["expected gain"] > 1e-6


def test_the_same_seed_gives_the_same_bits():
    one, other = (propagate(MODEL, BOX, "optimise", seed=3) for _ in range(2))
    assert one.lower.tobytes() == other.lower.tobytes()
    assert one.at_upper.tobytes() == other.at_upper.tobytes()


def test_six_parameters():
    """A quadratic form: its largest value is at one of the corners, its smallest in the middle."""
    matrix = np.diag([1.0, 2, 3, 4, 5, 6]) + 0.3
    names = [f"p{k}" for k in range(6)]

    def form(**p):
        x = np.array([p[name] for name in names])
        return np.array([x @ matrix @ x])

    model = PythonModel(form, dict.fromkeys(names, (-1.0, 1.0)), ["z"], np.zeros(1))
    bands = propagate(model, dict.fromkeys(names, (-0.5, 1.0)), "optimise")
    assert bands.lower.item() == pytest.approx(0, abs=1e-4)
    assert bands.upper.item() == pytest.approx(matrix.sum(), rel=1e-12)


@pytest.mark.parametrize(
    ("wrong", "sentence"),
    [
        (lambda: Optimise(tolerance=0.0), "Optimise: tolerance is 0; expected a number between 0 and 1"),
        (lambda: Optimise(start=-1), "Optimise: start is -1; expected zero or a positive whole number"),
    ],
)
def test_settings_that_cannot_be_meant_are_answered_in_a_sentence(wrong, sentence):
    with pytest.raises(InputError, match=says(sentence)):
        wrong()
