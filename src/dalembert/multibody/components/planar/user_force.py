"""Forces that a function of the user's returns from the state of one or two markers.

The function gets the time and, for a and for b, position, velocity, angle and angular velocity (13 numbers); it returns
the force (fx, fy) and the torque on a.
"""

__all__ = ["UserForce"]

from dataclasses import dataclass

from dalembert.kernels.kernel import inlined
from dalembert.kernels.views import call_with, stack
from dalembert.multibody.components.laws.user_force_law import TIME, CalledForce
from dalembert.multibody.components.planar.load import Load
from dalembert.multibody.components.planar.markers import angle, position, spin, velocity
from dalembert.multibody.components.planar.pairs import pair_kind, push_pair, twist_pair
from dalembert.multibody.components.points import Side
from dalembert.multibody.kernels.callbacks import Sizes

_SIZES = Sizes(state=6, answer=3, words="three finite numbers (fx, fy, torque)")
GIVEN, ANSWER = _SIZES.given, _SIZES.answer


@inlined
def _fill(side, kind, k, x, v, sx, sy, phi, given):
    """State of a marker."""
    out = 1 + 6 * side
    given[out], given[out + 1] = position(kind, k, x, sx, sy)
    given[out + 2], given[out + 3] = velocity(kind, k, x, v, sx, sy)
    given[out + 4] = angle(kind, k, x, phi)
    given[out + 5] = spin(kind, k, x, v)


@inlined
def _ask(x, v, p, m, inputs, given, answer):
    """Call the function."""
    given[0] = inputs.signals[TIME, 0]
    _fill(0, m.a_kind, 0, x, v, p.a_x, p.a_y, p.a_angle, given)
    _fill(1, m.b_kind, 4, x, v, p.b_x, p.b_y, p.b_angle, given)
    call_with(inputs.callbacks[m.function], given, answer)


@inlined
def _residual(x, v, a, p, m, inputs, r):
    """The force with its sign turned on a, as it is on b."""
    given, answer = stack(x, GIVEN), stack(x, ANSWER)
    _ask(x, v, p, m, inputs, given, answer)
    push_pair(x, p, m, answer[0], answer[1], r)
    twist_pair(x, m, answer[2], r)


@inlined
def _energy(x, v, p, m, inputs):
    """No energy; the power of the force on both markers."""
    given, answer = stack(x, GIVEN), stack(x, ANSWER)
    _ask(x, v, p, m, inputs, given, answer)
    power = answer[0] * (given[3] - given[9]) + answer[1] * (given[4] - given[10]) + answer[2] * (given[6] - given[12])
    return 0.0 * given[0], 0.0 * given[0], power


USER_FORCE = pair_kind(
    "user_force", integers=("function",), residual=_residual, energy=_energy, dissipates=True, lanes=False
)


@dataclass(frozen=True)
class UserForce(CalledForce, Load):
    """A force and torque at a point, from a function of the user's, and their opposites on ``against``.

    Parameters
    ----------
    name : str
    at : Point
    function : callable
        ``function(t, at, against) -> (fx, fy, torque)`` in N and N m; ``at`` and ``against`` are arrays
        (x, y, vx, vy, angle, angular velocity), in the fixed axes. The angle of a rigid body counts whole turns; that
        of a node of a beam is within half a turn, so use its sine and cosine. Under ``numba.njit`` the function runs
        compiled; a plain Python function is called at every iteration, which is some hundred times slower.
    against : Point, optional
    """

    at: Side
    against: Side | None = None

    SIZES = _SIZES
    kind = USER_FORCE
