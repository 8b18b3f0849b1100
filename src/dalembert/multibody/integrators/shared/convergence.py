"""When Newton's iteration of a step has converged, and when a step is halved.

Corrections that stop to shrink are small in two cases. Where a nearly singular position magnifies rounding, the forces
are in balance. Where friction has reached its limit, the matrix of sticking turns a large part of the forces into tiny
corrections, r / (D h): without balance the iteration is far from its end, and a step that ends there sticks too long.
"""

from dalembert.kernels.kernel import inlined, inner

HALVINGS = 16
"""How often a fixed step is halved on which Newton's iteration does not converge."""

ROUNDING, MAGNIFIED = 1e-12, 1e-9
"""Relative corrections that stop to shrink are rounding below the first size, and below the second one if a nearly
singular position magnifies it, and if the forces are in balance."""

CLOSED = 1e-15
"""Constraint violation against the largest scale that is rounding."""

NOISE = 1e-13
"""Relative correction below which the ratio of two corrections says nothing of the factorisation."""

BALANCED = 1e-6
"""Part of the forces that rounding may leave. With more, some of the random blocks in the verification of stick and
slip stick too long; less makes none of them more exact."""


@inlined
def largest_entry(values, begin, end):
    """Largest absolute value from begin to end."""
    size = 0.0
    for k in range(begin, end):
        size = max(size, abs(values[k]))
    return size


@inner
def has_settled(norm, before, tolerance):
    """Whether an iteration on slopes ends. ``norm``: the largest correction, as a part of the slopes; ``before``: the
    same in the iteration before, 0 in the first.
    """
    if norm <= tolerance or not norm < 1e100:
        return True
    if before == 0.0:
        return False
    # The sum of the corrections to come is norm rate / (1 - rate) with rate = norm / before. Below 1e-10, corrections
    # that no longer shrink are rounding.
    return (norm < before and norm * norm <= (before - norm) * tolerance) or (norm <= 1e-10 and norm > 0.5 * before)
