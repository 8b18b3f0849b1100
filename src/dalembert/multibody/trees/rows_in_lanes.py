"""Samples of a motion in lanes: eight rows of arrays side by side, and back."""

from dalembert.kernels.kernel import inner
from dalembert.kernels.lanes import WIDTH, entry, with_entry


@inner
def gather(array, first, columns):
    """Fill a vector of lanes with the rows from ``first`` on of an array (samples, columns); the last row repeats."""
    # Numbers are gathered entry by entry, which costs less than another layout of the arrays.
    last = len(array) - 1
    for k in range(array.shape[1]):
        column = columns[k]
        for lane in range(WIDTH):
            column = with_entry(column, lane, array[min(first + lane, last), k])
        columns[k] = column


@inner
def scatter(columns, first, array):
    """Write a vector of lanes to the rows from ``first`` on of an array (samples, columns)."""
    for lane in range(min(WIDTH, len(array) - first)):
        for k in range(array.shape[1]):
            array[first + lane, k] = entry(columns[k], lane)


@inner
def gather_motion(q, v, a, first, work, end):
    """Gather positions, velocities and accelerations behind the entries of a workspace; return the three vectors."""
    count = q.shape[1]
    positions, rates = work[end : end + count], work[end + count : end + 2 * count]
    accelerations = work[end + 2 * count : end + 3 * count]
    gather(q, first, positions)
    gather(v, first, rates)
    gather(a, first, accelerations)
    return positions, rates, accelerations
