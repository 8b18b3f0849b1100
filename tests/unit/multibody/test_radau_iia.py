"""Radau IIA: settings, coefficients, runs of too many steps."""

import numpy as np
import pytest
from scipy.linalg import block_diag

import dalembert.multibody as mb
from dalembert.errors import InputError
from dalembert.multibody.integrators.radau_coefficients import coefficients
from driven_rope import response
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


def test_a_run_that_takes_too_many_steps_says_so() -> None:
    model = response(mb.RadauIIA(most_steps=3))
    (reason,) = model.evaluate(model.parameters.start).failures
    assert reason is not None
    assert reason.startswith("the adaptive step reached most_steps = 3 at t = ")
