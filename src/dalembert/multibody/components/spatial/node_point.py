"""Markers that are fixed to nodes of flexible bodies in space."""

__all__ = ["NodePoint"]

from dataclasses import dataclass

from dalembert.arguments import Checked
from dalembert.multibody.components.fields import number
from dalembert.multibody.components.spatial.orientation import Orientation, Vector


@dataclass(frozen=True)
class NodePoint(Checked):
    """A marker that is fixed to a node of a flexible body.

    Parameters
    ----------
    at : str
        The node. Of a beam: ``"start"``, ``"end"``, or ``"node0"`` and so on; of a reduced body: an interface node.
    position : (float, float, float)
        In the axes of the node, m; of a beam along its line, y and z of the section.
    orientation : Orientation
        Relative to the axes of the node.
    """

    at: str = "end"
    position: Vector = number("m", (0.0, 0.0, 0.0))
    orientation: Orientation = Orientation()

    IN_WORDS = "a NodePoint such as NodePoint('end', (0.0, 0.01, 0.0))"
