"""Robots from URDF files (https://wiki.ros.org/urdf/XML)."""

__all__ = ["read_urdf"]

import os
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from dalembert.errors import InputError, ModelError, listed, repeated, require_known, unknown
from dalembert.multibody.components.spatial.inertia import Inertia
from dalembert.multibody.components.spatial.mesh_files import unread
from dalembert.multibody.components.spatial.orientation import Orientation, Pose
from dalembert.multibody.components.spatial.shapes import capsule
from dalembert.multibody.trees.omissions import Omission
from dalembert.multibody.trees.possible_inertia import REFUSE, TREATMENTS, possible
from dalembert.multibody.trees.tree import FIXED, PRISMATIC, REVOLUTE, Link, Shape, Tree, TreeJoint
from dalembert.multibody.trees.urdf_document import Element, parsed

KINDS = {"revolute": REVOLUTE, "continuous": REVOLUTE, "prismatic": PRISMATIC, "fixed": FIXED}
UNSUPPORTED = ("floating", "planar")
AXIS = (1.0, 0.0, 0.0)
"""Where a file has none."""

_SIZES: dict[str, Callable[[Element], tuple[float, ...]]] = {
    "box": lambda own: own.numbers("size", 3),
    "cylinder": lambda own: (own.number("radius"), own.number("length")),
    "sphere": lambda own: (own.number("radius"),),
    "capsule": lambda own: (own.number("radius"), own.number("length")),
    "mesh": lambda own: own.numbers("scale", 3, (1.0, 1.0, 1.0)),
}
COLLISION = "collision"


def read_urdf(path: str | os.PathLike[str], impossible: str = REFUSE) -> Tree:
    """Return the robot of a URDF file.

    Links with inertias and shapes are imported, and joints with their kind, pose, axis, limits, damping, friction and
    mimic. Meshes are drawn where their files are there (STL, OBJ, DAE and PLY, with the extra ``meshes``). Collision
    shapes have no effect on the motion; :func:`write_urdf` writes them. A capsule is a cylinder and two spheres. All
    other elements and attributes are listed in :attr:`Tree.omissions`, such as materials, transmissions and sensors.
    The attribute ``armature`` of ``<dynamics>`` is an addition to URDF; :func:`write_urdf` writes it.

    Floating and planar joints are fixed at their zero position, and listed. A joint without ``<limit>`` has no limits.

    Parameters
    ----------
    path : path
    impossible : {"refuse", "replace"}
        What to do with an inertia that no body can have: refuse the file, or take the nearest possible one, which is
        listed.

    Raises
    ------
    InputError
        For a missing file, what is no XML, missing or wrong elements and attributes, and unknown kinds of joints, with
        file and line.
    ModelError
        For links and joints that are no tree, and impossible inertias.

    Examples
    --------
    >>> import tempfile
    >>> text = '''<robot name="pendulum"><link name="base"/>
    ... <link name="arm"><inertial><origin xyz="0 0 -0.5"/><mass value="2"/>
    ...   <inertia ixx="0.1" iyy="0.1" izz="0.01" ixy="0" ixz="0" iyz="0"/></inertial></link>
    ... <joint name="pin" type="continuous"><parent link="base"/><child link="arm"/><axis xyz="0 1 0"/></joint>
    ... </robot>'''
    >>> file = Path(tempfile.mkdtemp()) / "pendulum.urdf"
    >>> _ = file.write_text(text)
    >>> tree = read_urdf(file)
    >>> [joint.name for joint in tree.moving], tree.numbers["arm.mass"], tree.unsupported
    (['pin'], 2.0, ())
    """
    require_known("impossible", impossible, TREATMENTS, "read_urdf")
    path = Path(path)
    robot = parsed(path, "robot", "a URDF file; convert xacro files first")
    notes: list[Omission] = []
    links = {own.required_word("name"): own for own in robot.all("link")}
    _refuse_repeated(path, robot, "link")
    joints = robot.all("joint")
    for own in joints:
        own.required_word("name")
    _refuse_repeated(path, robot, "joint")
    if not links:
        raise ModelError(f"{path}: the file has no <link>. A robot has at least one")
    known = [joint.attributes["name"] for joint in joints]
    for joint in joints:
        mimic = joint.child("mimic") if KINDS.get(joint.attributes.get("type", ""), FIXED) != FIXED else None
        if mimic is not None and (leader := mimic.required_word("joint")) not in known:
            raise ModelError(f"{mimic.place}: {unknown('joint', leader, known)}")
    root, ordered = _ordered(path, list(links), joints)

    def parts(name: str) -> tuple[Inertia | None, tuple[Shape, ...], tuple[Shape, ...]]:
        own = links[name]
        return (
            _inertia(own, impossible, notes),
            _shapes(own, "visual", path, notes),
            _shapes(own, COLLISION, path, notes),
        )

    inertia, shapes, collisions = parts(root)
    made = [
        Link(_end(own, "child"), _end(own, "parent"), _joint(own, notes), *parts(_end(own, "child"))) for own in ordered
    ]
    if collisions or any(link.collisions for link in made):
        notes.append(Omission("contacts of collision shapes are not imported"))
    name = robot.word("name") or path.stem
    return Tree(name, root, tuple(made), shapes, (*notes, *robot.unread()), inertia, collisions)


def _refuse_repeated(path: Path, robot: Element, tag: str) -> None:
    for name in repeated(own.attributes["name"] for own in robot.children if own.tag == tag):
        lines = [str(own.line) for own in robot.children if own.tag == tag and own.attributes["name"] == name]
        raise ModelError(f"{path.name}: {tag} {name!r} is in lines {listed(lines)}. Give each {tag} another name")


def _end(joint: Element, side: str) -> str:
    """The link at a side of a joint."""
    return joint.required(side).required_word("link")


def _ordered(path: Path, links: Sequence[str], joints: Sequence[Element]) -> tuple[str, list[Element]]:
    """The base, and the joints so that each follows that of its parent; in the order of the file if possible."""
    above: dict[str, Element] = {}
    for joint in joints:
        for side in ("parent", "child"):
            if (name := _end(joint, side)) not in links:
                raise ModelError(f"{joint.place}: {unknown(f'{side} link', name, links)}")
        child = _end(joint, "child")
        if child in above:
            raise ModelError(
                f"{joint.place}: its child {child!r} is that of {above[child].owner} too (line {above[child].line}). "
                "A link of a tree hangs on one joint; close loops by a joint of the SpatialSystem"
            )
        above[child] = joint
    roots = [name for name in links if name not in above]
    if len(roots) > 1:
        raise ModelError(
            f"{path.name}: {listed([repr(name) for name in roots])} are the child of no joint; expected one such "
            "link, the base. Add joints, or remove links"
        )
    known, ordered, left = set(roots), [], list(joints)
    while ready := [joint for joint in left if _end(joint, "parent") in known]:
        first = ready[0]
        ordered.append(first)
        known.add(_end(first, "child"))
        left.remove(first)
    if left:
        names = listed([repr(own.attributes["name"]) for own in _loop(left, above)])
        raise ModelError(f"{path.name}: the joints {names} form a loop. Remove one, and close the loop in the system")
    return roots[0], ordered


def _loop(left: Sequence[Element], above: dict[str, Element]) -> list[Element]:
    """Joints of a loop among those that hang on no base."""
    passed = [left[0]]
    while (up := above[_end(passed[-1], "parent")]) not in passed:
        passed.append(up)
    return passed[passed.index(up) :][::-1]


def _pose(owner: Element) -> Pose:
    origin = owner.child("origin")
    if origin is None:
        return Pose()
    zero = (0.0, 0.0, 0.0)
    turn = Orientation.by_angles("XYZ", origin.numbers("rpy", 3, zero))
    return Pose(origin.numbers("xyz", 3, zero), turn)  # type: ignore[arg-type]


def _inertia(link: Element, impossible: str, notes: list[Omission]) -> Inertia | None:
    own = link.child("inertial")
    if own is None:
        return None
    pose, mass, entries = _pose(own), own.required("mass").number("value"), own.required("inertia")
    xx, yy, zz, xy, xz, yz = (entries.number(f"i{name}") for name in ("xx", "yy", "zz", "xy", "xz", "yz"))
    turn = pose.orientation.matrix
    tensor = turn @ np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]]) @ turn.T
    return possible(mass, tensor, pose.position, own.place, impossible, notes)


def _shapes(link: Element, tag: str, path: Path, notes: list[Omission]) -> tuple[Shape, ...]:
    """The visual or the collision shapes of a link."""
    found = []
    for part in link.all(tag):
        geometry = part.child("geometry")
        kinds = [own for own in (geometry.children if geometry else []) if own.tag in _SIZES]
        if not kinds:
            notes.append(Omission(f"line {part.line}: {part.words} has no box, cylinder, sphere, capsule or mesh"))
            continue
        own = kinds[0]
        own.known = True
        sizes, pose = _SIZES[own.tag](own), _pose(part)
        if own.tag == "mesh":
            found.append(_mesh(own, sizes, pose, tag, path, notes))
        elif min(sizes) <= 0.0:
            effect = "it is left out" if tag == COLLISION else "it is not drawn"
            notes.append(Omission(f"line {own.line}: the {own.tag} of {own.owner} has a size of zero; {effect}"))
        elif own.tag == "capsule":
            found += capsule(*sizes, pose)
        else:
            found.append(Shape(own.tag, sizes, pose))
    return tuple(found)


def _mesh(own: Element, factors: tuple[float, ...], pose: Pose, tag: str, path: Path, notes: list[Omission]) -> Shape:
    """A mesh; it is listed if it is not drawn, which only visual ones are."""
    file = own.required_word("filename")
    found = _file(file, path) if file else None
    if file and tag != COLLISION:
        problem = "is not there, so it is not drawn" if found is None else unread(found)
        if problem:
            notes.append(Omission(f"line {own.line}: the mesh {file!r} of {own.owner} {problem}"))
            found = None
    return Shape("mesh", factors, pose, file, str(found or ""))


def _file(file: str, path: Path) -> Path | None:
    """The file of a mesh, if it is there; packages are looked for in the folders around the file."""
    scheme, separator, name = file.partition("://")
    folders = path.absolute().parents if scheme == "package" and separator else [path.absolute().parent]
    places = [folder / (name if separator else file) for folder in folders]
    return next((place for place in places if place.is_file()), None)


def _joint(own: Element, notes: list[Omission]) -> TreeJoint:
    name, kind = own.required_word("name"), own.required_word("type")
    require_known("type", kind, [*KINDS, *UNSUPPORTED], own.place)
    if kind in UNSUPPORTED:
        text = f"line {own.line}: {own.owner} is {kind}, which is not supported; it is fixed at its zero position"
        notes.append(Omission(text, moves=True))
    if KINDS.get(kind, FIXED) == FIXED:
        return TreeJoint(name, FIXED, _pose(own))
    options: dict[str, Any] = {}
    if (axis := own.child("axis")) is not None:
        options["axis"] = axis.numbers("xyz", 3, AXIS)
        if not np.any(options["axis"]):
            raise InputError(f"{axis.place} is zero; expected a direction, such as 0 0 1")
    if (limit := own.child("limit")) is not None:
        if kind != "continuous":
            options |= {side: limit.limit(side, 0.0) for side in ("lower", "upper")}
            if options["lower"] > options["upper"]:
                raise InputError(
                    f"{limit.place}: lower is {options['lower']:g} and upper is {options['upper']:g}; expected lower "
                    "not above upper"
                )
        options |= {what: limit.limit(what, np.inf) for what in ("velocity", "effort")}
    if (dynamics := own.child("dynamics")) is not None:
        for what in ("damping", "friction", "armature"):
            options[what] = dynamics.number(what, 0.0)
            if options[what] < 0.0:
                raise InputError(f"{dynamics.place}: {what} is {options[what]:g}; expected zero or more")
    if (mimic := own.child("mimic")) is not None:
        options["mimic"] = mimic.required_word("joint"), mimic.number("multiplier", 1.0), mimic.number("offset", 0.0)
    return TreeJoint(name, KINDS[kind], _pose(own), **{"axis": AXIS, **options})
