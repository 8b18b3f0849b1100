"""Findings on reduced bodies in motions that their linear deformation does not describe."""

from typing import TYPE_CHECKING

import numpy as np

from dalembert.findings import Finding

if TYPE_CHECKING:
    from dalembert.multibody.components.spatial.reduced_body import ReducedBody

FASTEST = 0.1
"""Spin, as part of the lowest natural frequency of the body with a node clamped, above which stiffening counts. The
square of a clamped bar's frequency grows by 1.2 times that of the spin; the floating axes have 0.9 of it."""
LARGEST = 10.0
"""Rotation of an interface node against the body's axes, degrees: a bent bar is then shorter by about 0.5 %."""


def deformation_findings(
    body: "ReducedBody", times: np.ndarray, states: np.ndarray, rates: np.ndarray
) -> tuple[Finding, ...]:
    """Return findings on a reduced body that spins fast or bends far.

    ``times`` (samples,): s; ``states``, ``rates`` (samples, size): coordinates of the body and their velocities.
    """
    findings = []
    axes, turning = (body.moving_axes(array)[:, 1:] for array in (states, rates))
    spins = np.linalg.norm(0.5 * np.cross(axes, turning).sum(axis=1), axis=1)
    sample, slowest = int(np.argmax(spins)), 2 * np.pi * body.modes.clamped_frequency
    if spins[sample] > FASTEST * slowest:
        findings.append(_spin_finding(body, float(spins[sample]), slowest, float(times[sample])))
    turns = np.einsum("nra,sa->snr", body.modes.interface_shapes[:, 3:], states[:, -body.modes.count :])
    angles = np.degrees(np.linalg.norm(turns, axis=2))
    sample, node = np.unravel_index(int(np.argmax(angles)), angles.shape)
    if angles[sample, node] > LARGEST:
        findings.append(_bend_finding(body, int(node), float(angles[sample, node]), float(times[sample])))
    return tuple(findings)


def _spin_finding(body: "ReducedBody", spin: float, slowest: float, time: float) -> Finding:
    values = {"body": body.name, "spin": spin, "frequency": slowest, "time": time}
    message = (
        f"Reduced body {body.name!r} turns at {spin:.4g} rad/s at {time:.4g} s, {spin / slowest:.2g} of its lowest "
        f"natural frequency with a node clamped, {slowest:.4g} rad/s. Its centrifugal stiffening is not complete."
    )
    return Finding("reduced-spin", "warning", values, message, "Use a Beam, or several reduced bodies in a row.")


def _bend_finding(body: "ReducedBody", node: int, angle: float, time: float) -> Finding:
    name = body.modes.names[node]
    values = {"body": body.name, "node": name, "angle": angle, "time": time}
    message = (
        f"Node {name!r} of reduced body {body.name!r} turns by {angle:.3g} degrees against the axes of the body at "
        f"{time:.4g} s. The deformation of a reduced body is linear."
    )
    return Finding("reduced-bending", "warning", values, message, "Use a Beam, or several reduced bodies in a row.")
