"""Forces on the degrees of freedom of a structure over the excitation frequency."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from dalembert.errors import InputError
from dalembert.structure import Structure
from dalembert.vibration.fourier import Fourier
from dalembert.vibration.system.force_terms import Factor, Term
from dalembert.vibration.system.forces import Force


@dataclass(frozen=True)
class Loads:
    r"""Phasors of forces, :math:`f(\omega) = f_0 + \sum_k p_k(\omega) f_k`.

    ``patterns`` (1 + terms, orders, n): f_0 and f_k, complex; ``factors`` (terms,): p_k.
    """

    patterns: np.ndarray
    factors: tuple[Factor, ...] = ()

    @property
    def constant(self) -> np.ndarray:
        """f_0, (orders, n)."""
        return self.patterns[0]

    def weights(self, omega: float) -> tuple[np.ndarray, np.ndarray]:
        """1 and p_k at ω, and their derivatives, (1 + terms,) both."""
        values = [(1.0, 0.0), *(factor(omega) for factor in self.factors)]
        return np.array([value for value, _ in values]), np.array([slope for _, slope in values])

    def at(self, omega: float) -> np.ndarray:
        """f at ω, (orders, n)."""
        return self.constant if not self.factors else np.tensordot(self.weights(omega)[0], self.patterns, 1)


def loads(forces: Sequence[Force], structure: Structure, series: Fourier, periods: int = 1) -> Loads:
    """Return the forces on a structure, real. ``periods``: of the excitation in a period of the series."""
    terms = _terms(forces, structure, series, periods)
    varying = [term for term in terms if term.factor is not None]
    groups = [[term for term in terms if term.factor is None], *([term] for term in varying)]
    patterns = [series.phasors(np.real(_summed(group, structure.size, series))) for group in groups]
    return Loads(np.stack(patterns), tuple(term.factor for term in varying if term.factor is not None))


def load_coefficients(
    forces: Sequence[Force], structure: Structure, series: Fourier, omega: float, periods: int = 1
) -> np.ndarray:
    """Return the coefficients of the forces at ω of the series (n, coefficients), complex where their numbers are."""
    return _summed(_terms(forces, structure, series, periods), structure.size, series, omega)


def _terms(forces: Sequence[Force], structure: Structure, series: Fourier, periods: int) -> list[Term]:
    """Parts of forces in the harmonics of a series, with factors over the frequency of the series."""
    for force in forces:
        if periods * force.harmonic not in series.orders:
            kept = [order // periods for order in series.orders if order % periods == 0]
            raise InputError(
                f"{force.where} acts in harmonic {force.harmonic}, which is not among the harmonics kept "
                f"({', '.join(map(str, kept))}); keep more of them"
            )
    terms = [term for force in forces for term in force.terms(structure)]
    return terms if periods == 1 else [_slower(term, periods) for term in terms]


def _slower(term: Term, periods: int) -> Term:
    """The same where the excitation has several periods in one of the series."""
    factor = term.factor

    def slower(omega: float) -> tuple[float, float]:
        assert factor is not None
        value, slope = factor(periods * omega)
        return value, periods * slope

    return term._replace(harmonic=periods * term.harmonic, factor=None if factor is None else slower)


def _summed(terms: Sequence[Term], size: int, series: Fourier, omega: float | None = None) -> np.ndarray:
    """Return the sum of terms, (n, coefficients): of their patterns, or with their factors at ω."""
    kind = np.result_type(float, *(part for term in terms for part in (term.cosine, term.sine)))
    result = np.zeros((size, series.count), dtype=kind)
    for term in terms:
        place = series.cosines[series.orders.index(term.harmonic)]
        factor = 1.0 if omega is None or term.factor is None else term.factor(omega)[0]
        result[term.rows, place] += factor * term.cosine
        if term.harmonic:
            result[term.rows, place + 1] += factor * term.sine
    return result
