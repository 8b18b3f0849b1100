"""Radau IIA: settings, coefficients, derivatives of its discrete solution, batches, jumps of loads, outputs."""

import numpy as np
import pytest
from scipy.linalg import block_diag

import dalembert.multibody as mb
from dalembert.errors import InputError
from dalembert.multibody.integrators.radau_coefficients import coefficients
from driven_rope import response
from slopes import errors
from support import says


@pytest.mark.parametrize(
    ("settings", "sentence"),
    [
        ({"step": 0.0}, "RadauIIA: step is 0.0; expected a positive number of seconds, or none"),
        ({"tolerance": -1.0}, "RadauIIA: tolerance is -1.0; expected a positive number"),
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


@pytest.mark.parametrize("stages", [3, 5, 7])
def test_derivatives_are_slopes_of_its_own_motion(stages: int) -> None:
    """Outputs lie on the steps and between them."""
    error, size = errors(response(mb.RadauIIA(step=8e-3, stages=stages)))
    assert min(size.values()) > 1e-5
    assert max(error.values()) < 1e-6


def test_a_batch_has_the_bits_of_single_runs() -> None:
    model = response(mb.RadauIIA(tolerance=1e-5), 2)
    vectors = np.array([[2e5, 1.0, 0.3, 20.0, 2.0], [5e5, 0.6, 0.5, 40.0, 1.2], [4e5, 1.5, 0.4, 15.0, 3.0]])
    together = model.evaluate(vectors)
    assert together.failures == (None,) * 3
    for vector, values in zip(vectors, together.values, strict=True):
        np.testing.assert_array_equal(model.evaluate(vector).only()[0], values)


def test_a_step_ends_where_a_load_jumps() -> None:
    """A mass under a force that is switched on and off: a parabola, then a line."""
    system = mb.System(gravity=(0.0, 0.0))
    mass = system.add(mb.PointMass("mass", 2.0, (0.0, 0.0)))
    system.add(mb.Force("push", mass.centre, x=mb.Step(6.0, 0.31, 0.73)))
    times = np.array([0.2, 0.31, 0.5, 0.73, 1.0])
    values = mb.simulate(system, 1.0, mb.RadauIIA(), times).channels(["mass.centre.x", "mass.centre.vx"])
    speed = 3.0 * np.clip(times - 0.31, 0.0, 0.42)
    place = 1.5 * np.clip(times - 0.31, 0.0, 0.42) ** 2 + 3.0 * 0.42 * np.clip(times - 0.73, 0.0, None)
    np.testing.assert_allclose(values, np.column_stack([place, speed]), atol=1e-13)


def test_a_run_that_takes_too_many_steps_says_so() -> None:
    model = response(mb.RadauIIA(most_steps=3))
    (reason,) = model.evaluate(model.parameters.start).failures
    assert reason is not None
    assert reason.startswith("the adaptive step reached most_steps = 3 at t = ")
