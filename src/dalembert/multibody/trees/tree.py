"""Trees of rigid links and joints, such as robots: a description that files are read to and systems are built of."""

__all__ = ["Link", "Shape", "Tree", "TreeJoint"]

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from types import MappingProxyType
from typing import TYPE_CHECKING, Any

import numpy as np

from dalembert.arguments import Checked
from dalembert.errors import InputError, ModelError, require_known, unknown
from dalembert.findings import Finding
from dalembert.multibody.components.fields import Number, number
from dalembert.multibody.components.signals import Course
from dalembert.multibody.components.spatial.inertia import Inertia
from dalembert.multibody.components.spatial.orientation import Orientation, Pose, Vector
from dalembert.multibody.components.spatial.shapes import Shape
from dalembert.multibody.trees.omissions import Omission, omission_findings

if TYPE_CHECKING:
    from dalembert.multibody.model.spatial_system import SpatialSystem
    from dalembert.multibody.trees.build import Limits

REVOLUTE, PRISMATIC, FIXED = KINDS = "revolute", "prismatic", "fixed"
ORIGIN = Pose()
NO_TORQUES: Mapping[str, Course] = MappingProxyType({})
ENTRIES = ("xx", "yy", "zz", "xy", "xz", "yz")
JOINT_NUMBERS = ("damping", "friction", "armature")


@dataclass(frozen=True)
class TreeJoint(Checked):
    """The joint by which a link hangs on its parent. The frame of the link is that of the joint.

    Parameters
    ----------
    name : str
    kind : {"revolute", "prismatic", "fixed"}
    pose : Pose
        Frame of the joint at the position zero, in the frame of the parent.
    axis : (float, float, float)
        In the frame of the joint.
    lower, upper : float
        Limits of the position, rad or m.
    velocity, effort : float
        Limits of the rate, rad/s or m/s, and of the torque or force, N m or N.
    damping : float
        Viscous friction, N m s or N s/m.
    friction : float
        Coulomb friction, N m or N.
    armature : float
        Inertia of the motor behind its gear, kg m^2 or kg.
    mimic : (str, float, float), optional
        Another joint, a factor and an offset: position = factor x position of the other joint + offset.
    """

    name: str
    kind: str = REVOLUTE
    pose: Pose = Pose()
    axis: Vector = (0.0, 0.0, 1.0)
    lower: float = -np.inf
    upper: float = np.inf
    velocity: float = np.inf
    effort: float = np.inf
    damping: Number = number("N*m*s", 0.0, least=0)
    friction: Number = number("N*m", 0.0, least=0)
    armature: Number = number("kg*m**2", 0.0, least=0)
    mimic: tuple[str, float, float] | None = None

    def __post_init__(self) -> None:
        require_known("kind", self.kind, KINDS, f"joint {self.name!r}")

    @property
    def moves(self) -> bool:
        """Whether the joint has a position."""
        return self.kind != FIXED


@dataclass(frozen=True)
class Link(Checked):
    """A rigid link.

    Parameters
    ----------
    name : str
    parent : str
        Link that it hangs on.
    joint : TreeJoint
    inertia : Inertia or None
        In the frame of the link; None for a link without mass.
    shapes : tuple of Shape
        What the link looks like.
    collisions : tuple of Shape
        Shapes by which programs with contacts find collisions; they do not change the motion here.
    """

    name: str
    parent: str
    joint: TreeJoint
    inertia: Inertia | None = None
    shapes: tuple[Shape, ...] = ()
    collisions: tuple[Shape, ...] = ()


@dataclass(frozen=True)
class Tree(Checked):
    """A tree of rigid links on a base that does not move.

    Parameters
    ----------
    name : str
    root : str
        The base.
    links : tuple of Link
        Each after its parent.
    shapes : tuple of Shape
        Of the base.
    omissions : tuple of Omission
        What the import of a file left out, since it has no counterpart here.
    inertia : Inertia or None
        Of the base; it does not move, so the inertia changes no motion.
    collisions : tuple of Shape
        Of the base.

    Raises
    ------
    ModelError
        For a link whose parent is not there or comes later, and for names that are used twice.
    """

    name: str
    root: str
    links: tuple[Link, ...]
    shapes: tuple[Shape, ...] = ()
    omissions: tuple[Omission, ...] = field(default=(), compare=False)
    inertia: Inertia | None = None
    collisions: tuple[Shape, ...] = ()
    changed: frozenset[str] = field(default=frozenset(), compare=False, repr=False)

    def __post_init__(self) -> None:
        known = [self.root]
        for link in self.links:
            if link.parent not in known:
                raise ModelError(f"link {link.name!r}: {unknown('parent', link.parent, known)} Give the parent first")
            if link.name in known:
                raise ModelError(f"link {link.name!r} is there twice. Give each link its own name")
            known.append(link.name)
        names = [link.joint.name for link in self.links]
        for name in names:
            if names.count(name) > 1:
                raise ModelError(f"joint {name!r} is there twice. Give each joint its own name")
        for joint in self.joints:
            if joint.mimic and joint.mimic[0] not in names:
                raise ModelError(f"joint {joint.name!r}: {unknown('joint', joint.mimic[0], names)}")
        for joint in self.joints:
            self._refuse_circle(joint)

    def _refuse_circle(self, joint: TreeJoint) -> None:
        """Refuse a joint that follows itself, directly or by way of others."""
        by_name = {own.name: own for own in self.joints}
        followed = [joint.name]
        while joint.mimic is not None:
            joint = by_name[joint.mimic[0]]
            if joint.name in followed:
                circle = " -> ".join(map(repr, [*followed, joint.name]))
                raise ModelError(f"joints follow each other in a circle (mimic): {circle}. Let one of them move freely")
            followed.append(joint.name)

    @property
    def unsupported(self) -> tuple[str, ...]:
        """What the import of a file left out, as texts."""
        return tuple(omission.text for omission in self.omissions)

    @property
    def findings(self) -> tuple[Finding, ...]:
        """Findings about what the import of a file left out.

        Those of :meth:`system` also have the limits that have no effect there.
        """
        return omission_findings(self.name, self.omissions)

    @property
    def joints(self) -> tuple[TreeJoint, ...]:
        """The joints of all links."""
        return tuple(link.joint for link in self.links)

    @cached_property
    def moving(self) -> tuple[TreeJoint, ...]:
        """The joints with a position that does not follow another one; positions (dofs,) are in this order."""
        return tuple(joint for joint in self.joints if joint.moves and joint.mimic is None)

    def link(self, name: str) -> Link:
        """The link of this name."""
        for link in self.links:
            if link.name == name:
                return link
        raise InputError(unknown("link", name, [link.name for link in self.links]))

    @cached_property
    def numbers(self) -> dict[str, Number]:
        """All numbers that may be parameters, by their names.

        ``<link>.mass``, ``<link>.centre_x`` to ``_z``, ``<link>.inertia_xx`` to ``_yz`` (about the centre of mass),
        ``<joint>.damping``, ``<joint>.friction`` and ``<joint>.armature``.
        """
        found: dict[str, Number] = {}
        for link in self.links:
            own = link.inertia
            if own is not None:
                found[f"{link.name}.mass"] = own.mass
                found |= {f"{link.name}.centre_{axis}": own.centre[k] for k, axis in enumerate("xyz")}
                values = (*own.moments, *own.products)
                found |= {f"{link.name}.inertia_{entry}": values[k] for k, entry in enumerate(ENTRIES)}
            if link.joint.moves:
                found |= {f"{link.joint.name}.{name}": getattr(link.joint, name) for name in JOINT_NUMBERS}
        return found

    def with_numbers(self, values: Mapping[str, Number]) -> "Tree":
        """The tree with other numbers, by the names of :attr:`numbers`.

        Raises
        ------
        InputError
            For an unknown name, with the nearest ones.
        """
        for name in values:
            if name not in self.numbers:
                raise InputError(unknown("number", name, list(self.numbers)))
        changed = self.changed | frozenset(values)
        return replace(self, links=tuple(_changed(link, values) for link in self.links), changed=changed)

    def with_fixed_joints(self, positions: Mapping[str, Number]) -> "Tree":
        """The tree with joints fixed at positions (rad or m), such as fingers, or joints that follow others.

        Raises
        ------
        InputError
            For an unknown joint.
        ModelError
            For a joint that another one follows, which is not fixed with it.
        """
        from dalembert.multibody.trees.kinematics import fixed_joints

        return fixed_joints(self, positions)

    def marker(self, link: str) -> str:
        """Body and point of a link in :meth:`system`, such as ``"forearm.origin"`` or ``"forearm.gripper"``.

        Raises
        ------
        InputError
            For an unknown link, and one that is fixed to the base.
        """
        from dalembert.multibody.trees.build import groups

        self.link(link)
        group = groups(self)[link]
        if group.joint is None:
            raise InputError(f"link {link!r} is fixed to the base and does not move. Choose a link that moves")
        return f"{group.name}.{link if link != group.name else 'origin'}"

    def system(
        self,
        positions: Mapping[str, Number] | Sequence[Number] | None = None,
        rates: Mapping[str, Number] | Sequence[Number] | None = None,
        gravity: tuple[Number, Number, Number] = (0.0, 0.0, -9.81),
        *,
        base: Pose = ORIGIN,
        slip: Number = 1e-3,
        start: str = "placed",
        limits: "Limits" = None,
        torques: Mapping[str, Course] = NO_TORQUES,
    ) -> "SpatialSystem":
        """The mechanism of the tree, with its base on the ground.

        Links that are fixed to each other are one rigid body with the name of the first of them. Its marker
        ``origin`` is the frame of this link; markers with the names of the others are theirs. Joints keep their names,
        except where a body has the same name: then ``" joint"`` is appended. Damping and friction become
        :class:`~dalembert.multibody.spatial.Friction`, armature inertias
        :class:`~dalembert.multibody.spatial.Armature`. A joint that follows another one is coupled to it by a
        :class:`~dalembert.multibody.spatial.CouplingJoint`, ``"<joint> mimic"``. Limits of rates and torques have no
        effect, and those of positions only if ``limits`` are given; the findings of the system list such limits.

        Parameters
        ----------
        positions, rates : mapping of str to float, or sequence
            Of the moving joints at the start, rad and rad/s or m and m/s: by name (0 if missing), or in the order of
            :attr:`moving`.
        gravity : (float, float, float)
            m/s^2.
        base : Pose
            Of the base.
        slip : float
            Rate over which Coulomb friction turns its sign, rad/s or m/s.
        start : {"placed", "equilibrium"}
            See :class:`~dalembert.multibody.spatial.SpatialSystem`.
        limits : (float, float), or mapping of str to (float, float), optional
            Stiffness and damping of stops at the limits of the positions of all joints, or of joints by name, as in
            :class:`~dalembert.multibody.spatial.AngleLimit` and
            :class:`~dalembert.multibody.spatial.DisplacementLimit`. The stops are ``"<joint> limits"``.
        torques : mapping of str to float or Signal
            Of joints, N m, or forces of prismatic joints, N, from the parent on the child: loads named
            ``"<joint> drive"``.

        Raises
        ------
        InputError
            For unknown joints, and for joints without limits that are to have stops.
        ModelError
            For a link that moves without mass, and for a joint that follows a fixed one.

        Examples
        --------
        >>> from dalembert.multibody import simulate
        >>> arm = Inertia(1.0, (0.1, 0.1, 0.01), centre=(0.0, 0.0, -0.5))
        >>> tree = Tree("pendulum", "base", (Link("arm", "base", TreeJoint("pin", axis=(0.0, 1.0, 0.0)), arm),))
        >>> motion = simulate(tree.system({"pin": 0.1}), end=0.5)
        >>> motion.channels(["pin.angle"]).ravel()[[0, -1]].round(3)
        array([ 0.1 , -0.03])
        """
        from dalembert.multibody.trees.build import built

        return built(self, positions, rates, gravity, base, slip, start, limits, torques)


def _changed(link: Link, values: Mapping[str, Any]) -> Link:
    """A link with other numbers."""
    joint = {
        name: values[f"{link.joint.name}.{name}"] for name in JOINT_NUMBERS if f"{link.joint.name}.{name}" in values
    }
    inertia = link.inertia
    if inertia is not None and any(key.startswith(f"{link.name}.") for key in values):
        own = lambda key, now: values.get(f"{link.name}.{key}", now)  # noqa: E731
        six = [
            own(f"inertia_{entry}", now)
            for entry, now in zip(ENTRIES, (*inertia.moments, *inertia.products), strict=True)
        ]
        centre = tuple(own(f"centre_{axis}", now) for axis, now in zip("xyz", inertia.centre, strict=True))
        inertia = Inertia(own("mass", inertia.mass), tuple(six[:3]), tuple(six[3:]), centre)
    return replace(link, joint=replace(link.joint, **joint), inertia=inertia)


def pose_matrix(pose: Pose) -> tuple[np.ndarray, np.ndarray]:
    """Position (3,) and rotation matrix (3, 3) of a pose."""
    return np.array(pose.position), pose.orientation.matrix


def turned_about(axis: Vector, angle: Number) -> Orientation:
    """Orientation after a rotation about a direction."""
    own = np.array(axis)
    return Orientation.by_rotation_vector(tuple((own * (angle / np.sqrt(own @ own))).tolist()))
