"""Causes of points that are not found, and of laws and systems that have no motion."""

import re
from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from dalembert.errors import InputError
from dalembert.findings import Finding
from dalembert.structure import lumped
from dalembert.vibration import (
    CubicSpring,
    ElasticSlider,
    FrictionContact,
    HarmonicBalance,
    HarmonicForce,
    UserElement,
    VibrationSystem,
    frequency_response,
    steady_state,
)

K = 4 * np.pi**2
"""Stiffness, N/m, with which 1 kg resonates at exactly 1 Hz."""


def system(part: Any, damping: float = 0.0, force: float = 1.0) -> VibrationSystem:
    made = VibrationSystem(lumped({"m": 1.0}, [("m", None, K, damping)]))
    if force:
        made.add(HarmonicForce("m", force))
    made.add(part)
    return made


def law(function: Callable[[np.ndarray], np.ndarray]) -> UserElement:
    return UserElement("law", ["m"], function)


def only_finding(made: VibrationSystem) -> Finding:
    curve = frequency_response(made, np.array([0.9, 1.0]), HarmonicBalance(1, halvings=0), check=False)
    assert not curve.converged[1]
    assert not curve.success
    (finding,) = curve.findings
    return finding


@pytest.mark.parametrize("value", [np.nan, np.inf])
@pytest.mark.parametrize("run", [lambda s: frequency_response(s, np.array([0.9])), lambda s: steady_state(s, 0.9)])
def test_a_law_that_is_not_finite_at_rest_is_refused(value: float, run: Callable) -> None:
    made = system(law(lambda u: np.full_like(u, value)), damping=0.1)
    sentence = f"element 'law': its function returned {value} at zero displacements; expected finite forces"
    with pytest.raises(InputError, match=re.escape(sentence)):
        run(made)


@pytest.mark.parametrize("value", [np.nan, np.inf])
def test_a_law_that_is_not_finite_in_motion_is_the_cause(value: float) -> None:
    finding = only_finding(system(law(lambda u: np.where(np.real(u) > 0.005, value, u**3)), damping=0.1))
    assert finding.code == "force-not-finite"
    assert finding.values["element"] == "law"


def test_a_law_that_is_finite_where_the_motion_is_may_have_an_end() -> None:
    """A first step may go beyond it: the line search comes back."""
    made = system(law(lambda u: np.where(np.abs(np.real(u)) > 0.2, np.nan, 500 * u**3)), damping=0.1)
    assert frequency_response(made, np.linspace(0.5, 0.9, 5), HarmonicBalance(3)).converged.all()


def test_a_slider_that_cannot_limit_an_undamped_resonance_is_the_cause() -> None:
    slider = FrictionContact("slider", "m", friction=0.1, preload=0.1, law=ElasticSlider(1.0))
    finding = only_finding(system(slider))
    assert finding.code == "undamped-resonance"
    assert "At 1 Hz the structure resonates without damping" in finding.message


def test_with_damping_it_is_not() -> None:
    slider = FrictionContact("slider", "m", friction=0.1, preload=0.1, law=ElasticSlider(1.0))
    assert frequency_response(system(slider, damping=0.01), np.array([0.9, 1.0]), HarmonicBalance(3)).converged.all()


@pytest.mark.parametrize("way", ["long run", "shooting"])
def test_a_motion_in_time_needs_a_force(way: str) -> None:
    made = system(CubicSpring("cubic", "m", stiffness=1.0), damping=0.1, force=0.0)
    with pytest.raises(InputError, match="steady_state: no force acts on the system"):
        steady_state(made, 1.0, way=way)


def test_other_numbers_of_samples_are_tried_where_newtons_method_alternates() -> None:
    """With powers of two a small mean force always points away from the balance; with other numbers there is none."""
    method, at, seen = HarmonicBalance(3, samples=64, halvings=0), np.array([0.8]), np.zeros(0)

    def plain(u: np.ndarray) -> np.ndarray:
        nonlocal seen
        seen = np.real(u) if u.shape[-1] == 64 else seen
        return 50 * u**3

    def kinked(u: np.ndarray) -> np.ndarray:
        is_power = u.shape[-1] & (u.shape[-1] - 1) == 0
        return plain(u) + is_power * np.where(np.max(np.real(u)) < peak, -1e-5, 1e-5)

    exact = frequency_response(system(law(plain), damping=0.5), at, method)
    peak = np.max(seen)
    made = system(law(kinked), damping=0.5)
    assert not frequency_response(made, at, method, check=False).converged[0]
    found = frequency_response(made, at, replace(method, samples="auto"))
    assert found.samples == [80]
    np.testing.assert_allclose(found.response, exact.response, atol=1e-6)
