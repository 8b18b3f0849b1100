"""Forces at a point."""

__all__ = ["Force"]

from dataclasses import dataclass

from dalembert.kernels.kernel import inlined
from dalembert.multibody.components.fields import number
from dalembert.multibody.components.planar.load import Load
from dalembert.multibody.components.planar.markers import direction, push, velocity
from dalembert.multibody.components.points import Side, require_direction
from dalembert.multibody.components.rows import Lowering
from dalembert.multibody.components.signals import Course
from dalembert.multibody.kernels.kind import Kind


@inlined
def _force(x, p, m, inputs):
    """Force in the fixed axes."""
    fx, fy = inputs.signals[m.force_x, 0], inputs.signals[m.force_y, 0]
    if m.follower == 1:
        c, s = direction(m.kind, 0, x, p.angle)
        return c * fx - s * fy, s * fx + c * fy
    return fx, fy


@inlined
def _residual(x, v, a, p, m, inputs, r):
    """The force with its sign turned: it stands on the left."""
    fx, fy = _force(x, p, m, inputs)
    push(m.kind, 0, x, p.x, p.y, -fx, -fy, r)


@inlined
def _energy(x, v, p, m, inputs):
    fx, fy = _force(x, p, m, inputs)
    ux, uy = velocity(m.kind, 0, x, v, p.x, p.y)
    return 0.0 * fx, 0.0 * fx, fx * ux + fy * uy


FORCE = Kind(
    "force",
    coordinates=4,
    numbers=("x", "y", "angle"),
    integers=("kind", "follower", "force_x", "force_y"),
    residual=_residual,
    energy=_energy,
    loads=True,
)


@dataclass(frozen=True)
class Force(Load):
    """A force at a point.

    Parameters
    ----------
    name : str
    at : Point
    x, y : float or Signal
        Components along the fixed axes, or along those of the point for a follower force, N.
    follower : bool
        Whether the force turns with the point.
    """

    at: Side
    x: Course = number("N", 0.0)
    y: Course = number("N", 0.0)
    follower: bool = False

    kind = FORCE

    def lower(self, lowering: Lowering) -> None:
        if self.follower:
            require_direction(f"follower force {self.name!r}", "a force that does not follow, or a rigid body", self.at)
        pair = lowering.pair(self.at, None, self.name)
        integers = [pair.integers[0], int(self.follower), lowering.signal(self.x), lowering.signal(self.y)]
        lowering.add(FORCE, pair.slots[:4], pair.data[:3], integers)
