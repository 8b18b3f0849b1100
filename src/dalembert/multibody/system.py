"""A mechanism: bodies, joints, loads and gravity."""

from collections.abc import Sequence
from typing import Any, TypeVar

from dalembert.arguments import is_number, names_of
from dalembert.errors import InputError, ModelError, require_known, shown
from dalembert.findings import Finding
from dalembert.multibody.components.fields import Number
from dalembert.multibody.components.planar.body import Body
from dalembert.multibody.components.planar.joint import Joint
from dalembert.multibody.components.planar.load import Load
from dalembert.multibody.components.points import Ground

PLACED, EQUILIBRIUM = STARTS = "placed", "equilibrium"
"""Where a motion begins: as the bodies are placed, or at rest under gravity and the loads."""

Component = TypeVar("Component", bound=Body | Joint | Load)


class System:
    """A planar mechanism, built by adding components.

    Parameters
    ----------
    gravity : (float, float)
        m/s^2.
    driving : sequence of str
        Placement coordinates that are kept as given while a closed loop is assembled, ``"<body>.angle"``,
        ``"<body>.x"`` or ``"<body>.y"`` (of its placed point); the other bodies are moved, without deformation, until
        the joints close. Velocities that bodies state are kept in any case.
    start : {"placed", "equilibrium"}
        Where a motion begins: as the bodies are placed, or at rest in the static equilibrium nearest to that, under
        gravity and the loads at time 0. The equilibrium follows the parameters, with exact derivatives.

    Examples
    --------
    >>> from dalembert.multibody import RevoluteJoint, RigidBar, System
    >>> system = System()
    >>> rod = system.add(RigidBar("rod", length=1.0, mass=1.0))
    >>> joint = system.add(RevoluteJoint("pin", system.ground, rod.start))
    >>> [component.name for component in (*system.bodies, *system.joints)]
    ['rod', 'pin']
    """

    def __init__(
        self, gravity: tuple[Number, Number] = (0.0, -9.81), driving: Sequence[str] = (), start: str = PLACED
    ) -> None:
        try:
            usable = len(gravity) == 2 and all(map(is_number, gravity))
        except TypeError:
            usable = False
        if not usable:
            raise InputError(
                f"System: gravity is {shown(gravity)}; expected two finite numbers in m/s^2, along x and y, such as "
                "(0.0, -9.81)"
            )
        self.gravity = gravity
        self.driving = names_of(driving, "System", "driving")
        require_known("start", str(start), STARTS, "System")
        self.start = start
        self.ground = Ground()
        self.bodies: list[Body] = []
        self.joints: list[Joint] = []
        self.loads: list[Load] = []
        self._names: set[str] = set()

    def add(self, component: Component) -> Component:
        """Add a body, a joint or a load, and hand it back."""
        kinds: list[tuple[type, list[Any]]] = [(Body, self.bodies), (Joint, self.joints), (Load, self.loads)]
        for kind, members in kinds:
            if isinstance(component, kind):
                if component.name in self._names or component.name in ("ground", "system"):
                    raise ModelError(
                        f"{type(component).__name__} {component.name!r}: the name is taken; give each component its own"
                    )
                self._names.add(component.name)
                members.append(component)
                return component
        raise InputError(f"{component!r} was added to a system; expected a body, a joint or a load")

    @property
    def findings(self) -> tuple[Finding, ...]:
        """What there is to say about the choice of bodies, such as elements that lock."""
        return tuple(finding for body in self.bodies for finding in body.findings)

    def body(self, name: str) -> Body:
        """The body of this name."""
        bodies = {body.name: body for body in self.bodies}
        require_known("body", name, bodies)
        return bodies[name]
