"""Compiled: torques of the joints of a tree by the recursive Newton-Euler algorithm.

Luh, Walker and Paul (1980); Featherstone, Rigid Body Dynamics Algorithms (2008), section 5.3.
"""

from dalembert.kernels.kernel import inlined, inner, kernel, vector_kernel
from dalembert.kernels.lanes import WIDTH as LANES
from dalembert.kernels.lanes import lane_vector
from dalembert.kernels.words import Complexes, Complexes2, Reals, Reals2
from dalembert.multibody.components.spatial.vectors import at, cross, dot, plus, times
from dalembert.multibody.trees.frame_motion import (
    ANGULAR,
    FORCE,
    LINEAR,
    ROOM,
    SHIFT,
    SPIN,
    TORQUE,
    inertia_times,
    move_frame,
    out_of,
    place_frame,
    put,
    start_base,
)  # fmt: skip
from dalembert.multibody.trees.frames import AXIS, INERTIA, WIDTH, ComplexFrames, Frames
from dalembert.multibody.trees.rows_in_lanes import gather_motion, scatter


@inlined
def _load_frame(frames, k, scratch, o):
    """Write the force and the torque that move what hangs on a frame: f = m a + alpha x h + omega x (omega x h)."""
    x, b = frames.numbers, k * WIDTH + INERTIA
    w, alpha, linear, h = at(scratch, o + SPIN), at(scratch, o + ANGULAR), at(scratch, o + LINEAR), at(x, b + 1)
    put(scratch, o + FORCE, plus(times(x[b], linear), plus(cross(alpha, h), cross(w, cross(w, h)))))
    spin = cross(w, inertia_times(x, b + 4, w))
    put(scratch, o + TORQUE, plus(plus(inertia_times(x, b + 4, alpha), spin), cross(h, linear)))


@inner
def _fill_sample(frames, q, v, a, scratch, torques):
    """Fill the torques of one sample, or of eight in lanes."""
    count = len(frames.parents)
    for k in range(count):
        o = (k + 1) * ROOM
        place_frame(frames, k, q[k], scratch, o)
        move_frame(frames, k, v[k], a[k], scratch, o, frames.parents[k] * ROOM)
        _load_frame(frames, k, scratch, o)
    for k in range(count - 1, -1, -1):
        o, up = (k + 1) * ROOM, frames.parents[k] * ROOM
        force, torque = at(scratch, o + FORCE), at(scratch, o + TORQUE)
        torques[k] = dot(at(frames.numbers, k * WIDTH + AXIS), torque if frames.turns[k] else force)
        if up > 0:
            force, torque = out_of(scratch, o, force), out_of(scratch, o, torque)
            put(scratch, up + FORCE, plus(at(scratch, up + FORCE), force))
            moment = plus(torque, cross(at(scratch, o + SHIFT), force))
            put(scratch, up + TORQUE, plus(at(scratch, up + TORQUE), moment))


@inner
def _fill(frames, gravity, q, v, a, scratch, torques):
    start_base(gravity, scratch)
    for s in range(len(q)):
        _fill_sample(frames, q[s], v[s], a[s], scratch, torques[s])


@kernel
def fill_torques(
    frames: Frames, gravity: Reals, q: Reals2, v: Reals2, a: Reals2, scratch: Reals, torques: Reals2
) -> None:
    """Fill the torques (samples, frames); q, v and a have the same shape, the workspace (frames + 1) x ROOM entries."""
    _fill(frames, gravity, q, v, a, scratch, torques)


@kernel
def fill_complex_torques(
    frames: ComplexFrames,
    gravity: Complexes,
    q: Complexes2,
    v: Complexes2,
    a: Complexes2,
    scratch: Complexes,
    torques: Complexes2,
) -> None:
    """The same in complex numbers."""
    _fill(frames, gravity, q, v, a, scratch, torques)


@vector_kernel
def fill_torques_in_lanes(
    frames: Frames, gravity: Reals, q: Reals2, v: Reals2, a: Reals2, rows: Reals2, torques: Reals2
) -> None:
    """The same for eight samples at once; the workspace has rows of eight numbers, (frames + 1) x ROOM + 4 frames."""
    count, work = len(frames.parents), lane_vector(rows)
    end = (count + 1) * ROOM
    moments = work[end + 3 * count :]
    start_base(gravity, work)
    # Eight samples at a time; the last row fills the lanes that are left.
    for s in range(0, len(q), LANES):
        positions, rates, accelerations = gather_motion(q, v, a, s, work, end)
        _fill_sample(frames, positions, rates, accelerations, work, moments)
        scatter(moments, s, torques)
