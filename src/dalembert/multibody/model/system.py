"""A mechanism: bodies, joints, loads and gravity."""

from collections.abc import Mapping, Sequence
from typing import Any, ClassVar, TypeVar

from dalembert.argument_readers import names_of
from dalembert.arguments import is_number
from dalembert.errors import InputError, ModelError, require_known, shown
from dalembert.findings import Finding
from dalembert.multibody.components.base_body import BaseBody
from dalembert.multibody.components.base_joint import BaseJoint
from dalembert.multibody.components.base_load import BaseLoad
from dalembert.multibody.components.fields import Number
from dalembert.multibody.components.planar.body import Body
from dalembert.multibody.components.planar.joint import Joint
from dalembert.multibody.components.planar.load import Load
from dalembert.multibody.components.points import Ground
from dalembert.multibody.model.stated_state import NONE, JointStates, joint_values
from dalembert.notebook_display import Displayed

PLACED, EQUILIBRIUM = STARTS = "placed", "equilibrium"
"""Where a motion begins: as the bodies are placed, or at rest under gravity and the loads."""

Component = TypeVar("Component", bound=BaseBody | BaseJoint | BaseLoad)


class BaseSystem(Displayed):
    """Base of the mechanisms in the plane and in space, which are built by adding components. ``gravity``: m/s^2;
    ``driving``: initial coordinates that assembly keeps; ``start`` of a motion: ``"placed"`` or ``"equilibrium"``.
    """

    IN_WORDS = "System"
    KINDS: ClassVar[tuple[type, type, type]]
    """Base classes of its bodies, joints and loads."""
    SPACE: ClassVar[str]
    """Where its components act, for messages."""
    AXES: ClassVar[str]
    LOWERING: ClassVar[str]
    """Class that makes its arrays; its module is imported when it is first used."""

    bodies: list[Any]
    joints: list[Any]
    loads: list[Any]

    def __init__(self, gravity: Sequence[Number], driving: Sequence[str], start: str) -> None:
        self.gravity: Any = _checked_gravity(gravity, type(self).__name__, self.AXES)
        self.driving = names_of(driving, type(self).__name__, "driving")
        require_known("start", str(start), STARTS, type(self).__name__)
        self.start = start
        self.bodies, self.joints, self.loads = [], [], []
        self._names: set[str] = set()
        self.stated = NONE

    @property
    def ground_surface(self) -> Any:
        """Surface of what the ground looks like, in the fixed axes; None for nothing."""
        return None

    def add(self, component: Component) -> Component:
        """Add a body, a joint or a load, and hand it back."""
        for kind, members in zip(self.KINDS, (self.bodies, self.joints, self.loads), strict=True):
            if isinstance(component, kind):
                if component.name in self._names or component.name in ("ground", "system"):
                    raise ModelError(
                        f"{type(component).__name__} {component.name!r}: the name is taken; give each component its own"
                    )
                self._names.add(component.name)
                members.append(component)
                return component
        if isinstance(component, BaseBody | BaseJoint | BaseLoad):
            raise InputError(
                f"{type(component).__name__} {component.name!r} is not a component {self.SPACE}, as a "
                f"{type(self).__name__} needs. Planar components belong to a System, those of dalembert.multibody."
                "spatial to a SpatialSystem"
            )
        raise InputError(f"{component!r} was added to a system; expected a body, a joint or a load")

    def pose(self, coordinates: Mapping[str, Number] | None = None, rates: Mapping[str, Number] | None = None) -> None:
        """State where and how fast joints begin: assembly moves the bodies until the joints have these coordinates.

        Joints that close no loop and are not stated keep the coordinates that they have as bodies are placed, and are
        at rest if rates are stated, unless bodies state velocities. In closed chains state as many coordinates as the
        mechanism has freedoms; the bodies move as little as possible. Numbers may depend on parameters.

        Parameters
        ----------
        coordinates, rates : mapping of str to float, optional
            By joint: angles in rad and displacements in m, as the joints' channels are, and their rates. Write
            ``"bearing.angle"`` for a joint that has several. The class of each joint lists its coordinates.

        Examples
        --------
        >>> from dalembert.multibody import simulate
        >>> from dalembert.multibody.spatial import Inertia, RevoluteJoint, RigidBody, SpatialSystem
        >>> system, side = SpatialSystem(), None
        >>> for name in ("upper", "lower"):
        ...     rod = Inertia.cylinder(mass=1.0, radius=0.01, length=0.5).moved((0.0, 0.0, -0.25))
        ...     body = RigidBody(name, rod, side or (0.0, 0.0, 0.0), points={"end": (0.0, 0.0, -0.5)})
        ...     sides = side or system.ground, system.add(body).point("origin")
        ...     _ = system.add(RevoluteJoint(f"{name} pin", *sides, axis=(0.0, 1.0, 0.0)))
        ...     side = body.point("end")
        >>> system.pose({"upper pin": 0.3, "lower pin": -1.0}, rates={"lower pin": 2.0})
        >>> channels = ["upper pin.angle", "lower pin.angle", "lower pin.rate"]
        >>> simulate(system, end=0.1).channels(channels)[0].round(9).tolist()
        [0.3, -1.0, 2.0]
        """
        owner = f"{type(self).__name__}.pose"
        if self.start == EQUILIBRIUM:
            raise InputError(
                f"{owner}: the system starts at its equilibrium; leave out start or the stated coordinates"
            )
        self.stated = JointStates(
            joint_values(f"{owner}, coordinates", self.joints, coordinates),
            joint_values(f"{owner}, rates", self.joints, rates),
        )

    @property
    def findings(self) -> tuple[Finding, ...]:
        """What there is to say about the choice of bodies, such as elements that lock, and about numbers of loads."""
        return tuple(finding for part in (*self.bodies, *self.loads) for finding in part.findings)

    @property
    def carriers(self) -> list[Any]:
        """All that has coordinates: the bodies, then the coordinates of joints that components need."""
        return [*self.bodies, *(own for part in (*self.joints, *self.loads) for own in part.coordinates)]

    def body(self, name: str) -> Any:
        """The body of this name."""
        bodies = {body.name: body for body in self.bodies}
        require_known("body", name, bodies)
        return bodies[name]


class System(BaseSystem):
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

    KINDS = (Body, Joint, Load)
    SPACE = "in the plane"
    AXES = "xy"
    LOWERING = "dalembert.multibody.model.planar_lowering.PlanarLowering"

    def __init__(
        self, gravity: tuple[Number, Number] = (0.0, -9.81), driving: Sequence[str] = (), start: str = PLACED
    ) -> None:
        super().__init__(gravity, driving, start)
        self.ground = Ground()


def _checked_gravity(gravity: Any, owner: str, axes: str) -> Any:
    """Gravity, refused where it is not a number for each axis."""
    try:
        usable = len(gravity) == len(axes) and all(map(is_number, gravity))
    except TypeError:
        usable = False
    if not usable:
        example = ", ".join(["0.0"] * (len(axes) - 1) + ["-9.81"])
        count = {2: "two", 3: "three"}[len(axes)]
        raise InputError(
            f"{owner}: gravity is {shown(gravity)}; expected {count} finite numbers in m/s^2, along "
            f"{', '.join(axes[:-1])} and {axes[-1]}, such as ({example})"
        )
    return gravity
