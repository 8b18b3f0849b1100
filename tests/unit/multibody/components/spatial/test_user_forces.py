"""Forces of the user's functions in space: against built-in components, compiled or not, with exact derivatives."""

import numba
import numpy as np
import pytest

import dalembert.multibody as mb
import dalembert.multibody.spatial as sp
from dalembert.errors import SolveError
from spatial_scenes import two_rods
from support import says

SOLVER = mb.GeneralizedAlpha(2e-3)
CHANNELS = ["second.tip.x", "second.tip.vy", "second.tip.rotation_z", "first.origin.wx"]


def rods(*loads) -> sp.SpatialSystem:
    """Two rods on ball joints with the loads that functions of the two points give."""
    system, first, second = two_rods()
    system.add(sp.SphericalJoint("hold", system.ground, first.point("origin")))
    system.add(sp.SphericalJoint("middle", first.point("end"), second.point("origin")))
    for make in loads:
        system.add(make(first.point("end"), second.point("tip")))
    return system


def follower(t, at, against):
    """A force (1, 2, 3) and a torque (0.1, 0.2, 0.3) in the axes of the marker."""
    r = at[6:15].reshape(3, 3)
    return (
        r[0, 0] + 2 * r[0, 1] + 3 * r[0, 2],
        r[1, 0] + 2 * r[1, 1] + 3 * r[1, 2],
        r[2, 0] + 2 * r[2, 1] + 3 * r[2, 2],
        0.1 * (r[0, 0] + 2 * r[0, 1] + 3 * r[0, 2]),
        0.1 * (r[1, 0] + 2 * r[1, 1] + 3 * r[1, 2]),
        0.1 * (r[2, 0] + 2 * r[2, 1] + 3 * r[2, 2]),
    )


@pytest.mark.parametrize("function", [follower, numba.njit(follower)], ids=["plain", "compiled"])
def test_it_is_the_follower_force_that_it_imitates(function) -> None:
    def built_in(kind, factor):
        return lambda a, b: kind(kind.__name__, b, factor, 2 * factor, 3 * factor, follower=True, against=a)

    own = rods(lambda a, b: sp.UserForce("own", b, function, against=a))
    given = mb.simulate(own, 0.1, SOLVER).channels(CHANNELS)
    expected = mb.simulate(rods(built_in(sp.Force, 1.0), built_in(sp.Torque, 0.1)), 0.1, SOLVER).channels(CHANNELS)
    np.testing.assert_allclose(given, expected, rtol=1e-9, atol=1e-11)
    assert np.abs(given - mb.simulate(rods(), 0.1, SOLVER).channels(CHANNELS)).max() > 0.1


@pytest.mark.parametrize("wrap", [lambda function: function, numba.njit], ids=["plain", "compiled"])
def test_a_function_that_closes_over_a_parameter_has_exact_derivatives(wrap) -> None:
    def build(p) -> sp.SpatialSystem:
        def function(t, at, against):
            force = p * (against[0] - at[0]) - at[3]
            return force, p * p * t, at[16], 0.1 * at[7], p * against[17], -0.2 * at[15]

        return rods(lambda a, b: sp.UserForce("own", b, wrap(function), against=a))

    times = np.array([0.0, 0.05, 0.1])
    model = mb.TimeResponse(build, {"p": (1.0, 4.0)}, CHANNELS, times, mb.RungeKutta4(5e-3))
    h = 1e-2
    far, near, back, behind = model.evaluate([[2.0 + k * h] for k in (2, 1, -1, -2)]).only()
    slopes = (8 * (near - back) - (far - behind)) / (12 * h)
    exact = model.jacobian([2.0])[:, :, 0]
    np.testing.assert_allclose(exact, slopes, atol=1e-8 * np.abs(slopes).max())
    assert np.abs(exact).max() > 0.01


def test_a_function_that_raises_is_named() -> None:
    sentence = (
        "the function of 'own' returned (0.0, 0.0, 0.0) at t = 0 s; expected six finite numbers "
        "(fx, fy, fz, tx, ty, tz)"
    )
    with pytest.raises(SolveError, match=says(sentence)):
        mb.simulate(rods(lambda a, b: sp.UserForce("own", b, lambda t, at, against: (0.0, 0.0, 0.0))), 0.1)
