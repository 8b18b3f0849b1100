"""Compiled: dry friction under a variable normal load.

One contact has one or two tangential displacements and, or not, a normal one; with d the displacements, z the slider's
place, k_t and k_n stiffnesses, g the gap and N0 the initial normal load:

    N = N0 + k_n (d_N - g);   separated where N <= 0: no force, z = d_T
    p = k_t (d_T - z);        stuck where |p| <= mu N: force p
    otherwise slipping:       force mu N p/|p|, z = d_T - force/k_t

The rigid law of Coulomb and Signorini is the same function of a predicted displacement (see
:mod:`dalembert.vibration.balance.balance`); with ``memory`` off the slider stays at zero, and d_T may be any predicted
force.

Comparisons are of real parts: in complex arithmetic an imaginary part is a direction of differentiation. At a kink
(|p| = mu N, or N = 0) the derivative is the one-sided one of the stuck and of the separated branch.
"""

import numpy as np

from dalembert.kernels.kernel import inner
from dalembert.vibration.laws.law import law

SEPARATED, STUCK, SLIPPING = 0, 1, 2
STATES = ("separated", "stuck", "slipping")

#: Columns of a contact's numbers.
TANGENTIAL, NORMAL, GAP, FRICTION, LOAD = range(5)


@inner
def update(d, z, force, numbers, tangents, normal, memory):
    """One sample: writes the forces (normal: N - N0), moves the slider; the state, and the size of the trial force."""
    # Order matters: the load first, since the limit depends on it; then the trial force, as if the slider stuck; its
    # return to the limit last (return mapping, as in plasticity: Simo and Hughes, Computational Inelasticity, 1998).
    load = numbers[LOAD]
    if normal:
        load = load + numbers[NORMAL] * (d[tangents] - numbers[GAP])
        # An open contact lets its slider go along: it closes again without tangential force.
        if load.real <= 0.0:
            for i in range(tangents):
                force[i] = 0.0
                if memory:
                    z[i] = d[i]
            force[tangents] = -numbers[LOAD]
            return SEPARATED, 0.0 * load
        force[tangents] = load - numbers[LOAD]
    limit = numbers[FRICTION] * load
    stiffness = numbers[TANGENTIAL]
    for i in range(tangents):
        force[i] = stiffness * (d[i] - z[i])
    if tangents == 1:
        # |p| without abs, which would drop the imaginary part; analytic on each side of zero.
        size = force[0] if force[0].real >= 0.0 else -force[0]
    else:
        size = np.sqrt(force[0] * force[0] + force[1] * force[1])
    if size.real <= limit.real:
        return STUCK, size
    for i in range(tangents):
        # The radial return p mu N/|p|: exact for the step in one dimension, of first order in the step in two.
        force[i] = limit * force[i] / size
        if memory:
            z[i] = d[i] - force[i] / stiffness
    return SLIPPING, size


@law
def sliding(u, v, z, numbers, force):
    """The elastic contact as a general law; its state is the slider's place."""
    update(u, z, force, numbers, len(z), len(u) > len(z), True)
