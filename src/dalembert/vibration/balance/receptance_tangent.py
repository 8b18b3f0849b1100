r"""The Jacobian of the balance by receptances, and the linear systems with it.

:math:`J = 1 + G\,m`, with one block m for each element that does not do what its reference says. With a the rows of
these elements, :math:`J x = b` is :math:`(1 + G_{aa} m)\,x_a = b_a` and :math:`x = b - G_a m\,x_a` on all rows. Rigid
contacts, whose unknowns are not their displacements, add a block to the 1.

Few active rows are solved for by a dense matrix. Many are solved for by GMRES: a product costs one block for each
element and one product with the compliance for all harmonics. Its preconditioner is the inverse of :math:`1 + G m` of
each element alone, with its own compliance.
"""

import warnings
from collections.abc import Callable
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any

import numpy as np
from scipy.linalg import LinAlgWarning, lu_factor, lu_solve
from scipy.sparse.linalg import LinearOperator, gmres

from dalembert.vibration.balance.block_tangent import EXACT
from dalembert.vibration.fourier import real_blocks
from dalembert.vibration.interface.receptances import ReceptancePoint

DIRECT = 120
"""Active unknowns up to which a dense system costs less than iterations."""
SINGLE = 1e-5
"""Tolerance from which on a compliance in single precision is enough."""
SIGNED = 4000
"""Active unknowns up to which a dense matrix is made where it is needed: for a sign, or where iterations fail."""
NEAR = 1e-7
"""Residual of a linear system, as part of its right-hand side, that rounding may leave."""
RESISTED = 1e-10
"""Forces of the elements under a mean motion, as part of those where all stick, up to which nothing resists it."""
LOOSE = 1e-12
"""Square of the same, above which a motion is certainly resisted."""
KRYLOV, CYCLES = 200, 3
"""Iterations of GMRES in a cycle, and cycles."""


@dataclass(frozen=True)
class ActiveCells:
    """Elements of a kind: their rows (cells, columns), and the blocks of m (cells, unknowns, unknowns). ``displaced``:
    those that rigid contacts add to the unit matrix.
    """

    rows: np.ndarray
    blocks: np.ndarray
    displaced: np.ndarray | None = None

    @cached_property
    def share(self) -> bool:
        """Whether some of them have the same rows, as cells of an Iwan contact do."""
        return len(np.unique(self.rows)) < self.rows.size


@dataclass(frozen=True)
class ReceptanceTangent:
    """Derivatives of the residual. ``slope`` (rows, coefficients): by what the path follows; ``cells``: the elements
    that do not do what their reference says.
    """

    point: ReceptancePoint
    slope: np.ndarray
    cells: tuple[ActiveCells, ...]
    _kept: dict[str, Any] = field(default_factory=dict, repr=False)

    #: Residual of the linear system of a Newton step, as part of its right-hand side.
    forcing = 1e-3

    @cached_property
    def unresisted(self) -> np.ndarray:
        """Mean motions (rows, motions), orthonormal, that neither the structure nor an element resists.

        Where all contacts of a part slip, their mean forces do not depend on its mean position.
        """
        free, reference = self.point.stuck.free, self.point.stuck.reference
        if not free.shape[1] or not self.point.series.mean:
            return np.zeros((len(self.slope), 0))
        # Forces of all elements under a mean motion φ, (r + m) φ: where these vanish, J φ = φ - G r φ = 0.
        forces = np.zeros((*self.slope.shape, free.shape[1]))
        forces[:, 0] = reference[:, None] * free
        largest = np.linalg.norm(forces)
        for number, motion in enumerate(free.T):
            values = np.zeros((len(self._rows), self.slope.shape[1]))
            values[:, 0] = motion[self._rows]
            forces[self._rows, :, number] += self._times(values, supported=False)
        forces = forces.reshape(-1, free.shape[1])
        # Squares of the singular values first: they need no more than a small matrix.
        if np.linalg.eigvalsh(forces.T @ forces)[0] > LOOSE * largest**2:
            return np.zeros((len(self.slope), 0))
        _, sizes, shapes = np.linalg.svd(forces, full_matrices=False)
        return free @ shapes[sizes <= RESISTED * largest].T

    def unbalanced(self, residual: np.ndarray) -> np.ndarray:
        """Mean forces along :attr:`unresisted` at a residual, N, (motions,)."""
        # K_r φ = Bᵀ r B φ for a motion that the structure does not resist; its largest displacement is 1.
        motions = self.unresisted / np.abs(self.unresisted).max(axis=0, initial=1e-300)
        return (self.point.stuck.reference[:, None] * motions).T @ residual[:, 0]

    @cached_property
    def _support(self) -> np.ndarray | None:
        """Mean motions of the active rows that are held by their references, (active, motions); None without any."""
        motions = self.unresisted[self._rows]
        return motions if motions.size else None

    @property
    def sign(self) -> float:
        """Sign of the determinant, as far as a dense matrix gives it; else 0."""
        if not len(self._rows):
            return 1.0
        if len(self._rows) * self.slope.shape[1] > SIGNED:
            return 0.0
        matrix, pivots = self._factors
        swapped = np.sum(pivots != np.arange(len(pivots))) % 2
        return float((-1) ** swapped * np.prod(np.sign(np.diag(matrix))))

    def solve(self, right: np.ndarray, tolerance: float = EXACT) -> np.ndarray:
        """J⁻¹ times right-hand sides (rows, coefficients, columns)."""
        # The Jacobian is the identity but for the columns of the active rows: a system among these, then one product.
        rows, result = self._rows, right.astype(float)
        if not len(rows):
            return result
        for column in range(right.shape[2]):
            active = self._solve_active(right[rows, :, column], tolerance)
            result[:, :, column] -= self.point.respond(self._times(active), rows, tolerance >= SINGLE)
            # On the active rows the solution is known to the tolerance, elsewhere it follows from them.
            result[rows, :, column] = active
        return result

    def bordered(
        self, columns: np.ndarray, across: np.ndarray, corner: np.ndarray, top: np.ndarray, bottom: np.ndarray,
        tolerance: float = EXACT,
    ) -> tuple[np.ndarray, np.ndarray]:  # fmt: skip
        """Solve J x + S z = r, C x + D z = b, which is regular where J is not: x (rows, coefficients) and z (k,).

        ``columns`` (rows, coefficients, k): S; ``across`` (k, rows, coefficients): C; ``corner`` (k, k): D; ``top``,
        ``bottom``: r and b. LinAlgError where it is singular.
        """
        # x = r - S z - G f with the forces f = m x_a of the active rows: a system for x_a and z.
        rows, size = self._rows, self.slope.shape[1]
        count, borders = len(rows) * size, len(bottom)
        reached = np.stack([self.point.respond_transposed(row)[rows].ravel() for row in across])
        flat = across.reshape(borders, -1)
        inner = corner - flat @ columns.reshape(-1, borders)
        right = np.append(top[rows].ravel(), bottom - flat @ top.ravel())
        beside = columns[rows].reshape(count, borders)
        solution = None if count <= DIRECT else self._bordered_iterated(beside, reached, inner, right, tolerance)
        if solution is None:
            if count > SIGNED:
                raise np.linalg.LinAlgError("GMRES does not converge")
            below = -np.stack([self._times(row.reshape(-1, size), transposed=True).ravel() for row in reached])
            solution = np.linalg.solve(np.block([[self._matrix, beside], [below, inner]]), right)
        active, scalars = solution[:count].reshape(-1, size), solution[count:]
        result = top - columns @ scalars - self.point.respond(self._times(active), rows)
        result[rows] = active
        return result, scalars

    def _bordered_iterated(
        self, beside: np.ndarray, reached: np.ndarray, inner: np.ndarray, right: np.ndarray, tolerance: float
    ) -> np.ndarray | None:
        """The solution for the active rows and z by GMRES; None where it does not converge."""
        count, shape = len(beside), (len(self._rows), self.slope.shape[1])
        product = self._product(tolerance >= SINGLE)

        def bordered(values: np.ndarray) -> np.ndarray:
            active = self._preconditioned(values[:count].reshape(shape))
            moved, force = product(active)
            scalars = values[count:]
            return np.append(moved.ravel() + beside @ scalars, inner @ scalars - reached @ force.ravel())

        operator = LinearOperator((len(right), len(right)), matvec=bordered, dtype=float)  # type: ignore[call-arg]
        solution, failed = gmres(operator, right, rtol=tolerance, atol=0.0, restart=KRYLOV, maxiter=CYCLES)
        if failed and np.linalg.norm(operator @ solution - right) > NEAR * np.linalg.norm(right):
            return None
        return np.append(self._preconditioned(solution[:count].reshape(shape)).ravel(), solution[count:])

    def beyond(self, change: np.ndarray) -> np.ndarray:
        """m times a change of the displacements of all rows (rows, coefficients): of forces beyond the reference."""
        result = np.zeros_like(change)
        result[self._rows] = self._times(change[self._rows])
        return result

    @cached_property
    def _rows(self) -> np.ndarray:
        """Rows of the active elements, in ascending order."""
        parts = [cells.rows.ravel() for cells in self.cells]
        return np.unique(np.concatenate(parts)) if parts else np.zeros(0, dtype=int)

    @cached_property
    def _places(self) -> list[np.ndarray]:
        """Places of the rows of elements among the active ones, (cells, columns)."""
        return [np.searchsorted(self._rows, cells.rows) for cells in self.cells]

    @property
    def _is_small(self) -> bool:
        return len(self._rows) * self.slope.shape[1] <= DIRECT

    def _times(self, values: np.ndarray, supported: bool = True, transposed: bool = False) -> np.ndarray:
        """m, or its transpose, times values of the active rows (active, coefficients), with the support of what nothing
        resists.
        """
        result = np.zeros_like(values)
        if supported and self._support is not None:
            # φ k φᵀ of the mean, k as stiff as the contacts. It does not act where the forces are in balance.
            result[:, 0] = self._support @ (self._stiffness * (self._support.T @ values[:, 0]))
        for places, cells in zip(self._places, self.cells, strict=True):
            count, size, _ = cells.blocks.shape
            blocks = np.swapaxes(cells.blocks, 1, 2) if transposed else cells.blocks
            product = (blocks @ values[places].reshape(count, size, 1)).reshape(*places.shape, -1)
            if cells.share:
                np.add.at(result, places, product)
            else:
                result[places] += product
        return result

    @cached_property
    def _stiffness(self) -> float:
        """Stiffness of the support, N/m: the largest one of a row."""
        return float(self.point.stuck.reference.max())

    def _solve_active(self, right: np.ndarray, tolerance: float) -> np.ndarray:
        if self._is_small:
            return self._direct(right)
        return self._iterated(right, tolerance)

    def _direct(self, right: np.ndarray) -> np.ndarray:
        return lu_solve(self._factors, right.ravel(), check_finite=False).reshape(right.shape)

    @cached_property
    def _factors(self) -> Any:
        """Factors of 1 + G m among the active rows."""
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", LinAlgWarning)
            factors = lu_factor(self._matrix, check_finite=False, overwrite_a=True)
        if not np.all(np.abs(np.diag(factors[0])) > 0):
            raise np.linalg.LinAlgError("the Jacobian is singular")
        return factors

    @property
    def _matrix(self) -> np.ndarray:
        """1 + G m among the active rows, (unknowns, unknowns)."""
        # 1 + G_aa m, element by element: m is block-diagonal, G_aa full among rows and diagonal among harmonics.
        size = self.slope.shape[1]
        count = len(self._rows) * size
        response = real_blocks(self.point.among(self._rows), self.point.series.mean).reshape(
            count, len(self._rows), size
        )
        matrix = np.eye(count)
        for places, cells in zip(self._places, self.cells, strict=True):
            for place, block in zip(places, cells.blocks, strict=True):
                columns = response[:, place].reshape(count, -1) @ block
                matrix.reshape(count, len(self._rows), size)[:, place] += columns.reshape(count, len(place), size)
            if cells.displaced is not None:
                for place, block in zip(places, cells.displaced, strict=True):
                    unknowns = (place[:, None] * size + np.arange(size)).ravel()
                    matrix[np.ix_(unknowns, unknowns)] += block
        if self._support is not None:
            support = self._stiffness * self._support @ self._support.T
            of = matrix.reshape(count, len(self._rows), size)
            of[:, :, 0] += response[:, :, 0] @ support
        return matrix

    def _iterated(self, right: np.ndarray, tolerance: float) -> np.ndarray:
        shape, size = right.shape, right.size
        product = self._product(tolerance >= SINGLE)

        # Preconditioned from the right: the residual that GMRES judges is that of the system.
        def preconditioned(values: np.ndarray) -> np.ndarray:
            return product(self._preconditioned(values.reshape(shape)))[0].ravel()

        operator = LinearOperator((size, size), matvec=preconditioned, dtype=float)  # type: ignore[call-arg]
        # Rigid contacts on all degrees of freedom have no good preconditioner: the dense system follows sooner.
        cycles = 1 if size <= SIGNED and any(cells.displaced is not None for cells in self.cells) else CYCLES
        solution, failed = gmres(operator, right.ravel(), rtol=tolerance, atol=0.0, restart=KRYLOV, maxiter=cycles)
        if failed and size <= SIGNED:
            return self._direct(right)
        if failed and np.linalg.norm(operator @ solution - right.ravel()) > NEAR * np.linalg.norm(right):
            raise np.linalg.LinAlgError("GMRES does not converge")
        return self._preconditioned(solution.reshape(shape))

    def _product(self, single: bool) -> Callable[[np.ndarray], tuple[np.ndarray, np.ndarray]]:
        """1 + G m and m times values of the active rows, (active, coefficients), as a function of these."""
        compliance, shapes = self._compliance(single), self.point.stuck.row_shapes[self._rows]

        def product(values: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
            force = self._times(values)
            # One product for all harmonics: G_0 is real. The gains of the modes are complex, but the modes are few.
            static = (compliance @ force.astype(compliance.dtype)).astype(float)
            moved = values + static + shapes @ self.point.with_gains(shapes.T @ force)
            for places, cells in zip(self._places, self.cells, strict=True):
                if cells.displaced is not None:
                    moved[places] += (cells.displaced @ values[places].reshape(*cells.displaced.shape[:2], 1)).reshape(
                        *places.shape, -1
                    )
            return moved, force

        return product

    def _compliance(self, single: bool) -> np.ndarray:
        key = "single" if single else "double"
        if key not in self._kept:
            whole = self.point.stuck.single if single else self.point.stuck.compliance
            rows = self._rows
            self._kept[key] = whole if len(rows) == len(whole) else whole[np.ix_(rows, rows)]
        return self._kept[key]

    def _preconditioned(self, values: np.ndarray) -> np.ndarray:
        """The inverses of 1 + G m of elements alone times values of the active rows."""
        result = values.copy()
        for places, inverses in self._inverses:
            count, size, _ = inverses.shape
            result[places] = (inverses @ values[places].reshape(count, size, 1)).reshape(*places.shape, -1)
        return result

    @cached_property
    def _inverses(self) -> list[tuple[np.ndarray, np.ndarray]]:
        size = self.slope.shape[1]
        result = []
        for cells, places in zip(self.cells, self._places, strict=True):
            # Cells of an Iwan contact share their rows: they are one element.
            _, order, element = np.unique(cells.rows[:, 0], return_index=True, return_inverse=True)
            blocks = np.zeros((len(order), *cells.blocks.shape[1:]))
            np.add.at(blocks, element, cells.blocks)
            rows, columns = cells.rows[order], cells.rows.shape[1]
            # (1 + G_cc m)⁻¹ with the static G_cc, which is the same for all harmonics: the inertia of a contact's own
            # compliance matters little, as its modes are the fastest ones.
            compliance = self.point.stuck.compliance[rows[:, :, None], rows[:, None, :]]
            product = (compliance @ blocks.reshape(len(rows), columns, -1)).reshape(blocks.shape)
            product[:, np.arange(columns * size), np.arange(columns * size)] += 1.0
            product += 0.0 if cells.displaced is None else cells.displaced
            try:
                inverses = np.linalg.inv(product)
            except np.linalg.LinAlgError:  # an element that alone holds a part, and slips
                inverses = np.broadcast_to(np.eye(columns * size), product.shape)
            result.append((places[order], inverses))
        return result
