"""Findings on beams in space whose nodes turn far against each other within an element."""

from typing import TYPE_CHECKING

import numpy as np

from dalembert.findings import Finding
from dalembert.multibody.components.spatial.beam_kinematics import node_traces

if TYPE_CHECKING:
    from dalembert.multibody.components.spatial.beam import Beam


def turn_findings(beam: "Beam", times: np.ndarray, states: np.ndarray) -> tuple[Finding, ...]:
    """Return a finding on a beam of which a node turns by more than 90 degrees against the middle of its element.

    ``times`` (samples,): s; ``states`` (samples, size): coordinates of the beam.
    """
    nodes = states.reshape(len(states), -1, 4, 3)
    cosines = node_traces(beam.by_element(nodes)).reshape(len(states), -1).min(axis=1)
    sample = int(np.argmin(cosines))
    angle = float(np.degrees(np.arccos(np.clip(cosines[sample], -1.0, 1.0))))
    if angle <= 90.0:
        return ()
    values = {"body": beam.name, "angle": angle, "time": float(times[sample]), "elements": beam.elements}
    message = (
        f"A node of beam {beam.name!r} turns by {angle:.3g} degrees against the middle of its element at "
        f"{times[sample]:.4g} s. The element is not accurate there, and it fails at 180 degrees."
    )
    return (Finding("beam-turn", "warning", values, message, "Use more elements."),)
