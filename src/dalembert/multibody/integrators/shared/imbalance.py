"""Whether Newton's corrections ended by rounding, or by a matrix that is much too stiff.

Corrections that stop to shrink are small in both cases. Where a nearly singular position magnifies rounding, the forces
are in balance. Where friction has reached its limit, the matrix of sticking turns a large part of the forces into tiny
corrections, r / (D h): without balance the iteration is far from its end, and a step that ends there sticks too long.
"""

from dalembert.kernels.kernel import inlined

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
