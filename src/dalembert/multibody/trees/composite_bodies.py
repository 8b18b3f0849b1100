"""Compiled: mass matrices of trees by the composite-rigid-body algorithm.

Walker and Orin (1982); Featherstone, Rigid Body Dynamics Algorithms (2008), section 6.2.
"""

from dalembert.kernels.kernel import inlined, inner, kernel, vector_kernel
from dalembert.kernels.lanes import WIDTH as LANES
from dalembert.kernels.lanes import lane_vector
from dalembert.kernels.words import Complexes, Complexes2, Reals, Reals2
from dalembert.multibody.components.spatial.vectors import at, combined, cross, dot, plus, times
from dalembert.multibody.trees.frame_motion import SHIFT, inertia_times, out_of, place_frame
from dalembert.multibody.trees.frames import AXIS, INERTIA, WIDTH, ComplexFrames, Frames
from dalembert.multibody.trees.rows_in_lanes import gather, scatter

WHOLE, ROOM = 12, 22
"""Row of the workspace: rotation and position in the parent; mass, mass x centre and inertia about the origin of all
that hangs on a frame."""


@inlined
def _add_to_parent(scratch, o, up):
    """Add mass, mass x centre and inertia of a frame to those of its parent: s = p + R s' in the integrals."""
    b, to = o + WHOLE, up + WHOLE
    m, h, p = scratch[b], out_of(scratch, o, at(scratch, b + 1)), at(scratch, o + SHIFT)
    c1, c2, c3 = at(scratch, o), at(scratch, o + 3), at(scratch, o + 6)
    xx, yy, zz, xy, xz, yz = (
        scratch[b + 4],
        scratch[b + 5],
        scratch[b + 6],
        scratch[b + 7],
        scratch[b + 8],
        scratch[b + 9],
    )
    b1 = combined((xx, xy, xz), c1, c2, c3)
    b2 = combined((xy, yy, yz), c1, c2, c3)
    b3 = combined((xz, yz, zz), c1, c2, c3)
    diagonal = 2.0 * dot(p, h) + m * dot(p, p)
    scratch[to] += m
    for i in range(3):
        scratch[to + 1 + i] += h[i] + m * p[i]
        scratch[to + 4 + i] += b1[i] * c1[i] + b2[i] * c2[i] + b3[i] * c3[i] + diagonal - (2.0 * h[i] + m * p[i]) * p[i]
    for i in range(3):  # xy, xz, yz
        j, k = i // 2, 1 + (i > 0)
        scratch[to + 7 + i] += (
            b1[j] * c1[k] + b2[j] * c2[k] + b3[j] * c3[k] - p[j] * h[k] - p[k] * h[j] - m * p[j] * p[k]
        )


@inner
def _fill_sample(frames, q, scratch, masses):
    """Fill the mass matrix (frames x frames,) of one sample, or of eight in lanes."""
    count, x = len(frames.parents), frames.numbers
    for k in range(count):
        o = (k + 1) * ROOM
        place_frame(frames, k, q[k], scratch, o)
        for i in range(10):
            scratch[o + WHOLE + i] = x[k * WIDTH + INERTIA + i]
    for k in range(count - 1, -1, -1):
        o, up = (k + 1) * ROOM, frames.parents[k]
        u, h = at(x, k * WIDTH + AXIS), at(scratch, o + WHOLE + 1)
        if frames.turns[k]:
            force, torque = cross(u, h), inertia_times(scratch, o + WHOLE + 4, u)
        else:
            force, torque = times(scratch[o + WHOLE], u), cross(h, u)
        masses[k * count + k] = dot(u, torque if frames.turns[k] else force)
        if up > 0:
            _add_to_parent(scratch, o, up * ROOM)
        while up > 0:  # force and torque of a unit acceleration of joint k, in the frames above it
            force = out_of(scratch, o, force)
            torque = plus(out_of(scratch, o, torque), cross(at(scratch, o + SHIFT), force))
            j, o = up - 1, up * ROOM
            across = dot(at(x, j * WIDTH + AXIS), torque if frames.turns[j] else force)
            masses[j * count + k] = masses[k * count + j] = across
            up = frames.parents[j]


@inner
def _fill(frames, q, scratch, masses):
    for s in range(len(q)):
        _fill_sample(frames, q[s], scratch, masses[s])


@kernel
def fill_masses(frames: Frames, q: Reals2, scratch: Reals, masses: Reals2) -> None:
    """Fill the mass matrices (samples, frames x frames), zero before; the workspace has (frames + 1) x ROOM entries."""
    _fill(frames, q, scratch, masses)


@kernel
def fill_complex_masses(frames: ComplexFrames, q: Complexes2, scratch: Complexes, masses: Complexes2) -> None:
    """The same in complex numbers."""
    _fill(frames, q, scratch, masses)


@vector_kernel
def fill_masses_in_lanes(frames: Frames, q: Reals2, rows: Reals2, masses: Reals2) -> None:
    """The same for eight samples at once; the workspace has rows of eight numbers, zero before."""
    count, work = len(frames.parents), lane_vector(rows)
    end = (count + 1) * ROOM
    positions, filled = work[end : end + count], work[end + count :]
    # Eight samples at a time; the last row fills the lanes that are left.
    for s in range(0, len(q), LANES):
        gather(q, s, positions)
        _fill_sample(frames, positions, work, filled)
        scatter(filled, s, masses)
