"""Undamped resonances of a structure, or of what its elements leave free."""

import re

import numpy as np
import pytest
from scipy.sparse import csc_array

from dalembert.errors import SolveError
from dalembert.structure import Structure, lumped
from dalembert.vibration import (
    Gap,
    HarmonicBalance,
    HarmonicForce,
    VibrationSystem,
    frequency_response,
)
from dalembert.vibration.interface import condensation

K = 4 * np.pi**2
"""Stiffness, N/m, with which 1 kg resonates at exactly 1 Hz."""
FREQUENCIES = np.array([0.9, 1.0, 1.1])
FORCED = HarmonicForce("m", 1.0)


def system(structure: Structure, *parts) -> VibrationSystem:
    made = VibrationSystem(structure)
    for part in parts:
        made.add(part)
    return made


def test_an_undamped_resonance_is_a_sentence() -> None:
    single = system(lumped({"m": 1.0}, [("m", None, K, 0.0)]), FORCED)
    sentence = (
        "the structure resonates without damping, at 'm.x', at 1 Hz, where its motion has no bound; give it damping"
    )
    with pytest.raises(SolveError, match=re.escape(sentence)):
        frequency_response(single, FREQUENCIES, HarmonicBalance(1))


@pytest.mark.parametrize("sparse", [False, True])
def test_so_is_one_of_a_structure_without_modes(monkeypatch, sparse: bool) -> None:
    structure = lumped({"m": 1.0, "n": 0.0}, [("m", None, K, 0.0), ("n", None, 1.0, 0.0)])
    if sparse:
        monkeypatch.setattr(condensation, "DENSE", 0)
        structure = Structure(csc_array(structure.mass), csc_array(structure.stiffness), structure.dofs)
    with pytest.raises(SolveError, match="resonates without damping"):
        frequency_response(system(structure, FORCED), FREQUENCIES, HarmonicBalance(1))


def test_a_higher_harmonic_without_force_may_resonate() -> None:
    single = system(lumped({"m": 1.0}, [("m", None, K, 0.0)]), FORCED)
    curve = frequency_response(single, np.array([0.5]), HarmonicBalance(2))
    np.testing.assert_allclose(curve.response[0, 0], [0.0, 1 / (0.75 * K), 0.0, 0.0, 0.0], rtol=1e-12, atol=0.0)


def test_what_elements_leave_free_may_resonate_where_they_hold_it() -> None:
    """The mass n resonates at 1 Hz with m held, and is an absorber of m there: m stands still."""
    structure = lumped({"m": 1.0, "n": 1.0}, [("m", None, K, 0.0), ("m", "n", 1.0, 0.0), ("n", None, K - 1, 0.0)])
    absorbed = system(structure, FORCED, Gap("stop", "m", stiffness=1.0, gap=1e6))
    curve = frequency_response(absorbed, FREQUENCIES, HarmonicBalance(1))
    assert curve.converged.all()
    exact = np.array([np.linalg.solve(structure.stiffness - (2 * np.pi * f) ** 2 * np.eye(2), [1.0, 0.0])
                      for f in FREQUENCIES])  # fmt: skip
    np.testing.assert_allclose(curve.response[:, :, 1], exact, atol=1e-6)
