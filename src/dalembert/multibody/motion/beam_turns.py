"""Findings on beams in space whose nodes turn far against each other within an element."""

import numpy as np

from dalembert.findings import Finding
from dalembert.multibody.components.spatial.beam import Beam
from dalembert.multibody.components.spatial.beam_kinematics import node_traces
from dalembert.multibody.model.lowered import Lowered
from dalembert.multibody.model.system import BaseSystem


def turn_findings(system: BaseSystem, lowered: Lowered, times: np.ndarray, states: np.ndarray) -> tuple[Finding, ...]:
    """Return a finding for each beam of which a node turns by more than 90 degrees against the middle of its element.

    ``times`` (samples,): s; ``states`` (samples, N + 1): coordinates.
    """
    findings = []
    for beam in system.bodies:
        if not isinstance(beam, Beam):
            continue
        first = lowered.structure.first[beam.name]
        nodes = states[:, first : first + beam.size].reshape(len(states), -1, 4, 3)
        cosines = node_traces(beam.by_element(nodes)).reshape(len(states), -1).min(axis=1)
        sample = int(np.argmin(cosines))
        angle = float(np.degrees(np.arccos(np.clip(cosines[sample], -1.0, 1.0))))
        if angle > 90.0:
            findings.append(turn_finding(beam, angle, float(times[sample])))
    return tuple(findings)


def turn_finding(beam: Beam, angle: float, time: float) -> Finding:
    """The finding on a beam with an angle in degrees at a time, s."""
    values = {"body": beam.name, "angle": angle, "time": time, "elements": beam.elements}
    message = (
        f"A node of beam {beam.name!r} turns by {angle:.3g} degrees against the middle of its element at {time:.4g} s. "
        "The element is not accurate there, and it fails at 180 degrees."
    )
    return Finding("beam-turn", "warning", values, message, "Use more elements.")
