"""Limits of a tree's joints that have no effect on the motion of its mechanism."""

__all__ = ["import_findings"]

from collections.abc import Iterator, Mapping, Sequence

import numpy as np

from dalembert.errors import listed
from dalembert.findings import Finding
from dalembert.multibody.components.spatial.joint_limit import Limit
from dalembert.multibody.components.spatial.spatial_load import Load
from dalembert.multibody.trees.omissions import Omission, omission_findings
from dalembert.multibody.trees.tree import Tree

NAMED = 6
"""Joints that a sentence names; the others are counted."""


def import_findings(tree: Tree, names: Mapping[str, str], loads: Sequence[Load]) -> tuple[Finding, ...]:
    """Return the findings about what the mechanism of a tree lacks; ``names`` are those of the joints there."""
    stopped = {load.joint.name for load in loads if isinstance(load, Limit)}
    free = {joint.name for joint in tree.joints if joint.moves and names[joint.name] not in stopped}
    return omission_findings(tree.name, (*tree.omissions, *_idle_limits(tree, free)))


def _idle_limits(tree: Tree, free: set[str]) -> Iterator[Omission]:
    """Yield the limits of positions of joints without stops, and those of rates and torques, which never act."""
    moving = [joint for joint in tree.joints if joint.moves]
    limited = {
        "positions": [own for own in moving if own.name in free and np.isfinite([own.lower, own.upper]).any()],
        "rates": [own for own in moving if np.isfinite(own.velocity)],
        "torques or forces": [own for own in moving if np.isfinite(own.effort)],
    }
    for what, joints in limited.items():
        if joints:
            names = [repr(joint.name) for joint in joints]
            if len(names) > NAMED:
                names[NAMED:] = [f"{len(names) - NAMED} more joints"]
            yield Omission(f"the limits of the {what} of {listed(names)} have no effect")
