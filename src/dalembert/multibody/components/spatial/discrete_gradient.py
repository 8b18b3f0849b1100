"""Gonzalez's discrete gradient: what the gradient in the middle of a step misses of the change of a function."""

from dalembert.kernels.kernel import inlined
from dalembert.multibody.kernels.elementary import reciprocal

STILL = 1e-10
"""Square of a change of dimensionless arguments below which what is missing, of third order, is rounding."""


@inlined
def along_change(missing, square):
    """Factor s of the change d of the arguments, for which s d . d is what is missing; ``square``: d . d."""
    # Where nothing changes both are zero; a part of 1e-10 / d . d of the missing work stays missing.
    return missing * reciprocal(square + STILL)
