"""Compiled: position and motion of the frames of a tree, each from that of its parent, in its own axes.

Row k + 1 of the workspace is that of frame k, row 0 that of the base.
"""

from dalembert.kernels.kernel import inlined
from dalembert.multibody.components.spatial.vectors import at, combined, cross, dot, plus, times
from dalembert.multibody.kernels.elementary import sin_cos
from dalembert.multibody.trees.frames import AXIS, CONSTANT, COSINE, PLACE, SINE, SLIDE, WIDTH

SHIFT, SPIN, ANGULAR, LINEAR, FORCE, TORQUE, ROOM = 9, 12, 15, 18, 21, 24, 27
"""Row of the workspace: columns of the rotation to the parent, position there; in the axes of the frame angular
velocity and acceleration, acceleration of the origin less gravity, force and torque about the origin."""


@inlined
def put(x, k, a):
    """Set entries k, k + 1 and k + 2 of an array."""
    x[k], x[k + 1], x[k + 2] = a


@inlined
def within(x, k, a):
    """R^T a, with the columns of R from entry k of an array."""
    return dot(at(x, k), a), dot(at(x, k + 3), a), dot(at(x, k + 6), a)


@inlined
def out_of(x, k, a):
    """R a, with the columns of R from entry k of an array."""
    return combined(a, at(x, k), at(x, k + 3), at(x, k + 6))


@inlined
def inertia_times(x, k, a):
    """J a, with xx, yy, zz, xy, xz and yz of J from entry k of an array."""
    return (
        x[k] * a[0] + x[k + 3] * a[1] + x[k + 4] * a[2],
        x[k + 3] * a[0] + x[k + 1] * a[1] + x[k + 5] * a[2],
        x[k + 4] * a[0] + x[k + 5] * a[1] + x[k + 2] * a[2],
    )


@inlined
def place_frame(frames, k, position, scratch, o):
    """Write rotation and position of a frame in its parent's, from entry o of the workspace."""
    x, b = frames.numbers, k * WIDTH
    if frames.turns[k]:
        s, c = sin_cos(position)
        for i in range(9):
            scratch[o + i] = x[b + CONSTANT + i] + c * x[b + COSINE + i] + s * x[b + SINE + i]
        put(scratch, o + SHIFT, at(x, b + PLACE))
    else:
        for i in range(9):
            scratch[o + i] = x[b + CONSTANT + i]
        put(scratch, o + SHIFT, plus(at(x, b + PLACE), times(position, at(x, b + SLIDE))))


@inlined
def start_base(gravity, scratch):
    """The base does not move; its acceleration less gravity is -g."""
    for i in range(3):
        scratch[SPIN + i] = scratch[ANGULAR + i] = 0.0
        scratch[LINEAR + i] = -gravity[i]


@inlined
def move_frame(frames, k, v, a, scratch, o, up):
    """Write the motion of a frame, from that of its parent at entry ``up``."""
    shift, w, alpha = at(scratch, o + SHIFT), at(scratch, up + SPIN), at(scratch, up + ANGULAR)
    linear = plus(at(scratch, up + LINEAR), plus(cross(alpha, shift), cross(w, cross(w, shift))))
    w, alpha, linear = within(scratch, o, w), within(scratch, o, alpha), within(scratch, o, linear)
    u = at(frames.numbers, k * WIDTH + AXIS)
    if frames.turns[k]:
        alpha = plus(alpha, plus(times(a, u), times(v, cross(w, u))))
        w = plus(w, times(v, u))
    else:
        linear = plus(linear, plus(times(a, u), times(2.0 * v, cross(w, u))))
    put(scratch, o + SPIN, w)
    put(scratch, o + ANGULAR, alpha)
    put(scratch, o + LINEAR, linear)
