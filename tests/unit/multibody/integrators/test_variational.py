"""The variational integrator: settings, steps that fail."""

import numpy as np
import pytest

import dalembert.multibody as mb
from dalembert.errors import InputError, SolveError
from support import says


@pytest.mark.parametrize(
    ("settings", "sentence"),
    [
        ({"step": 0.0}, "Variational: step is 0 s; expected a positive number"),
        (
            {"step": 1e-3, "newton_tolerance": -1.0},
            "Variational: newton_tolerance is -1; expected a positive number",
        ),
    ],
)
def test_settings_that_cannot_be_meant(settings: dict, sentence: str) -> None:
    with pytest.raises(InputError, match=says(sentence)):
        mb.Variational(**settings)


def test_a_function_that_fails_is_named() -> None:
    system = mb.System(gravity=(0.0, 0.0))
    mass = system.add(mb.PointMass("mass", 1.0, (0.0, 0.0)))
    system.add(mb.Force("push", mass.centre, x=mb.Custom(lambda t: np.nan if t.real > 0.5 else 1.0)))
    with pytest.raises(SolveError, match=r"the function of 'push' returned \(1\.0, nan, nan\) at t = 0\.5 s"):
        mb.simulate(system, 1.0, mb.Variational(step=0.1))
