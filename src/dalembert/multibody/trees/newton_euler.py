"""Compiled: torques of the joints of a tree by the recursive Newton-Euler algorithm.

Luh, Walker and Paul (1980); Featherstone, Rigid Body Dynamics Algorithms (2008), section 5.3.
"""

from dalembert.kernels.kernel import inlined, inner, kernel
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


@inlined
def _load_frame(frames, k, scratch, o):
    """Write the force and the torque that move what hangs on a frame: f = m a + alpha x h + omega x (omega x h)."""
    x, b = frames.numbers, k * WIDTH + INERTIA
    w, alpha, linear, h = at(scratch, o + SPIN), at(scratch, o + ANGULAR), at(scratch, o + LINEAR), at(x, b + 1)
    put(scratch, o + FORCE, plus(times(x[b], linear), plus(cross(alpha, h), cross(w, cross(w, h)))))
    spin = cross(w, inertia_times(x, b + 4, w))
    put(scratch, o + TORQUE, plus(plus(inertia_times(x, b + 4, alpha), spin), cross(h, linear)))


@inner
def _fill(frames, gravity, q, v, a, scratch, torques):
    count = len(frames.parents)
    start_base(gravity, scratch)
    for s in range(len(q)):
        for k in range(count):
            o = (k + 1) * ROOM
            place_frame(frames, k, q[s, k], scratch, o)
            move_frame(frames, k, v[s, k], a[s, k], scratch, o, frames.parents[k] * ROOM)
            _load_frame(frames, k, scratch, o)
        for k in range(count - 1, -1, -1):
            o, up = (k + 1) * ROOM, frames.parents[k] * ROOM
            force, torque = at(scratch, o + FORCE), at(scratch, o + TORQUE)
            torques[s, k] = dot(at(frames.numbers, k * WIDTH + AXIS), torque if frames.turns[k] else force)
            if up > 0:
                force, torque = out_of(scratch, o, force), out_of(scratch, o, torque)
                put(scratch, up + FORCE, plus(at(scratch, up + FORCE), force))
                moment = plus(torque, cross(at(scratch, o + SHIFT), force))
                put(scratch, up + TORQUE, plus(at(scratch, up + TORQUE), moment))


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
