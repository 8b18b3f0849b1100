r"""The Jacobian of the balance by its structure, and the linear systems with it.

:math:`J = A + E\,m\,V`: A is what J would be if every contact stuck all period, one block for each harmonic; m has one
block for each contact that slips or opens, or spring that is not linear, and couples the harmonics of these rows E
alone. An elastic contact with stiffness k has :math:`A = Z_q + k`, :math:`m = G - k` and :math:`V = E^T`; a rigid one,
with penalty ε, :math:`A = \varepsilon`, :math:`m = 1 - G/\varepsilon` and :math:`V = E^T (Z_q - \varepsilon)`.

With few active coordinates the dense system is as large as those (Woodbury), and the factors of A serve all iterations
at a frequency. With many, GMRES solves with J as it stands: a product costs one matrix for each harmonic and one block
for each contact. Its preconditioner is J with the coupling of the harmonics left out of m, so that it too has one
matrix for each harmonic.

Where the elements alone hold a part, :math:`Z_q` is singular at the mean, and A is not: it has the stiffness of all
elements. J is singular only along motions that no element resists, where a support is added to A.
"""

from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any

import numpy as np
from scipy.linalg import lu_factor, lu_solve
from scipy.sparse.linalg import LinearOperator, gmres

from dalembert.vibration.fourier import Fourier, complex_blocks, real_blocks
from dalembert.vibration.interface.condensed_structure import CondensedStructure
from dalembert.vibration.interface.free_motions import HeldByElements

ACTIVE = 1e-11
"""Difference from its stuck stiffness, as part of that, above which a contact is active."""
DIRECT = 500
"""Active unknowns up to which a dense system costs less than iterations."""
EXACT = 1e-12
"""Default tolerance of GMRES: residual of a linear system, as part of its right-hand side."""
KRYLOV, CYCLES = 100, 4
"""Iterations of GMRES in a cycle, which begins with the residual as it is, and cycles; then the dense system."""


@dataclass(frozen=True)
class BlockTangent:
    """Derivatives of the residual by their structure, filled while the elements are evaluated. ``slope``
    (q, coefficients): by ω; ``reference`` (q,): stiffness of each coordinate's contact if it sticks; 0 where there is
    none, unless only elements hold a part; ``rigid`` (q,); ``held``: mean motions that the elements alone may hold, if
    there are any; ``active``: coordinates (cells, columns) and blocks of m (cells, unknowns, unknowns).
    """

    point: CondensedStructure
    series: Fourier
    slope: np.ndarray
    reference: np.ndarray
    rigid: np.ndarray
    held: HeldByElements | None = None
    active: list[tuple[np.ndarray, np.ndarray]] = field(default_factory=list)

    #: Residual of the linear system of a step, as part of its right-hand side. The step still gains up to six digits,
    #: and the next iteration corrects the rest (Dembo, Eisenstat and Steihaug, SIAM J. Numerical Analysis 19, 1982).
    forcing = 1e-6

    def add(self, places: np.ndarray, gradients: np.ndarray, stuck: np.ndarray) -> None:
        """Local Jacobians (cells, columns * coefficients, ...) of cells at coordinates (cells, columns).

        ``stuck`` (cells, columns): their stiffnesses if they stick, of which ``reference`` is made.
        """
        stiffness = np.repeat(stuck, self.series.count, axis=1)
        diagonal = np.arange(stiffness.shape[1])
        deviation = gradients.copy()
        deviation[:, diagonal, diagonal] -= stiffness
        scale = stiffness.max(axis=1)
        if self.rigid[places[0, 0]]:
            # A rigid contact: J_0 + G (1 - J_0/ε) = ε + (1 - G/ε)(J_0 - ε), so that A = ε, m = 1 - G/ε and V = J_0 - ε.
            # The derivative by ω has the same factor.
            along = self.slope[places].reshape(stiffness.shape) / stiffness
            self.slope[places] -= (gradients @ along[:, :, None]).reshape(*places.shape, -1)
            deviation /= -stiffness[:, None, :]
            scale = np.ones(len(places))
        # A contact that sticks all period has G = A to rounding: m = 0, and its rows leave the coupled system.
        moving = np.abs(deviation).max(axis=(1, 2)) > ACTIVE * scale
        if moving.any():
            self.active.append((places[moving], deviation[moving]))

    def solve(self, right: np.ndarray, tolerance: float = EXACT) -> np.ndarray:
        """J⁻¹ times right-hand sides (q, coefficients, columns)."""
        # The dense system costs the cube of the active unknowns, GMRES some products with J.
        solver = self._iterated if len(self._rows) * self.series.count > DIRECT else self._direct
        return np.stack([solver(column, tolerance) for column in np.moveaxis(right, 2, 0)], axis=2)

    @property
    def jacobian(self) -> np.ndarray:
        """The whole Jacobian, (q, coefficients, q, coefficients)."""
        blocks = real_blocks(self._reference_blocks, self.series.mean)
        if self.active:
            across = real_blocks(self._across, self.series.mean)
            shape = across.shape
            values = self._times(across.reshape(-1, shape[2] * shape[3])).reshape(shape)
            np.add.at(blocks, self._rows, values)
        return blocks

    @property
    def sign(self) -> float:
        r"""Sign of the determinant of J, which is :math:`\det A\,\det(1 + V A^{-1} E m)`."""
        # Blocks of harmonics are complex numbers as pairs of real ones: their determinants are positive.
        reference_sign = np.linalg.slogdet(self._supported_blocks[0].real)[0] if self.series.mean else 1.0
        if not self.active:
            return float(reference_sign)
        matrix, pivots = self._coupled[1]
        # LU with row exchanges: the determinant is the product of U's diagonal, with a sign for each exchange.
        swapped = np.sum(pivots != np.arange(len(pivots))) % 2
        return float(reference_sign * (-1) ** swapped * np.prod(np.sign(np.diag(matrix))))

    @cached_property
    def _rows(self) -> np.ndarray:
        """Coordinates of the active contacts."""
        return np.concatenate([np.zeros(0, dtype=int), *(places.ravel() for places, _ in self.active)])

    def _times(self, values: np.ndarray) -> np.ndarray:
        """m times values (active * coefficients, columns)."""
        result, at = np.empty_like(values), 0
        for _, blocks in self.active:
            cells, size, _ = blocks.shape
            span = slice(at, at + cells * size)
            result[span] = (blocks @ values[span].reshape(cells, size, -1)).reshape(cells * size, -1)
            at += cells * size
        return result

    @cached_property
    def _reference_blocks(self) -> np.ndarray:
        """A, (orders, q, q)."""
        blocks = np.where(self.rigid[:, None], 0.0, self.point.stiffness)
        diagonal = np.arange(len(self.reference))
        blocks[:, diagonal, diagonal] += self.reference
        return blocks

    @cached_property
    def unresisted(self) -> np.ndarray:
        """Mean motions (q, motions) that neither the structure nor an element resists."""
        if self.held is None:
            return np.zeros((len(self.reference), 0))
        columns = []
        for motion in self.held.motions.T:
            values = np.zeros((len(motion), self.series.count))
            values[:, 0] = motion
            columns.append(self._unsupported_product(values).ravel())
        return self.held.unresisted(np.stack(columns, axis=1), self._largest)

    def unbalanced(self, residual: np.ndarray) -> np.ndarray:
        """Mean forces along :attr:`unresisted` at a residual, N, (motions,)."""
        return self.unresisted.T @ residual[:, 0]

    @property
    def _largest(self) -> float:
        return max(self.point.stiffest, float(self.reference.max()))

    @cached_property
    def _support(self) -> np.ndarray | None:
        """Stiffness (q, q) at the mean that holds the motions which nothing resists; None without such motions."""
        if self.held is None or not self.unresisted.size:
            return None
        return self.held.support(self.unresisted, self._largest)

    @cached_property
    def _supported_blocks(self) -> np.ndarray:
        """A with the support, (orders, q, q)."""
        if self._support is None:
            return self._reference_blocks
        blocks = self._reference_blocks.copy()
        blocks[0] += self._support
        return blocks

    @cached_property
    def _across(self) -> np.ndarray:
        """V, (orders, active, q)."""
        rows, q = self._rows, len(self.reference)
        unit = np.zeros((len(rows), q))
        unit[np.arange(len(rows)), rows] = np.where(self.rigid[rows], -self.reference[rows], 1.0)
        return np.where(self.rigid[rows][:, None], self.point.stiffness[:, rows], 0.0) + unit

    def _stuck(self, right: np.ndarray) -> np.ndarray:
        """A⁻¹ times phasors (orders, q, columns)."""
        if self.rigid.all() and self._support is None:
            return right / self.reference[:, None]
        if "factors" not in self.point.kept:
            self.point.kept["factors"] = [lu_factor(block, check_finite=False) for block in self._reference_blocks]
        factors: Sequence[Any] = self.point.kept["factors"]
        if self._support is not None:
            factors = [self._supported_mean, *factors[1:]]
        pairs = zip(factors, right, strict=True)
        return np.stack([lu_solve(factor, columns, check_finite=False) for factor, columns in pairs])

    @cached_property
    def _supported_mean(self) -> Any:
        return lu_factor(self._supported_blocks[0], check_finite=False)

    @cached_property
    def _coupled(self) -> tuple[np.ndarray, Any]:
        """A⁻¹ E, (orders, q, active), and the factors of 1 + V A⁻¹ E m."""
        rows = self._rows
        unit = np.zeros((len(self.series.orders), len(self.reference), len(rows)), dtype=complex)
        unit[:, rows, np.arange(len(rows))] = 1.0
        response = self._stuck(unit)
        size = len(rows) * self.series.count
        # 1 + V A⁻¹ E m (Woodbury), in the order that inverts no m, which is singular where a contact stays open.
        among = real_blocks(self._across @ response, self.series.mean).reshape(size, size)
        at, matrix = 0, np.empty_like(among)
        for _, blocks in self.active:
            cells, width, _ = blocks.shape
            columns = slice(at, at + cells * width)
            product = among[:, columns].reshape(size, cells, width).transpose(1, 0, 2) @ blocks
            matrix[:, columns] = product.transpose(1, 0, 2).reshape(size, cells * width)
            at += cells * width
        matrix[np.arange(size), np.arange(size)] += 1.0
        return response, lu_factor(matrix, check_finite=False, overwrite_a=True)

    def _direct(self, right: np.ndarray, tolerance: float = EXACT) -> np.ndarray:
        """J⁻¹ times (q, coefficients) by a dense system among the active contacts; to rounding."""
        series = self.series
        # J⁻¹ b = A⁻¹ b - A⁻¹ E m (1 + V A⁻¹ E m)⁻¹ V A⁻¹ b
        first = self._stuck(series.phasors(right)[:, :, None])
        if not self.active:
            return series.coefficients(first[:, :, 0])
        response, factors = self._coupled
        seen = series.coefficients((self._across @ first)[:, :, 0]).ravel()
        force = self._times(lu_solve(factors, seen, check_finite=False)[:, None])[:, 0]
        back = response @ series.phasors(force.reshape(-1, series.count))[:, :, None]
        return series.coefficients((first - back)[:, :, 0])

    @cached_property
    def _preconditioner(self) -> np.ndarray:
        """Inverse of A + E m V without its coupling of harmonics, (orders, q, q)."""
        q, mean = len(self.reference), self.series.mean
        coupling = np.zeros((len(self.series.orders), q, q), dtype=complex)
        for places, blocks in self.active:
            cells, columns = places.shape
            # m couples harmonics through kinks of the force; without this coupling each harmonic has its own small
            # matrix.
            local = complex_blocks(blocks.reshape(cells, columns, -1, columns, self.series.count), mean)
            for part, blocks in zip(coupling, local, strict=True):
                np.add.at(part, (places[:, :, None], places[:, None, :]), blocks)  # type: ignore[arg-type]
        seen = np.where(self.rigid[:, None], self.point.stiffness, 0.0)
        diagonal = np.arange(q)
        seen[:, diagonal, diagonal] += np.where(self.rigid, -self.reference, 1.0)
        return np.linalg.inv(self._supported_blocks + coupling @ seen)

    def _product(self, values: np.ndarray) -> np.ndarray:
        """J, with the support, times (q * coefficients,)."""
        values = values.reshape(len(self.reference), self.series.count)
        result = self._unsupported_product(values)
        if self._support is not None:
            result[:, 0] += self._support @ values[:, 0]
        return result.ravel()

    def _unsupported_product(self, values: np.ndarray) -> np.ndarray:
        """J times (q, coefficients)."""
        series, rigid, rows = self.series, self.rigid[:, None], self._rows
        sticking = self.reference[:, None] * values
        moved = series.coefficients((self.point.stiffness @ series.phasors(values)[:, :, None])[:, :, 0])
        result = np.where(rigid, sticking, moved + sticking)
        seen = np.where(rigid, moved - sticking, values)[rows]
        np.add.at(result, rows, self._times(seen.reshape(-1, 1)).reshape(len(rows), -1))
        return result

    def _iterated(self, right: np.ndarray, tolerance: float) -> np.ndarray:
        """J⁻¹ times (q, coefficients) by GMRES, or directly if GMRES does not converge."""
        series, size = self.series, right.size

        def precondition(values: np.ndarray) -> np.ndarray:
            phasors = series.phasors(values.reshape(right.shape))
            return series.coefficients((self._preconditioner @ phasors[:, :, None])[:, :, 0]).ravel()

        products = self._product, precondition
        operator, near = (LinearOperator((size, size), matvec=product, dtype=float) for product in products)  # type: ignore[call-arg]
        solution, failed = gmres(
            operator, right.ravel(), rtol=tolerance, atol=0.0, restart=KRYLOV, maxiter=CYCLES, M=near
        )
        return self._direct(right) if failed else solution.reshape(right.shape)
