"""First-order Taylor bounds."""

import numpy as np
import pytest

from dalembert.errors import InputError
from dalembert.uncertainty import Taylor, propagate
from small_models import DECAY, LINE, TIMES
from support import says


def test_a_linear_response_is_bounded_exactly():
    bands = propagate(LINE, {"offset": (-1.0, 2.0), "slope": (1.0, 3.0)}, "taylor")
    np.testing.assert_allclose(bands.lower[:, 0], -1 + TIMES, atol=1e-12)
    np.testing.assert_allclose(bands.upper[:, 0], 2 + 3 * TIMES, atol=1e-12)
    np.testing.assert_allclose(bands.lower[:, 1], TIMES**2 - 2, atol=1e-12)
    assert bands.error is None
    assert bands.findings[0].severity == "note"
    assert bands.findings[0].values["difference"] < 1e-12
    assert (bands.kind, bands.runs) == ("estimate", 1 + 2 + 4)


def test_bounds_lie_at_the_corners_that_the_gradient_points_to():
    bands = propagate(DECAY, {"size": (1.0, 2.0), "rate": (0.5, 1.0)}, "taylor")
    assert bands.at_upper[10, 0].tolist() == [2.0, 0.5]
    assert bands.at_lower[10, 0].tolist() == [1.0, 1.0]
    assert bands.at_upper[0, 0].tolist() == [2.0, 0.75]


def test_held_out_corners_show_what_the_curvature_does():
    box = {"size": 2.0, "rate": (0.5, 1.5)}
    bands = propagate(DECAY, box, Taylor(held_out=20))
    linear = 2 * np.exp(-TIMES) * (1 - TIMES * np.array([[-0.5], [0.5]]))
    apart = np.abs(2 * np.exp(-TIMES * np.array([[0.5], [1.5]])) - linear).max(axis=0)
    (finding,) = bands.findings
    assert (bands.error, finding.code, finding.severity) == (None, "unknown-error", "warning")
    assert finding.values["difference"] == pytest.approx(apart.max() / bands.width.max())
    assert "At 20 corners the response differs from the linear one" in str(finding)
    assert propagate(DECAY, box, Taylor(held_out=0)).findings[0].values == {}


def test_numbers_all_known_exactly_need_no_held_out_runs():
    bands = propagate(DECAY, {"size": 1.0, "rate": 1.0}, "taylor")
    assert np.array_equal(bands.lower, bands.upper)
    assert bands.runs == 3


def test_a_negative_number_of_held_out_runs_is_refused():
    with pytest.raises(InputError, match=says("Taylor: held_out is -1; expected zero or a positive whole number")):
        Taylor(held_out=-1)
