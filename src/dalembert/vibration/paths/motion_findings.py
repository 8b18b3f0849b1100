"""Findings on the motions of a curve: contacts that no motion closes, and rotors that are unstable without contacts."""

import numpy as np
from scipy.linalg import LinAlgError

from dalembert.errors import listed
from dalembert.findings import Finding
from dalembert.structure.complex_modes import complex_modes
from dalembert.structure.eigenmodes import dense, real_part
from dalembert.vibration.interface.lowering import Lowered

NAMED = 4
"""Elements that a message names."""
LARGE = 200
"""Degrees of freedom above which the modes of a rotor are not computed."""


def open_findings(lowered: Lowered, forces: np.ndarray, states: np.ndarray) -> tuple[Finding, ...]:
    """Return the finding on stops and contacts that no motion closes. ``forces`` (points, coordinates, coefficients),
    ``states`` (points, contacts, phases): of the converged points.
    """
    if not len(forces):
        return ()
    acting = np.any(forces, axis=(0, 2))
    names = [
        name
        for block in lowered.laws
        if block.element.switches
        for name, rows in zip(block.names, block.rows, strict=True)
        if not acting[rows].any()
    ]
    names += [name for name, seen in zip(lowered.contacts, np.any(states, axis=(0, 2)), strict=True) if not seen]
    if not names:
        return ()
    more = f" and {len(names) - NAMED} more" if len(names) > NAMED else ""
    message = f"No motion of the curve closes {listed([repr(name) for name in names[:NAMED]])}{more}."
    advice = "Check the gap and the preload, or use larger forces."
    return (Finding("never-closed", "warning", {"elements": tuple(names)}, message, advice),)


def rotor_findings(lowered: Lowered, omega: float) -> tuple[Finding, ...]:
    """Return the finding on a rotor that is unstable without its contacts and springs, at the highest frequency ω."""
    structure, speed = lowered.structure, lowered.spin(omega)[0]
    if not structure.rotates or not speed or structure.loss is not None or structure.size > LARGE:
        return ()
    damping = 0 * structure.stiffness if structure.damping is None else structure.damping
    # Ω (G ẋ + N x) belongs to damping and stiffness while the speed is constant.
    pairs = (structure.mass, None), (damping, structure.gyroscopic), (structure.stiffness, structure.circulatory)
    matrices = [
        dense(real_part(matrix)) + (0.0 if turning is None else speed * dense(real_part(turning)))
        for matrix, turning in pairs
    ]
    try:
        modes = complex_modes(*matrices)
    except (LinAlgError, np.linalg.LinAlgError):  # degrees of freedom without mass
        return ()
    if modes.growth <= 0:
        return ()
    growing = modes.roots[np.isclose(np.real(modes.roots), modes.growth, rtol=1e-9)]
    hertz = float(np.imag(growing[0])) / (2 * np.pi) if len(growing) else 0.0
    motion = f"a whirl of {hertz:.4g} Hz" if len(growing) else "a motion without oscillation"
    message = (
        f"At {speed:.6g} rad/s the rotor is unstable without its contacts and springs: {motion} grows by "
        f"{modes.growth:.3g} 1/s."
    )
    advice = "Add damping of the bearings, or lower the speed. With stability=True each point is judged."
    values = {"speed": float(speed), "frequency": hertz, "growth": modes.growth}
    return (Finding("unstable-rotor", "warning", values, message, advice),)
