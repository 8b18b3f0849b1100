"""Robots from MJCF files, by MuJoCo's own parser."""

__all__ = ["read_mjcf"]

import os
from importlib import import_module
from pathlib import Path
from typing import Any

import numpy as np

from dalembert.errors import InputError, counted, require_known
from dalembert.multibody.components.spatial.inertia import Inertia
from dalembert.multibody.components.spatial.orientation import Orientation, Pose
from dalembert.multibody.components.spatial.shapes import capsule
from dalembert.multibody.trees.omissions import Omission
from dalembert.multibody.trees.possible_inertia import REFUSE, TREATMENTS, possible
from dalembert.multibody.trees.tree import FIXED, PRISMATIC, REVOLUTE, Link, Shape, Tree, TreeJoint

_FREE, _BALL, _SLIDE, _HINGE = range(4)  # of mjtJoint
_ALWAYS = 1  # of mjtInertiaFromGeom
_MOVING = {
    "nu": "actuator",
    "ntendon": "tendon",
    "neq": "equality constraint",
    "nflex": "flexible body",
    "nplugin": "plugin",
}
_OTHERS = {
    "nsensor": "sensor", "ncam": "camera", "nlight": "light", "nsite": "site", "nkey": "key frame",
    "npair": "contact pair", "nmat": "material", "ntex": "texture", "nskin": "skin",
}  # fmt: skip
"""Counts of a model that have no counterpart here: those that change the motion, and the others."""


def read_mjcf(path: str | os.PathLike[str], impossible: str = REFUSE) -> Tree:
    """Return the robot of an MJCF file as MuJoCo compiles it, with defaults, included files and inertias of shapes.

    Bodies with inertias are imported, hinges and slides with their axis, limits, damping, friction loss and armature,
    and boxes, cylinders, spheres and capsules (a cylinder and two spheres). Shapes that can collide are also collision
    shapes of their link, which :func:`write_urdf` writes. Positions are relative to the reference of a joint. The frame
    of a link is parallel to that of its body, with the origin at its joint. A body with several joints gets a link
    without mass for each but the last. All else is listed in :attr:`Tree.omissions`, such as free and ball joints,
    which are fixed, springs of joints, contacts, actuators and sensors.

    Needs the extra ``mujoco``: ``pip install 'dalembert[mujoco]'``.

    Parameters
    ----------
    path : path
    impossible : {"refuse", "replace"}
        See :func:`read_urdf`.

    Raises
    ------
    InputError
        For a missing file, and what MuJoCo cannot read.
    ModelError
        For impossible inertias.
    """
    require_known("impossible", impossible, TREATMENTS, "read_mjcf")
    path = Path(path)
    if not path.is_file():
        raise InputError(f"{path}: there is no such file. Check the path")
    try:
        mujoco: Any = import_module("mujoco")
    except ImportError:
        raise InputError(
            "read_mjcf: MuJoCo is needed and not installed; run: pip install 'dalembert[mujoco]'"
        ) from None
    notes: list[Omission] = []
    try:
        parsed = mujoco.MjSpec.from_file(str(path))
        _replace_impossible(parsed, path, impossible, notes)
        return _Reader(parsed.compile(), mujoco.mjtDisableBit, path, impossible, notes).tree()
    except UnicodeDecodeError as error:
        raise InputError(f"{path}: a name in the file is no UTF-8 ({error.reason}). Save the file as UTF-8") from None
    except ValueError as error:
        raise InputError(f"{path}: MuJoCo cannot read the file: {' '.join(str(error).split())}") from None


def _replace_impossible(parsed: Any, path: Path, impossible: str, notes: list[Omission]) -> None:
    """Refuse the impossible inertias of a parsed file, or replace them, before MuJoCo compiles and refuses them."""
    if parsed.compiler.balanceinertia or parsed.compiler.inertiafromgeom == _ALWAYS:
        return
    for body in parsed.bodies:
        if not body.explicitinertial:
            continue
        xx, yy, zz, xy, xz, yz = body.fullinertia
        full = not np.isnan(xx)
        tensor = np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]]) if full else np.diag(body.inertia)
        noted = len(notes)
        inertia = possible(float(body.mass), tensor, (0.0, 0.0, 0.0), _place(path, body.name), impossible, notes)
        if inertia is None or len(notes) == noted:
            continue
        if full:
            body.fullinertia = [*inertia.moments, *inertia.products]
        else:
            body.inertia = inertia.moments


def _place(path: Path, body: str) -> str:
    return f"{path.name}: body {body!r}"


class _Reader:
    """Makes the tree of a compiled model."""

    def __init__(self, model: Any, disable: Any, path: Path, impossible: str, notes: list[Omission]) -> None:
        self.model, self.disable, self.path, self.impossible, self.notes = model, disable, path, impossible, notes
        self.names = [model.body(i).name or f"body {i}" for i in range(model.nbody)]
        self.origins = [np.zeros(3) for _ in self.names]
        """Origin of each link in the frame of its body."""

    def tree(self) -> Tree:
        model = self.model
        links = [link for i in range(1, model.nbody) for link in self._links(i)]
        ground, collisions = self._shapes(0)
        for count, what in (_MOVING | _OTHERS).items():
            if number := int(getattr(model, count, 0)):
                self._note(f"{counted(number, what)} not imported", moves=count in _MOVING)
        if np.any(model.geom_contype) or np.any(model.geom_conaffinity):
            self._note("contacts of shapes are not imported")
        if self._disabled("GRAVITY"):
            self._note("the file switches gravity off, which is not imported; give gravity (0, 0, 0)", moves=True)
        elif not np.allclose(model.opt.gravity, [0.0, 0.0, -9.81]):
            gravity = tuple(float(own) for own in model.opt.gravity)
            self._note(f"the gravity {gravity} is not imported; give it to Tree.system", moves=True)
        for name in ("density", "viscosity"):
            if getattr(model.opt, name):
                self._note(f"the {name} of the fluid, {getattr(model.opt, name):g}, is not imported", moves=True)
        notes = tuple(self.notes)
        return Tree(self.path.stem, self.names[0], tuple(links), ground, notes, collisions=collisions)

    def _note(self, text: str, *, moves: bool = False) -> None:
        self.notes.append(Omission(text, moves))

    def _disabled(self, *flags: str) -> bool:
        """Whether the file disables one of these parts of the physics."""
        return any(self.model.opt.disableflags & int(getattr(self.disable, f"mjDSBL_{flag}")) for flag in flags)

    def _links(self, body: int) -> list[Link]:
        """The links of a body: one for each joint, or one that is fixed to its parent."""
        model, name = self.model, self.names[body]
        first, number = int(model.body_jntadr[body]), int(model.body_jntnum[body])
        joints = [k for k in range(first, first + number) if model.jnt_type[k] in (_SLIDE, _HINGE)]
        for k in set(range(first, first + number)) - set(joints):
            kind = "free" if model.jnt_type[k] == _FREE else "ball"
            text = f"joint {self._joint_name(k)!r} of body {name!r} is {kind}, which is not supported; it is fixed"
            self._note(text, moves=True)
        if model.body_gravcomp[body]:
            self._note(f"the compensation of gravity of body {name!r} is not imported", moves=True)
        parent = int(model.body_parentid[body])
        above, at = self.names[parent], self.origins[parent]
        axes = Orientation.by_quaternion(*map(float, model.body_quat[body]))
        placed = model.body_pos[body] - at
        if not joints:
            fixed = TreeJoint(f"{name} fixed", FIXED, Pose(_row(placed), axes))
            return [Link(name, above, fixed, self._inertia(body), *self._shapes(body))]
        made, before = [], np.zeros(3)
        for k in joints:
            anchor = np.array(model.jnt_pos[k])
            step = placed + axes.matrix @ anchor if k == joints[0] else anchor - before
            pose = Pose(_row(step), axes if k == joints[0] else Orientation())
            last = k == joints[-1]
            own = name if last else f"{name} before {self._joint_name(joints[joints.index(k) + 1])}"
            made.append(Link(own, above, self._joint(k, pose)))
            above, before = own, anchor
        self.origins[body] = before
        made[-1] = Link(made[-1].name, made[-1].parent, made[-1].joint, self._inertia(body), *self._shapes(body))
        return made

    def _joint_name(self, k: int) -> str:
        return self.model.joint(k).name or f"joint {k}"

    def _joint(self, k: int, pose: Pose) -> TreeJoint:
        model, name = self.model, self._joint_name(k)
        dof, reference = int(model.jnt_dofadr[k]), float(model.qpos0[model.jnt_qposadr[k]])
        if reference:
            self._note(f"joint {name!r}: its reference {reference:g} is the position zero here")
        if np.any(model.jnt_stiffness[k]) and not self._disabled("SPRING"):
            text = f"joint {name!r}: its spring is not imported; add a TorsionSpring or a Spring to the system"
            self._note(text, moves=True)
        lower, upper = map(float, model.jnt_range[k] - reference) if model.jnt_limited[k] else (-np.inf, np.inf)
        damping, *higher = np.atleast_1d(model.dof_damping[dof]) * (not self._disabled("DAMPER"))
        friction = model.dof_frictionloss[dof] * (not self._disabled("FRICTIONLOSS", "CONSTRAINT"))
        if np.any(higher):
            self._note(f"joint {name!r}: its nonlinear damping is not imported", moves=True)
        return TreeJoint(
            name, REVOLUTE if model.jnt_type[k] == _HINGE else PRISMATIC, pose, _row(model.jnt_axis[k]), lower, upper,
            damping=float(damping), friction=float(friction),
            armature=float(model.dof_armature[dof]),
        )  # fmt: skip

    def _inertia(self, body: int) -> Inertia | None:
        model, place = self.model, _place(self.path, self.names[body])
        axes = Orientation.by_quaternion(*map(float, model.body_iquat[body])).matrix
        tensor = axes @ np.diag(model.body_inertia[body]) @ axes.T
        centre = _row(model.body_ipos[body] - self.origins[body])
        return possible(float(model.body_mass[body]), tensor, centre, place, self.impossible, self.notes)

    def _shapes(self, body: int) -> tuple[tuple[Shape, ...], tuple[Shape, ...]]:
        """The shapes of a body, and those of them that can collide."""
        model, found, collisions = self.model, [], []
        for k in range(int(model.body_geomadr[body]), int(model.body_geomadr[body] + model.body_geomnum[body])):
            turn = Orientation.by_quaternion(*map(float, model.geom_quat[k]))
            pose = Pose(_row(model.geom_pos[k] - self.origins[body]), turn)
            solids = _solids(int(model.geom_type[k]), model.geom_size[k].tolist(), pose)
            collides = model.geom_contype[k] or model.geom_conaffinity[k]
            if not solids:
                effect = "is neither drawn nor a collision shape" if collides else "is not drawn"
                self._note(f"shape {model.geom(k).name or k!r} of body {self.names[body]!r} {effect}")
            found += solids
            if collides:
                collisions += solids
        return tuple(found), tuple(collisions)


def _solids(kind: int, sizes: tuple[float, float, float], pose: Pose) -> tuple[Shape, ...]:
    """The solids of a shape (mjtGeom)."""
    x, y, z = sizes
    match kind:
        case 2:  # sphere
            return (Shape.sphere(x, pose),)
        case 3:  # capsule
            return capsule(x, 2 * y, pose)
        case 5:  # cylinder
            return (Shape.cylinder(x, 2 * y, pose),)
        case 6:  # box
            return (Shape.box((2 * x, 2 * y, 2 * z), pose),)
    return ()


def _row(vector: Any) -> tuple[float, float, float]:
    return tuple(float(own) for own in vector)  # type: ignore[return-value]
