"""Findings on bushings in space that turn by more than half a turn, where their law ends."""

from collections.abc import Mapping

import numpy as np

from dalembert.findings import Finding
from dalembert.multibody.model.system import BaseSystem


def turning_bushings(system: BaseSystem) -> dict[str, tuple[str, ...]]:
    """Return the channels of the rotation vectors that torques of loads depend on, by the names of the loads."""
    return {load.name: load.rotation_vector for load in system.loads if load.rotation_vector}


def half_turns(times: np.ndarray, rotations: Mapping[str, np.ndarray]) -> tuple[Finding, ...]:
    """Return a finding for each bushing that passes half a turn. ``times`` (samples,): s; ``rotations`` (samples, 3):
    rotation vector of each bushing, rad, which jumps by almost 2 pi where its length passes pi.
    """
    findings = []
    for name, vectors in rotations.items():
        jumps = np.flatnonzero(np.linalg.norm(np.diff(vectors, axis=0), axis=1) > np.pi)
        if len(jumps):
            time = float(times[jumps[0] + 1])
            findings.append(
                Finding(
                    "bushing-half-turn",
                    "warning",
                    {"bushing": name, "time": time},
                    f"Bushing {name!r} passes half a turn at {time:.4g} s. Its law ends there: the torque changes its "
                    "sign.",
                    "For larger rotations, use a joint with a TorsionSpring, which counts whole turns.",
                )
            )
    return tuple(findings)
