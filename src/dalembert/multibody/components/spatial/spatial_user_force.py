"""Forces in space that a function of the user's returns from the state of one or two markers.

The function gets the time and, for a and for b, position, velocity, rotation matrix and angular velocity (37 numbers);
it returns the force and the torque on a.
"""

__all__ = ["UserForce"]

from dataclasses import dataclass

from dalembert.kernels.kernel import inlined
from dalembert.kernels.views import call_with, stack
from dalembert.multibody.components.laws.user_force_law import TIME, CalledForce
from dalembert.multibody.components.spatial.ground_points import Side
from dalembert.multibody.components.spatial.kinds import pair_kind
from dalembert.multibody.components.spatial.spatial_load import Load
from dalembert.multibody.components.spatial.spatial_markers import SLOTS, position, position_rate, spin
from dalembert.multibody.components.spatial.spatial_pairs import (
    a_point,
    b_point,
    e1,
    e2,
    e3,
    f1,
    f2,
    f3,
    push_pair,
    relative_spin,
    separation_rate,
    twist_pair,
)
from dalembert.multibody.components.spatial.vectors import at, dot
from dalembert.multibody.kernels.callbacks import Sizes

_SIZES = Sizes(state=18, answer=6, words="six finite numbers (fx, fy, fz, tx, ty, tz)")
_GIVEN, _ANSWER = _SIZES.given, _SIZES.answer


@inlined
def _fill(out, place, velocity, first, second, third, turning, given):
    """State of a marker, its axes as the columns of a matrix."""
    for i in range(3):
        given[out + i], given[out + 3 + i], given[out + 15 + i] = place[i], velocity[i], turning[i]
        given[out + 6 + 3 * i], given[out + 7 + 3 * i], given[out + 8 + 3 * i] = first[i], second[i], third[i]


@inlined
def _ask(x, v, p, m, inputs, given, answer):
    """Call the function."""
    given[0] = inputs.signals[TIME, 0]
    s, u = position(m.a_kind, 0, x, a_point(p)), position_rate(m.a_kind, 0, v, a_point(p))
    _fill(1, s, u, e1(x, p, m), e2(x, p, m), e3(x, p, m), spin(m.a_kind, 0, x, v), given)
    s, u = position(m.b_kind, SLOTS, x, b_point(p)), position_rate(m.b_kind, SLOTS, v, b_point(p))
    _fill(19, s, u, f1(x, p, m), f2(x, p, m), f3(x, p, m), spin(m.b_kind, SLOTS, x, v), given)
    call_with(inputs.callbacks[m.function], given, answer)


@inlined
def _residual(x, v, a, p, m, inputs, r):
    """The force with its sign turned on a, as it is on b."""
    given, answer = stack(x, _GIVEN), stack(x, _ANSWER)
    _ask(x, v, p, m, inputs, given, answer)
    push_pair(p, m, at(answer, 0), r)
    twist_pair(x, m, at(answer, 3), r)


@inlined
def _energy(x, v, p, m, inputs):
    """No energy; the power of the force on both markers."""
    given, answer = stack(x, _GIVEN), stack(x, _ANSWER)
    _ask(x, v, p, m, inputs, given, answer)
    power = dot(at(answer, 0), separation_rate(v, p, m)) + dot(at(answer, 3), relative_spin(x, v, m))
    return 0.0 * power, 0.0 * power, -power


USER_FORCE = pair_kind(
    "user_force_in_space",
    __name__,
    integers=("function",),
    residual=_residual,
    energy=_energy,
    dissipates=True,
    lanes=False,
)


@dataclass(frozen=True)
class UserForce(CalledForce, Load):
    """A force and a torque at a point, from a function of the user's, and their opposites on ``against``.

    Parameters
    ----------
    name : str
    at : Point
    function : callable
        ``function(t, at, against) -> (fx, fy, fz, tx, ty, tz)`` in N and N m, in the fixed axes; ``at`` and ``against``
        are arrays (18,): position [0:3], velocity [3:6], rotation matrix of the marker row by row [6:15], angular
        velocity [15:18], in the fixed axes. Under ``numba.njit`` it runs compiled; a plain Python function is called at
        every iteration, which is some hundred times slower.
    against : Point, optional
        Without it, ``against`` holds the position of ``at`` at the start and the fixed axes.

    Examples
    --------
    Air that resists with 0.3 N s/m makes a body of 1.5 kg fall at 49.05 m/s in the end:

    >>> from dalembert.multibody import simulate
    >>> from dalembert.multibody.spatial import Inertia, RigidBody, SpatialSystem
    >>> def air(t, at, against):
    ...     return -0.3 * at[3], -0.3 * at[4], -0.3 * at[5], 0.0, 0.0, 0.0
    >>> system = SpatialSystem()
    >>> ball = system.add(RigidBody("ball", Inertia.sphere(mass=1.5, radius=0.1)))
    >>> _ = system.add(UserForce("air", ball.point("centre"), air))
    >>> simulate(system, end=60.0).channels(["ball.centre.vz"])[-1].round(2)
    array([-49.05])
    """

    at: Side
    against: Side | None = None

    SIZES = _SIZES
    kind = USER_FORCE
