"""What follows from the functions of a kind: constraint forces, time derivatives of constraints, power of forces."""

from collections.abc import Callable
from typing import Any

from dalembert.kernels.kernel import inlined, inner
from dalembert.kernels.views import stack
from dalembert.multibody.kernels.jets import jets
from dalembert.multibody.kernels.time_inputs import in_time


def forces_of(constraint: Callable[..., Any], coordinates: int, multipliers: int) -> Callable[..., Any]:
    """Constraint forces J^T lambda, with one column of J = dg/dx from each evaluation of g."""
    width = coordinates + multipliers

    @inner
    def forces(x, p, m, inputs, r):
        seed, zero = stack(x, width), stack(x, width)
        g, slope, unused = stack(x, multipliers), stack(x, multipliers), stack(x, multipliers)
        for i in range(width):
            seed[i], zero[i] = 0.0, 0.0
        for j in range(coordinates):
            # One jet along each coordinate: its slope is a column of J, which the multipliers weigh.
            seed[j] = 1.0
            constraint(jets(x, seed, zero), p, m, inputs, jets(g, slope, unused))
            seed[j] = 0.0
            for k in range(multipliers):
                r[j] += slope[k] * x[coordinates + k]

    return forces


def residual_of(
    constraint: Callable[..., Any], forces: Callable[..., Any] | None, coordinates: int, multipliers: int
) -> Callable[..., Any]:
    """Constraint forces, by their formula if there is one, and constraints."""
    formula: Any = forces

    @inlined
    def by_formula(x, p, m, inputs, r):
        formula(x, p, m, r)

    used = forces_of(constraint, coordinates, multipliers) if forces is None else by_formula

    @inlined
    def residual(x, v, a, p, m, inputs, r):
        used(x, p, m, inputs, r)
        constraint(x, p, m, inputs, r[coordinates:])

    return residual


def rates_of(constraint: Callable[..., Any], multipliers: int) -> Callable[..., Any]:
    """First and second time derivatives of constraints along a motion: jets of q(t) = x + v t + a t^2 / 2 through g."""

    @inner
    def rates(x, v, a, p, m, inputs, rate, second):
        g = stack(x, multipliers)
        # With x' = v and x'' = a the first two derivatives of g(x(t), t) are J v + g_t and J a + (all that is quadratic
        # in v): the rows of the index-2 and index-1 equations.
        constraint(jets(x, v, a), p, m, in_time(inputs), jets(g, rate, second))

    return rates


def power_of(residual: Callable[..., Any], width: int) -> Callable[..., Any]:
    """No energies, and the power of the forces of a residual, -r v at zero acceleration."""

    @inner
    def energy(x, v, p, m, inputs):
        still, r = stack(x, width), stack(x, width)
        for i in range(width):
            still[i], r[i] = 0.0, 0.0
        # At zero acceleration: forces of inertia that depend on velocities alone do count.
        residual(x, v, still, p, m, inputs, r)
        power = 0.0 * x[0]
        for i in range(width):
            power -= r[i] * v[i]
        return 0.0 * x[0], 0.0 * x[0], power

    return energy
