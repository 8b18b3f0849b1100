"""A mechanism in space."""

from collections.abc import Callable, Sequence

from dalembert.findings import Finding
from dalembert.multibody.components.fields import Number
from dalembert.multibody.components.spatial.ground_points import Ground
from dalembert.multibody.components.spatial.shapes import Shape, Surface, surface_of
from dalembert.multibody.components.spatial.spatial_body import Body
from dalembert.multibody.components.spatial.spatial_joint import Joint
from dalembert.multibody.components.spatial.spatial_load import Load
from dalembert.multibody.model.system import PLACED, BaseSystem


class SpatialSystem(BaseSystem):
    """A mechanism in space, built by adding components of :mod:`dalembert.multibody.spatial`.

    Parameters
    ----------
    gravity : (float, float, float)
        m/s^2.
    driving : sequence of str
        Initial coordinates that are kept while a closed loop is assembled: ``"<body>.x"``, ``"<body>.y"``,
        ``"<body>.z"`` (of its placed point), ``"<body>.rotation_x"``, ``"<body>.rotation_y"`` or
        ``"<body>.rotation_z"`` (a rotation about a fixed axis); the other bodies are moved until the joints close.
        Velocities that bodies state are kept in any case.
    start : {"placed", "equilibrium"}
        Where a motion begins: as the bodies are placed, or at rest in the static equilibrium nearest to that, under
        gravity and the loads at time 0. The equilibrium follows the parameters, with exact derivatives.

    Examples
    --------
    >>> from dalembert.multibody.spatial import Inertia, RigidBody, SpatialSystem, SphericalJoint
    >>> system = SpatialSystem()
    >>> box = Inertia.box(mass=2.0, sides=(0.1, 0.1, 0.4))
    >>> rod = system.add(RigidBody("rod", box, points={"end": (0.0, 0.0, 0.2)}, anchor="end"))
    >>> joint = system.add(SphericalJoint("ball", system.ground, rod.point("end")))
    >>> [component.name for component in (*system.bodies, *system.joints)]
    ['rod', 'ball']
    """

    KINDS = (Body, Joint, Load)
    SPACE = "in space"
    AXES = "xyz"
    LOWERING = "dalembert.multibody.model.spatial_lowering.SpatialLowering"

    def __init__(
        self,
        gravity: tuple[Number, Number, Number] = (0.0, 0.0, -9.81),
        driving: Sequence[str] = (),
        start: str = PLACED,
    ) -> None:
        super().__init__(gravity, driving, start)
        self.ground = Ground()
        self.ground_shapes: tuple[Shape, ...] = ()
        """What the ground looks like, in the fixed axes: the base of a robot."""
        self.import_findings: Callable[[Sequence[Load]], tuple[Finding, ...]] | None = None
        """Return what the import of a robot left out, beside the loads that were added."""

    @property
    def findings(self) -> tuple[Finding, ...]:
        imported = self.import_findings(self.loads) if self.import_findings else ()
        return (*imported, *super().findings)

    @property
    def ground_surface(self) -> Surface | None:
        return surface_of(self.ground_shapes)
