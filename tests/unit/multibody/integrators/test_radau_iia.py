"""Radau IIA: settings, coefficients, tolerances of stiff mechanisms, runs that end early."""

import re

import numpy as np
import pytest
from numba import njit
from scipy.linalg import block_diag

import dalembert.multibody as mb
from dalembert.errors import InputError, SolveError
from dalembert.multibody.integrators.radau.radau_coefficients import coefficients
from damped_slider_crank import damped_slider_crank
from driven_rope import response
from support import says


@pytest.mark.parametrize(
    ("settings", "sentence"),
    [
        ({"step": 0.0}, "RadauIIA: step is 0 s; expected a positive number"),
        ({"tolerance": -1.0}, "RadauIIA: tolerance is -1; expected a positive number"),
        ({"stages": 4}, "RadauIIA: stages is 4; expected 3, 5 or 7"),
    ],
)
def test_settings_that_cannot_be_meant(settings: dict, sentence: str) -> None:
    with pytest.raises(InputError, match=says(sentence)):
        mb.RadauIIA(**settings)


@pytest.mark.parametrize("stages", [3, 5, 7])
def test_coefficients_fulfil_the_conditions_of_order(stages: int) -> None:
    """Weights integrate polynomials up to degree 2 s - 2, those of each stage up to s - 1; T splits the inverse."""
    radau, powers = coefficients(stages), np.arange(1, 2 * stages)
    np.testing.assert_allclose(radau.a[-1] @ radau.c[:, None] ** (powers - 1), 1 / powers, rtol=1e-14)
    each = powers[:stages]
    np.testing.assert_allclose(
        radau.a @ radau.c[:, None] ** (each - 1), radau.c[:, None] ** each / each, rtol=1e-12, atol=1e-16
    )
    blocks = [np.array([[radau.real]]), *(np.array([[z.real, -z.imag], [z.imag, z.real]]) for z in radau.pairs)]
    np.testing.assert_allclose(radau.inverse @ radau.t, radau.t @ block_diag(*blocks), atol=1e-12)


def test_a_run_that_takes_too_many_steps_says_so() -> None:
    model = response(mb.RadauIIA(most_steps=3))
    (reason,) = model.evaluate(model.parameters.start).failures
    assert reason is not None
    assert reason.startswith("the adaptive step reached most_steps = 3 at t = ")


def _steps(damping: float, tolerance: float) -> int:
    times = np.array([0.0, 0.02])
    return mb.simulate(damped_slider_crank(damping), 0.02, mb.RadauIIA(tolerance), times).run.counts[0]


@pytest.mark.parametrize(("damping", "first"), [(0.0, 750), (1e-4, 30), (1e-3, 20)])
def test_steps_of_stiff_mechanisms_grow_as_the_order_demands(damping: float, first: int) -> None:
    """The estimate is of order 6 in the step: 10^(1/6) = 1.47 as many steps for a digit, to the last digits."""
    steps = np.array([_steps(damping, tolerance) for tolerance in (1e-6, 1e-7, 1e-8, 1e-9, 1e-10, 1e-11, 3e-12)])
    growth = steps[1:] / steps[:-1]
    assert steps[0] <= first
    assert np.all(growth[:-1] < 1.6)
    assert growth[-1] < 1.3


@pytest.mark.parametrize("damping", [0.0, 1e-3])
def test_a_tolerance_below_rounding_is_named_with_one_that_works(damping: float) -> None:
    sentence = (
        r"^no step meets tolerance = 1e-16 at t = \S+ s: its estimated error is \S+ or more, by rounding, or by a load "
        r"that jumps or grows without bound; use tolerance = (\S+) or more, or check the loads$"
    )
    with pytest.raises(SolveError, match=sentence) as caught:
        _steps(damping, 1e-16)
    found = re.search(sentence, str(caught.value))
    assert found is not None
    assert 1e-12 <= float(found[1]) <= 1e-10
    assert _steps(damping, float(found[1])) < 20_000


@njit
def _sudden(time, at, against):
    return 1.0 / (1.0 - time), 0.0, 0.0


def test_a_load_without_bound_is_no_matter_of_the_tolerance() -> None:
    system = mb.System(gravity=(0.0, 0.0))
    mass = system.add(mb.PointMass("mass", 1.0, (0.0, 0.0)))
    system.add(mb.UserForce("push", mass.centre, _sudden))
    sentence = (
        r"^no step meets tolerance = 1e-07 at t = 1 s: its estimated error is \S+ or more, by a load that jumps or "
        "grows without bound; check the loads$"
    )
    with pytest.raises(SolveError, match=sentence):
        mb.simulate(system, 2.0, mb.RadauIIA(tolerance=1e-7))
