"""Closed forms of beams: elliptic integrals for large deflections, roots of the frequency equations."""

import numpy as np
import pytest
from scipy.optimize import brentq
from scipy.special import ellipeinc, ellipkinc


def elastica(load: float) -> tuple[float, float, float]:
    """Deflection and shortening over the length and rotation of the end, for P L^2 / (E I) = load.

    With k = sin((pi/2 + rotation)/2) and sin(phi) = 1/(k sqrt 2): sqrt(load) = K(k) - F(phi, k).
    """

    def span(rotation: float) -> tuple[float, float]:
        k2 = (1 + np.sin(rotation)) / 2
        return k2, np.arcsin(1 / np.sqrt(2 * k2))

    def excess(rotation: float) -> float:
        k2, phi = span(rotation)
        return ellipkinc(np.pi / 2, k2) - ellipkinc(phi, k2) - np.sqrt(load)

    rotation = brentq(excess, 1e-9, np.pi / 2 - 1e-9, xtol=1e-14)
    k2, phi = span(rotation)
    deflection = 1 - 2 / np.sqrt(load) * (ellipeinc(np.pi / 2, k2) - ellipeinc(phi, k2))
    return deflection, 1 - np.sqrt(2 * np.sin(rotation) / load), rotation


def test_cantilever_under_an_end_force(reference) -> None:
    table = reference("cantilever")["end_force"]
    computed = np.array([elastica(load) for load in table["load"]])
    for column, name in enumerate(("deflection", "shortening", "rotation")):
        np.testing.assert_allclose(computed[:, column], table[name], atol=5.1e-6, err_msg=name)


@pytest.mark.parametrize("support", ["cantilever", "simply_supported"])
def test_wave_numbers(reference, support: str) -> None:
    known = reference("beam_frequencies")["wave_numbers"][support]
    equation = (lambda x: np.cos(x) + 1 / np.cosh(x)) if support == "cantilever" else np.sin
    roots = [brentq(equation, value - 0.5, value + 0.5, xtol=1e-14) for value in known]
    np.testing.assert_allclose(roots, known, atol=5.1e-9)
