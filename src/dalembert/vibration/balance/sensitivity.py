r"""Exact derivatives of a balanced response by parameters.

With :math:`R(U, p) = 0`, :math:`\mathrm{d}U/\mathrm{d}p = -J^{-1}\, \partial R/\partial p`. A system built with a
parameter moved by a complex step carries the derivatives of its matrices, forces and laws in its imaginary parts. Those
of the condensed structure follow without condensing it again: with x the motion of the whole structure,
:math:`\partial (Z_q U - F_q)/\partial p = (1, -Z_{ql} Z_{ll}^{-1}) (Z' x - f')`.
"""

from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from dalembert.structure.structure import MATRICES, ROTATING
from dalembert.vibration.balance.balance import Balance
from dalembert.vibration.balance.equations import Equations
from dalembert.vibration.balance.newton import Solution
from dalembert.vibration.balance.receptance_balance import ReceptanceBalance
from dalembert.vibration.balance.receptance_tangent import ReceptanceTangent
from dalembert.vibration.interface.dynamic_stiffness import combined, factors
from dalembert.vibration.interface.lowering import Lowered
from dalembert.vibration.interface.receptances import ReceptancePoint

STEP = 1e-30
"""Size of the imaginary step; second-order terms vanish below the rounding of the first."""


def sensitivities(problem: Equations, solution: Solution, perturbed: Sequence[Lowered]) -> np.ndarray:
    """Return the derivatives of the coefficients of all degrees of freedom, (parameters, n, coefficients).

    ``solution``: converged; ``perturbed``: the system along each parameter, moved by a complex step.
    """
    if isinstance(solution.point, ReceptancePoint):
        return _by_receptances(problem, solution, solution.point, perturbed)
    series, condensation, point = problem.balance(solution.samples).series, problem.condensation, solution.condensed
    retained = series.phasors(solution.unknowns)
    motion = condensation.full(retained, point.interior(retained))
    linear = problem.stiffness_balance(solution.samples).linear(point.stiffness, point.force, solution.unknowns)
    inner_pushes, residuals = [], []
    for system in perturbed:
        # f' - Z' x of all degrees of freedom: what the parameter changes where the motion is held.
        push = series.phasors(step_of(system.load_coefficients(series, point.omega))) - unbalanced(
            system, point.omega, point.frequencies, motion
        )
        outer, inner = push @ condensation.retained, np.asarray((condensation.back.T @ push.T).T)
        # The part at q less that at the interior, condensed as loads are.
        condensed = outer - (point.passed @ inner[:, :, None])[:, :, 0]
        # The laws see the real motion and complex numbers; the linear part carries its derivative in its imaginary
        # part, so that rigid contacts, which see the residual, take both at once.
        elements = with_elements(problem.lowered, system)
        stepped = linear - 1j * STEP * series.coefficients(condensed)
        residuals.append(
            step_of(
                Balance(elements, series, problem.method.events)
                .residual(stepped, solution.unknowns, point.omega)
                .residual
            )
        )
        inner_pushes.append(inner)
    # dU/dp = -J⁻¹ ∂R/∂p for all parameters at once.
    moved = -np.moveaxis(solution.tangent.solve(np.stack(residuals, axis=2)), 2, 0)
    result = []
    for change, inner in zip(moved, inner_pushes, strict=True):
        shift = series.phasors(change)
        # dx_l/dp = Z_ll⁻¹ (f' - Z' x)_l - Z_ll⁻¹ Z_lq dU/dp
        interior = condensation.solve(point.frequencies, inner[:, :, None])[:, :, 0]
        interior = interior - (point.follow @ shift[:, :, None])[:, :, 0]
        result.append(series.coefficients(condensation.full(shift, interior)))
    return np.stack(result)


def _by_receptances(
    problem: Equations, solution: Solution, point: ReceptancePoint, perturbed: Sequence[Lowered]
) -> np.ndarray:
    r"""Return the same by receptances. With x the motion and r kept,
    :math:`\partial R/\partial p = -B Z_r^{-1} (f' - Z' x) + G\, \partial\lambda/\partial p`.
    """
    series, tangent, rows = point.series, solution.tangent, point.stuck.rows
    balance = problem.balance(solution.samples)
    assert isinstance(balance, ReceptanceBalance)
    assert isinstance(tangent, ReceptanceTangent)
    motion = series.phasors(point.motion(balance.deviation(point.omega, solution.unknowns)))
    pushes, forces, residuals = [], [], []
    for system in perturbed:
        push = series.phasors(step_of(system.load_coefficients(series, point.omega))) - unbalanced(
            system, point.omega, point.frequencies, motion
        )
        elements = with_elements(problem.lowered, system)
        # The parameter may change the forces and, of rigid contacts, displacements where what they predict is held.
        moving = replace(balance, lowered=elements)
        displaced = step_of(moving.displacements(solution.unknowns))
        pushes.append(series.coefficients(push))
        forces.append(step_of(moving.deviation(point.omega, solution.unknowns)))
        residuals.append(displaced + point.respond(forces[-1]) - rows @ point.answer(pushes[-1]))
    moved = -np.moveaxis(tangent.solve(np.stack(residuals, axis=2)), 2, 0)
    # dx/dp = Z_r⁻¹ (f' - Z' x - Bᵀ (∂λ/∂p + m du/dp)): the motion by what the parameter adds to all forces.
    return np.stack(
        [
            point.answer(push - rows.T @ (force + tangent.beyond(change)))
            for push, force, change in zip(pushes, forces, moved, strict=True)
        ]
    )


def with_elements(real: Lowered, moved: Lowered) -> Lowered:
    """Return a system with the elements of another."""
    return replace(real, blocks=moved.blocks, laws=moved.laws, functions=moved.functions)


def unbalanced(lowered: Lowered, omega: float, frequencies: np.ndarray, motion: np.ndarray) -> np.ndarray:
    """Return Z' x, (orders, n), from the imaginary parts of the matrices and of the speed of a rotor. ``motion``
    (orders, n): phasors x at frequencies h ω (orders,).
    """
    # (Ω N)' and (Ω G)': the speed may depend on the parameter, too.
    speed = lowered.spin(omega)[0]
    matrices = {name: matrix for name in MATRICES if (matrix := getattr(lowered.structure, name)) is not None}
    matrices |= {name: speed * matrices[name] for name in ROTATING if name in matrices}
    moved = {name: step_of(matrix) @ motion.T for name, matrix in matrices.items()}
    return np.asarray(combined(factors(moved, frequencies, 1.0), moved)).T


def step_of(array: Any) -> Any:
    """Return the derivative in an imaginary part; zero where there is none."""
    return array.imag / STEP if np.iscomplexobj(array) else 0.0 * array
