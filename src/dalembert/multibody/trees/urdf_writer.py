"""Robots to URDF files."""

__all__ = ["write_urdf"]

import os
from typing import Any
from xml.etree.ElementTree import Element, ElementTree, SubElement, indent

import numpy as np

from dalembert.errors import InputError
from dalembert.files import replacing
from dalembert.multibody.components.spatial.inertia import Inertia
from dalembert.multibody.components.spatial.orientation import Pose
from dalembert.multibody.trees.tree import REVOLUTE, Shape, Tree, TreeJoint
from dalembert.multibody.trees.urdf_document import UNLIMITED

_ATTRIBUTES = {"box": ("size",), "cylinder": ("radius", "length"), "sphere": ("radius",), "mesh": ("scale",)}


def write_urdf(tree: Tree, path: str | os.PathLike[str]) -> None:
    """Write a robot to a URDF file, with all digits of its numbers; :func:`read_urdf` reads the same tree.

    What was not imported is not written. A limit that the tree has not is written as the
    largest number, since other programs require limits. An armature inertia is written as the attribute ``armature`` of
    ``<dynamics>``, which is an addition to URDF; other programs ignore it.

    Raises
    ------
    InputError
        For complex numbers.
    StorageError
        If the file cannot be written.

    Examples
    --------
    >>> import tempfile
    >>> from pathlib import Path
    >>> from dalembert.multibody.trees import Link, read_urdf
    >>> arm = Link("arm", "base", TreeJoint("pin", axis=(0.0, 1.0, 0.0)), Inertia.sphere(mass=2.0, radius=0.1))
    >>> file = Path(tempfile.mkdtemp()) / "arm.urdf"
    >>> write_urdf(Tree("robot", "base", (arm,)).with_numbers({"arm.mass": 2.5}), file)
    >>> read_urdf(file).numbers["arm.mass"]
    2.5
    """
    robot = Element("robot", name=tree.name)
    _link(robot, tree.root, tree.inertia, tree.shapes, tree.collisions)
    for link in tree.links:
        _link(robot, link.name, link.inertia, link.shapes, link.collisions)
    for link in tree.links:
        _joint(robot, link.joint, link.parent, link.name)
    indent(robot)
    with replacing(path) as temporary:
        ElementTree(robot).write(temporary, encoding="utf-8", xml_declaration=True)


def roll_pitch_yaw(matrix: np.ndarray) -> tuple[float, float, float]:
    """Angles about the fixed axes x, y, z of a rotation matrix; exact to rounding at a pitch of 90 degrees too."""
    r = np.asarray(matrix)
    yaw = float(np.arctan2(r[1, 0], r[0, 0]))
    c, s = np.cos(yaw), np.sin(yaw)
    pitch = float(np.arctan2(-r[2, 0], c * r[0, 0] + s * r[1, 0]))
    roll = float(np.arctan2(s * r[0, 2] - c * r[1, 2], c * r[1, 1] - s * r[0, 1]))
    return roll, pitch, yaw


def _text(*numbers: Any) -> str:
    """Numbers with all their digits."""
    if any(np.iscomplexobj(own) for own in numbers):
        raise InputError(f"write_urdf: a number of the tree is {numbers}; expected real numbers")
    return " ".join(repr(float(own) + 0.0) for own in numbers)


def _origin(owner: Element, pose: Pose) -> None:
    if pose != Pose():
        angles = roll_pitch_yaw(pose.orientation.matrix)
        SubElement(owner, "origin", xyz=_text(*pose.position), rpy=_text(*angles))


def _link(
    robot: Element, name: str, inertia: Inertia | None, shapes: tuple[Shape, ...], collisions: tuple[Shape, ...]
) -> None:
    link = SubElement(robot, "link", name=name)
    if inertia is not None:
        own = SubElement(link, "inertial")
        _origin(own, Pose(inertia.centre))
        SubElement(own, "mass", value=_text(inertia.mass))
        names = ("ixx", "iyy", "izz", "ixy", "ixz", "iyz")
        values = (*inertia.moments, *inertia.products)
        SubElement(own, "inertia", {name: _text(value) for name, value in zip(names, values, strict=True)})
    for shape in shapes:
        _shape(SubElement(link, "visual"), shape)
    for shape in collisions:
        _shape(SubElement(link, "collision"), shape)


def _shape(owner: Element, shape: Shape) -> None:
    _origin(owner, shape.pose)
    geometry = SubElement(SubElement(owner, "geometry"), shape.kind)
    if shape.kind == "mesh":
        geometry.set("filename", shape.file)
    attributes = _ATTRIBUTES[shape.kind]
    parts = [shape.sizes] if len(attributes) == 1 else [(size,) for size in shape.sizes]
    for attribute, values in zip(attributes, parts, strict=True):
        geometry.set(attribute, _text(*values))


def _joint(robot: Element, joint: TreeJoint, parent: str, child: str) -> None:
    endless = joint.kind == REVOLUTE and joint.lower == -np.inf and joint.upper == np.inf
    own = SubElement(robot, "joint", name=joint.name, type="continuous" if endless else joint.kind)
    SubElement(own, "parent", link=parent)
    SubElement(own, "child", link=child)
    _origin(own, joint.pose)
    if not joint.moves:
        return
    SubElement(own, "axis", xyz=_text(*joint.axis))
    # The specification requires the element with effort and velocity, and other readers know no infinite numbers.
    limits = {} if endless else {"lower": joint.lower, "upper": joint.upper}
    limits |= {"effort": joint.effort, "velocity": joint.velocity}
    finite = {name: float(np.clip(value, -UNLIMITED, UNLIMITED)) for name, value in limits.items()}
    SubElement(own, "limit", {name: _text(value) for name, value in finite.items()})
    resisting = {name: getattr(joint, name) for name in ("damping", "friction", "armature")}
    if any(resisting.values()):
        given = {name: _text(value) for name, value in resisting.items() if value or name != "armature"}
        SubElement(own, "dynamics", given)
    if joint.mimic:
        other, factor, offset = joint.mimic
        SubElement(own, "mimic", joint=other, multiplier=_text(factor), offset=_text(offset))
