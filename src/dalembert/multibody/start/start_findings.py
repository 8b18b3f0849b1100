"""Findings on components in space that do not suit the joints that they act on, at the start of a motion."""

from collections.abc import Iterator
from typing import Any

import numpy as np

from dalembert.findings import Finding
from dalembert.multibody.components.base_body import ANGLE, DISPLACEMENT
from dalembert.multibody.components.spatial.armature import Armature
from dalembert.multibody.components.spatial.joint_coordinate import CHANNELS, TIES, coordinates_of
from dalembert.multibody.components.spatial.joint_limit import Limit
from dalembert.multibody.components.spatial.spatial_joint import Joint
from dalembert.multibody.components.spatial.spatial_motor import Motor
from dalembert.multibody.components.spatial.spatial_torsion_spring import TorsionSpring
from dalembert.multibody.model.lowered import Lowered
from dalembert.multibody.model.system import BaseSystem
from dalembert.multibody.start.assemble import inner_constraints, redundancy

PARALLEL = np.cos(np.deg2rad(1.0))  # of axes that are meant to be the same
_BEYOND = 1e-9  # of the range, or rad and m: rounding of a start at the limit


def joined(system: BaseSystem) -> list[Any]:
    """Return the components that act on the coordinate of a joint."""
    return [load for load in system.loads if isinstance(load, Limit | Motor | Armature | TorsionSpring)]


def start_findings(system: BaseSystem, lowered: Lowered, x: np.ndarray) -> tuple[Finding, ...]:
    """Return findings on limits that the start violates, and on axes that no joint between the same bodies has.

    ``x`` (N + 1,): unknowns at the start.
    """
    findings: list[Finding] = []
    for load in joined(system):
        of_load = _violated(load, lowered, x) if isinstance(load, Limit) else _off_axis(load, system, lowered, x)
        findings.extend(of_load)
    return tuple(findings)


def _violated(limit: Limit, lowered: Lowered, x: np.ndarray) -> Iterator[Finding]:
    """Yield how far beyond its limits a coordinate starts, and what pushes it back there."""
    kind, row = lowered.structure.rows[limit.name]
    value = float(np.real(x[lowered.structure.index[kind][row][0]]))
    ends = [None if end is None else float(np.real(end)) for end in (limit.lower_limit, limit.upper_limit)]
    scale = max(1.0, *(abs(end) for end in ends if end is not None))
    for side, end, sign in zip(("lower", "upper"), ends, (-1.0, 1.0), strict=True):
        if end is None or sign * (value - end) <= _BEYOND * scale:
            continue
        beyond = sign * (value - end)
        push = float(np.real(limit.stiffness)) * beyond**1.5
        (name, unit), _, (what, push_unit) = CHANNELS[limit.COORDINATE]
        values = {"limit": limit.name, "joint": limit.joint.name, name: value, side: end, what: push}
        message = (
            f"Joint {limit.joint.name!r} starts beyond the {side} limit of {limit.name!r}: its {name} is {value:.4g} "
            f"{unit}, and the limit is {end:.4g} {unit}. The stop pushes it back with {push:.3g} "
            f"{push_unit.replace('*', ' ')}."
        )
        advice = "Start within the limits, for example with pose(), or change the limit."
        yield Finding("limit-violated", "warning", values, message, advice)


def _off_axis(load: Any, system: BaseSystem, lowered: Lowered, x: np.ndarray) -> Iterator[Finding]:
    """Yield that no joint between the bodies of a load has the coordinate that the load acts on."""
    slides = isinstance(load, Armature) and load.slides
    wanted = DISPLACEMENT if slides else ANGLE
    bodies = _bodies(load)
    joints = [joint for joint in system.joints if isinstance(joint, Joint) and _bodies(joint) == bodies]
    joints = [joint for joint in joints if coordinates_of(joint)]
    angles = []
    for joint in joints:
        cosine = abs(float(_axis(joint, load.name, lowered, x) @ _axis(joint, joint.name, lowered, x)))
        if wanted in coordinates_of(joint) and cosine >= PARALLEL:
            return
        angles.append(float(np.degrees(np.arccos(min(cosine, 1.0)))))
    if not joints:  # it may act across other joints
        return
    joint, angle = joints[int(np.argmin(angles))], min(angles)
    parallel = angle <= np.degrees(np.arccos(PARALLEL))
    values = {"component": load.name, "joint": joint.name, "coordinate": wanted, "angle": angle}
    kind = type(load).__name__
    if parallel:
        what = "slides" if slides else "turns"
        message = f"{kind} {load.name!r} {what}, but joint {joint.name!r} between the same bodies has no {wanted}."
        advice = "Choose slides as the joint does." if isinstance(load, Armature) else "Use a joint with an angle."
    else:
        message = (
            f"The axis of {kind} {load.name!r} is at {angle:.3g} degrees to that of joint {joint.name!r} between the "
            "same bodies. The joint takes a part of what it exerts."
        )
        advice = "Give it the axis of the joint."
    yield Finding("other-axis", "warning", values, message, advice)


def _bodies(component: Any) -> frozenset[str]:
    """Names of the bodies that a component connects; "" stands for the ground."""
    return frozenset(getattr(getattr(side, "body", None), "name", "") for side in (component.a, component.b))


def _axis(joint: Joint, name: str, lowered: Lowered, x: np.ndarray) -> np.ndarray:
    """Direction of the axis of a component of this name in the fixed axes, which is that of a marker as for a joint."""
    structure, tie = lowered.structure, f"{name}.joint"
    kind, row = structure.rows[name]
    if tie in lowered.parts.get(TIES[ANGLE], ()):  # of a component that acts on a coordinate
        kind, row = TIES[ANGLE], lowered.parts[TIES[ANGLE]].index(tie)
    numbers, integers = np.real(lowered.data[kind][row]), structure.meta[kind][row]
    return joint.axis_directions(numbers, integers, np.real(x[structure.index[kind][row]]))


def redundant_constraints(lowered: Lowered) -> tuple[Finding, ...]:
    """Return a finding on joints whose constraints follow from those of others at the start; none if all are needed."""
    count, rank, joints = redundancy(lowered)
    if not joints:
        return ()
    inside = inner_constraints(lowered)
    names = ", ".join(map(repr, joints))
    return (
        Finding(
            "redundant-constraints",
            "note",
            {"constraints": count - inside, "independent": rank - inside, "joints": names},
            f"The joints have {count - inside} constraints, {rank - inside} of them independent at the start. Those of "
            f"{names} follow from the others. Of all possible joint forces, the result has the smallest ones.",
            "If you need the joint forces, replace a joint by one that holds less, or a bushing.",
        ),
    )
