"""Compiled: torques of the joints of a tree as linear functions of mass, mass x centre and inertia of each frame.

Atkeson, An and Hollerbach (1986). In the axes of a frame, w is its angular velocity, b its angular acceleration, and a
the acceleration of its origin less gravity. A unit motion of a joint above turns the frame by t and moves its origin by
d. The torque of that joint is m d.a + h.(d x b + (d x w) x w + a x t) + t.J b + (t x w).J w.
"""

from dalembert.kernels.kernel import inlined, inner, kernel, vector_kernel
from dalembert.kernels.lanes import WIDTH as LANES
from dalembert.kernels.lanes import lane_vector
from dalembert.kernels.words import Complexes, Complexes2, Complexes3, Reals, Reals2, Reals3
from dalembert.multibody.components.spatial.vectors import at, cross, dot, minus, plus
from dalembert.multibody.trees.frame_motion import (
    ANGULAR,
    LINEAR,
    SHIFT,
    SPIN,
    move_frame,
    out_of,
    place_frame,
    put,
    start_base,
    within,
)  # fmt: skip
from dalembert.multibody.trees.frames import AXIS, WIDTH, ComplexFrames, Frames
from dalembert.multibody.trees.rows_in_lanes import gather_motion, scatter

TURNED, ORIGIN, DIRECTION, ROOM = 21, 30, 33, 36
"""Row of the workspace: that of the frame's motion up to its acceleration, then columns of the rotation to the base,
position and axis of the joint there."""


@inlined
def _place_in_base(frames, k, scratch, o, up):
    """Write rotation, position and axis of a frame in the base."""
    for i in range(0, 9, 3):
        put(scratch, o + TURNED + i, out_of(scratch, up + TURNED, at(scratch, o + i)))
    shift = out_of(scratch, up + TURNED, at(scratch, o + SHIFT))
    put(scratch, o + ORIGIN, plus(at(scratch, up + ORIGIN), shift))
    put(scratch, o + DIRECTION, out_of(scratch, o + TURNED, at(frames.numbers, k * WIDTH + AXIS)))


@inlined
def _put_columns(y, w, b, a, t, d):
    """Set the ten columns of a frame in the row of a joint that turns it by t and moves its origin by d."""
    y[0] = dot(d, a)
    put(y, 1, plus(plus(cross(d, b), cross(cross(d, w), w)), cross(a, t)))
    u = cross(t, w)
    for i in range(3):
        y[4 + i] = t[i] * b[i] + u[i] * w[i]
    y[7] = t[0] * b[1] + t[1] * b[0] + u[0] * w[1] + u[1] * w[0]
    y[8] = t[0] * b[2] + t[2] * b[0] + u[0] * w[2] + u[2] * w[0]
    y[9] = t[1] * b[2] + t[2] * b[1] + u[1] * w[2] + u[2] * w[1]


@inlined
def _start(gravity, scratch):
    start_base(gravity, scratch)
    for i in range(TURNED, ROOM):
        scratch[i] = 0.0
    scratch[TURNED] = scratch[TURNED + 4] = scratch[TURNED + 8] = 1.0


@inlined
def _move(frames, k, q, v, a, scratch):
    """Write position and motion of a frame, in its parent and in the base."""
    o, up = (k + 1) * ROOM, frames.parents[k] * ROOM
    place_frame(frames, k, q, scratch, o)
    move_frame(frames, k, v, a, scratch, o, up)
    _place_in_base(frames, k, scratch, o, up)


@inlined
def _columns_of(frames, k, j, scratch, y):
    """Set the ten columns of frame k in the row of joint j - 1."""
    o = (k + 1) * ROOM
    w, b, linear = at(scratch, o + SPIN), at(scratch, o + ANGULAR), at(scratch, o + LINEAR)
    axis = at(scratch, j * ROOM + DIRECTION)
    turn = within(scratch, o + TURNED, axis)
    if frames.turns[j - 1]:
        lever = minus(at(scratch, o + ORIGIN), at(scratch, j * ROOM + ORIGIN))
        _put_columns(y, w, b, linear, turn, within(scratch, o + TURNED, cross(axis, lever)))
    else:
        _put_columns(y, w, b, linear, (0.0 * turn[0], 0.0 * turn[0], 0.0 * turn[0]), turn)


@inner
def _fill(frames, gravity, q, v, a, scratch, columns):
    _start(gravity, scratch)
    for s in range(len(q)):
        for k in range(len(frames.parents)):
            _move(frames, k, q[s, k], v[s, k], a[s, k], scratch)
            j = k + 1
            while j > 0:
                _columns_of(frames, k, j, scratch, columns[s, j - 1, 10 * k : 10 * k + 10])
                j = frames.parents[j - 1]


@kernel
def fill_columns(
    frames: Frames, gravity: Reals, q: Reals2, v: Reals2, a: Reals2, scratch: Reals, columns: Reals3
) -> None:
    """Fill the first ten columns a frame (samples, frames, columns), zero before; (frames + 1) x ROOM of workspace."""
    _fill(frames, gravity, q, v, a, scratch, columns)


@kernel
def fill_complex_columns(
    frames: ComplexFrames,
    gravity: Complexes,
    q: Complexes2,
    v: Complexes2,
    a: Complexes2,
    scratch: Complexes,
    columns: Complexes3,
) -> None:
    """The same in complex numbers."""
    _fill(frames, gravity, q, v, a, scratch, columns)


@vector_kernel
def fill_columns_in_lanes(
    frames: Frames, gravity: Reals, q: Reals2, v: Reals2, a: Reals2, rows: Reals2, columns: Reals3
) -> None:
    """The same for eight samples at once; the workspace has (frames + 1) x ROOM + 3 frames + 10 rows of eight."""
    count, work = len(frames.parents), lane_vector(rows)
    end = (count + 1) * ROOM
    y = work[end + 3 * count :]
    _start(gravity, work)
    # Eight samples at a time; the last row fills the lanes that are left.
    for s in range(0, len(q), LANES):
        positions, rates, accelerations = gather_motion(q, v, a, s, work, end)
        for k in range(count):
            _move(frames, k, positions[k], rates[k], accelerations[k], work)
            j = k + 1
            while j > 0:
                _columns_of(frames, k, j, work, y)
                # Into the rows of the samples at once: the answer is much larger than the nearest cache.
                scatter(y, s, columns[:, j - 1, 10 * k : 10 * k + 10])
                j = frames.parents[j - 1]
