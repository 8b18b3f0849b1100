"""The clamp of a cable: a point of its line coincides with that of a marker and runs along the marker's first axis.

Local coordinates: those of the marker, as side a of a pair, then position r and slope r' of the cable's node.
"""

from dalembert.kernels.kernel import inlined
from dalembert.kernels.views import stack
from dalembert.multibody.components.spatial.conditions import MEETS, Condition, constraint_of, forces_of
from dalembert.multibody.components.spatial.directors import POSE
from dalembert.multibody.components.spatial.spatial_cable_element import NODE
from dalembert.multibody.components.spatial.spatial_joint import REACTIONS, observe_reactions
from dalembert.multibody.components.spatial.spatial_markers import SLOTS
from dalembert.multibody.components.spatial.spatial_pairs import INTEGERS, LENGTHS, NUMBERS, E, e1, e2, e3, push_a_axis
from dalembert.multibody.components.spatial.vectors import add_at, at, cross, dot, times
from dalembert.multibody.kernels.charts import flat
from dalembert.multibody.kernels.kind import Kind

COORDINATES, SLOPE, COUNT = SLOTS + NODE, SLOTS + 3, 5
WIDTH = COORDINATES + COUNT


def _across(i: int) -> Condition:
    """The line is perpendicular to axis i of a: e_i . r' = 0."""
    e, push_e = E[i - 1], push_a_axis(i)

    @inlined
    def residual(x, p, m, row, g):
        g[row] = dot(e(x, p, m), at(x, SLOPE))

    @inlined
    def forces(x, p, m, k, r):
        push_e(p, m, times(x[k], at(x, SLOPE)), r)
        add_at(r, SLOPE, times(x[k], e(x, p, m)))

    return Condition(1, residual, forces)


_CONDITIONS = (MEETS, _across(2), _across(3))
_forces = forces_of(_CONDITIONS, COORDINATES)


@inlined
def _observe(x, v, a, p, m, inputs, out):
    """Force and torque on side b of the joint: the cable, or the marker where the sides are swapped."""
    r = stack(x, WIDTH)
    for i in range(WIDTH):
        r[i] = 0.0
    _forces(x, p, m, r)
    observe_reactions(x, p, m, r, out)
    # The force on the slope turns the end of the line: r' x f, which a point mass would not have.
    moment = times(-1.0, cross(at(x, SLOPE), at(r, SLOPE)))
    add_at(out, 3, moment)
    add_at(out, 9, (dot(e1(x, p, m), moment), dot(e2(x, p, m), moment), dot(e3(x, p, m), moment)))
    if m.swapped:
        for i in range(12):
            out[i] = -out[i]


CLAMP = Kind(
    "cable_clamp",
    coordinates=COORDINATES,
    multipliers=COUNT,
    numbers=NUMBERS,
    integers=(*INTEGERS, "swapped"),
    constraint=constraint_of(_CONDITIONS),
    forces=_forces,
    outputs=REACTIONS,
    observe=_observe,
    charts=(*POSE, flat(NODE)),
    lengths=LENGTHS,
    holds=True,
    home=__name__,
)
