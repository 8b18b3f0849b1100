"""Where Newton's iteration on a step of the midpoint rule begins, and what a step keeps for the next one.

Steps with constraint forces at both ends begin with the accelerations of the start and what these missed in the step
before. Those with forces of the middle begin with the velocities of the middles of both steps before: stiff vibrations
that the step does not resolve change the sign of velocities and accelerations at each end, but have none in the middle.
"""

from dalembert.kernels.kernel import inner
from dalembert.multibody.integrators.midpoint.midpoint_step import place
from dalembert.multibody.kernels.elementary import where


@inner
def begin(n, h, start, slope, s):
    """A step ahead of a state, by its accelerations and multipliers and what they missed in the step before."""
    for k in range(len(start.x)):
        s.x0[k] = start.x[k]
        if k < n:
            s.v0[k] = start.v[k]
            s.a[k], s.b[k] = start.a[k] + slope[0, k], start.a[k] + slope[1, k]
        else:
            # Multipliers of both ends are unknowns of the step: those of its start are not those of the end of the step
            # before.
            s.x0[k], s.x1[k] = start.x[k] + slope[0, k], start.x[k] + slope[1, k]
    place(n, h, s)


@inner
def begin_by_means(n, h, last, start, mean, s):
    """A step ahead of a state, by the velocity ``mean[0]`` of the middle of the step before and its rate ``mean[1]``.

    ``last``: length of the step before, 0 at the start of a stretch.
    """
    for k in range(len(start.x)):
        s.x0[k] = start.x[k]
        if k < n:
            s.v0[k] = start.v[k]
            s.a[k] = 2.0 / h * (mean[0, k] + 0.5 * (h + last) * mean[1, k] - start.v[k])
            s.b[k] = s.a[k]
        else:
            s.x0[k] = s.x1[k] = mean[0, k]
    place(n, h, s)


@inner
def open_means(n, start, mean):
    """Velocities and multipliers of a start, as those of a step before."""
    # Without accelerations: those of a beam that begins to turn, not yet stretched, are of its directors alone, so that
    # it would be compressed, and slender ones buckle.
    for k in range(len(start.x)):
        mean[0, k] = start.v[k] if k < n else start.x[k]
        mean[1, k] = 0.0


@inner
def keep_means(n, h, last, s, mean):
    """Velocities of the middle of a step, their rate since the middle of the one before, and multipliers."""
    for k in range(len(s.x0)):
        if k < n:
            # The middles of both steps are (h + last) / 2 apart.
            mean[1, k] = 2.0 / (h + last) * (s.vm[k] - mean[0, k])
            mean[0, k] = s.vm[k]
        else:
            mean[0, k] = s.xm[k]


@inner
def keep_missed(n, start, s, slope):
    """What accelerations and multipliers of a start missed in its step."""
    for k in range(len(start.x)):
        if k < n:
            slope[0, k], slope[1, k] = s.a[k] - start.a[k], s.b[k] - start.a[k]
        else:
            slope[0, k], slope[1, k] = s.x0[k] - start.x[k], s.x1[k] - start.x[k]


@inner
def keep_lanes(n, h, last, means, arrived, pending, before, s, missed):
    """`keep_means` or `keep_missed` for the lanes that have arrived; those that try again forget what they missed."""
    zero = 0.0 * s.v0[len(s.x0) - 1]
    for i in range(len(s.x0)):
        if means and i < n:
            missed[1, i] = where(arrived, 2.0 / (h + last) * (s.vm[i] - missed[0, i]), missed[1, i])
            missed[0, i] = where(arrived, s.vm[i], missed[0, i])
        elif means:
            missed[0, i] = where(arrived, s.xm[i], missed[0, i])
        else:
            first, second = (s.a[i], s.b[i]) if i < n else (s.x0[i], s.x1[i])
            start = before.a[i] if i < n else before.x[i]
            missed[0, i] = where(arrived, first - start, where(pending, zero, missed[0, i]))
            missed[1, i] = where(arrived, second - start, where(pending, zero, missed[1, i]))
