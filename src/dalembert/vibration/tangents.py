r"""The Jacobian of the balance, as one dense matrix or by its structure, and the linear systems with it.

Written by its structure, :math:`J = A + E\,m\,V`: A is what J would be if every contact stuck all period, one block for
each harmonic; m has one block for each contact that slips or opens, or spring that is not linear, and couples the
harmonics of these rows E alone. An elastic contact with stiffness k has :math:`A = Z_q + k`, :math:`m = G - k` and
:math:`V = E^T`; a rigid one, with penalty ε, :math:`A = \varepsilon`, :math:`m = 1 - G/\varepsilon` and
:math:`V = E^T (Z_q - \varepsilon)`. So the dense system is as large as the active contacts' coordinates (Woodbury), and
the factors of A serve all iterations at a frequency.
"""

from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any

import numpy as np
from scipy.linalg import lu_factor, lu_solve

from dalembert.vibration.condensation import Point
from dalembert.vibration.fourier import Fourier, real_blocks

ACTIVE = 1e-11
"""Difference from its stuck stiffness, as part of that, above which a contact is active."""


@dataclass(frozen=True)
class DenseTangent:
    """Derivatives of the residual.

    Parameters
    ----------
    jacobian : array, shape (q, coefficients, q, coefficients)
    slope : array, shape (q, coefficients)
        By ω.
    """

    jacobian: np.ndarray
    slope: np.ndarray

    def copy(self) -> "DenseTangent":
        """The same in other places of memory."""
        return DenseTangent(self.jacobian.copy(), self.slope.copy())

    @property
    def matrix(self) -> np.ndarray:
        """The Jacobian as a matrix, (unknowns, unknowns)."""
        return self.jacobian.reshape(self.slope.size, self.slope.size)

    def solve(self, right: np.ndarray) -> np.ndarray:
        """J⁻¹ times right-hand sides (q, coefficients, columns)."""
        return np.linalg.solve(self.matrix, right.reshape(self.slope.size, right.shape[2])).reshape(right.shape)


@dataclass(frozen=True)
class BlockTangent:
    """Derivatives of the residual by their structure, filled while the elements are evaluated.

    Parameters
    ----------
    point : Point
    series : Fourier
    slope : array, shape (q, coefficients)
        By ω.
    reference : array, shape (q,)
        Stiffness of each coordinate's contact if it sticks; 0 where there is none.
    rigid : array of bool, shape (q,)
    """

    point: Point
    series: Fourier
    slope: np.ndarray
    reference: np.ndarray
    rigid: np.ndarray
    active: list[tuple[np.ndarray, np.ndarray]] = field(default_factory=list)

    def add(self, places: np.ndarray, gradients: np.ndarray) -> None:
        """Local Jacobians (cells, columns * coefficients, ...) of cells at coordinates (cells, columns)."""
        count = self.series.count
        for own, gradient in zip(places, gradients, strict=True):
            stiffness = np.repeat(self.reference[own], count)
            deviation = gradient - np.diag(stiffness)
            if self.rigid[own[0]]:
                self.slope[own] -= (gradient @ (self.slope[own].ravel() / stiffness)).reshape(len(own), count)
                deviation = -deviation / stiffness
            scale = 1.0 if self.rigid[own[0]] else stiffness.max(initial=0.0)
            if np.abs(deviation).max() > ACTIVE * scale:
                self.active.append((own, deviation))

    def solve(self, right: np.ndarray) -> np.ndarray:
        """J⁻¹ times right-hand sides (q, coefficients, columns)."""
        return np.stack([self._solved(column) for column in np.moveaxis(right, 2, 0)], axis=2)

    @property
    def jacobian(self) -> np.ndarray:
        """The whole Jacobian, (q, coefficients, q, coefficients)."""
        return self.solve_free(real_blocks(self._reference_blocks(), self.series.mean))

    def solve_free(self, blocks: np.ndarray) -> np.ndarray:
        """Adds the active contacts' part to that of the reference."""
        if not self.active:
            return blocks
        rows, across = self._rows, real_blocks(self._across, self.series.mean)
        shape = across.shape
        blocks[rows] += self._times(across.reshape(-1, shape[2] * shape[3])).reshape(shape)
        return blocks

    @cached_property
    def _rows(self) -> np.ndarray:
        """Coordinates of the active contacts."""
        return np.concatenate([own for own, _ in self.active])

    @cached_property
    def _across(self) -> np.ndarray:
        """V, (orders, active, q)."""
        rows, q = self._rows, len(self.reference)
        own = np.zeros((len(rows), q))
        own[np.arange(len(rows)), rows] = np.where(self.rigid[rows], -self.reference[rows], 1.0)
        return np.where(self.rigid[rows][:, None], self.point.stiffness[:, rows], 0.0) + own

    def _times(self, values: np.ndarray) -> np.ndarray:
        """m times values (active * coefficients, columns)."""
        result, at = np.empty_like(values), 0
        for _, block in self.active:
            result[at : at + len(block)] = block @ values[at : at + len(block)]
            at += len(block)
        return result

    def _reference_blocks(self) -> np.ndarray:
        """A, (orders, q, q)."""
        blocks = np.where(self.rigid[:, None], 0.0, self.point.stiffness)
        diagonal = np.arange(len(self.reference))
        blocks[:, diagonal, diagonal] += self.reference
        return blocks

    def _stuck(self, right: np.ndarray) -> np.ndarray:
        """A⁻¹ times phasors (orders, q, columns)."""
        if self.rigid.all():
            return right / self.reference[:, None]
        if "factors" not in self.point.kept:
            self.point.kept["factors"] = [lu_factor(block, check_finite=False) for block in self._reference_blocks()]
        factors: Sequence[Any] = self.point.kept["factors"]
        pairs = zip(factors, right, strict=True)
        return np.stack([lu_solve(own, columns, check_finite=False) for own, columns in pairs])

    @cached_property
    def _coupled(self) -> tuple[np.ndarray, Any]:
        """A⁻¹ E, (orders, q, active), and the factors of 1 + V A⁻¹ E m."""
        rows = self._rows
        unit = np.zeros((len(self.series.orders), len(self.reference), len(rows)), dtype=complex)
        unit[:, rows, np.arange(len(rows))] = 1.0
        response = self._stuck(unit)
        size = len(rows) * self.series.count
        among = real_blocks(self._across @ response, self.series.mean).reshape(size, size)
        at = 0
        matrix = np.empty_like(among)
        for _, block in self.active:
            columns = slice(at, at + len(block))
            matrix[:, columns] = among[:, columns] @ block
            at += len(block)
        matrix[np.arange(size), np.arange(size)] += 1.0
        return response, lu_factor(matrix, check_finite=False)

    def _solved(self, right: np.ndarray) -> np.ndarray:
        series = self.series
        first = self._stuck(series.phasors(right)[:, :, None])
        if not self.active:
            return series.coefficients(first[:, :, 0])
        response, factors = self._coupled
        seen = series.coefficients((self._across @ first)[:, :, 0]).ravel()
        force = self._times(lu_solve(factors, seen, check_finite=False)[:, None])[:, 0]
        back = response @ series.phasors(force.reshape(-1, series.count))[:, :, None]
        return series.coefficients((first - back)[:, :, 0])


Tangent = DenseTangent | BlockTangent


def bordered(
    tangent: Tangent, direction: np.ndarray, scales: tuple[float, float, float], top: np.ndarray, bottom: float
) -> tuple[np.ndarray, float]:
    """Solution with the tangent and a row beside it, regular at a fold too: changes of U/size and ω/width.

    Parameters
    ----------
    tangent : DenseTangent or BlockTangent
    direction : array, shape (unknowns + 1,)
        The row.
    scales : (size, width, force)
    top : array, shape (q, coefficients)
        Right-hand side, as part of the force.
    bottom : float
    """
    size, width, force = scales
    if isinstance(tangent, DenseTangent):
        matrix = np.empty((len(direction), len(direction)))
        matrix[:-1, :-1] = tangent.matrix * (size / force)
        matrix[:-1, -1] = tangent.slope.ravel() * (width / force)
        matrix[-1] = direction
        change = np.linalg.solve(matrix, np.append(top.ravel(), bottom))
        return change[:-1].reshape(top.shape), float(change[-1])
    solved = tangent.solve(np.stack([top * (force / size), tangent.slope * (width / size)], axis=2))
    row, (still, moving) = direction[:-1], np.moveaxis(solved, 2, 0)
    turned = (bottom - float(row @ still.ravel())) / (float(direction[-1]) - float(row @ moving.ravel()))
    return still - turned * moving, turned
