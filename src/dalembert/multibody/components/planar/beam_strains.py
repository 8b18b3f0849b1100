"""Findings on beams whose stretch is so large that Green's strain differs from the engineering strain.

Saint-Venant and Kirchhoff's law takes Green's strain E = (lambda^2 - 1)/2 of the stretch lambda, not lambda - 1. The
force of a bar that can contract is then E A lambda (lambda^2 - 1)/2 = E A (e + 3/2 e^2 + 1/2 e^3) with e = lambda - 1,
instead of Hooke's E A e.
"""

from typing import TYPE_CHECKING

import numpy as np

from dalembert.findings import Finding
from dalembert.multibody.components.planar.slenderness import NOTE, WARNING

if TYPE_CHECKING:
    from dalembert.multibody.components.planar.ancf_beam import AncfBeam


def strain_findings(beam: "AncfBeam", times: np.ndarray, states: np.ndarray) -> tuple[Finding, ...]:
    """Return a finding on a beam whose axial force differs by 1 % or more from Hooke's.

    ``times`` (samples,): s; ``states`` (samples, size): coordinates of the beam.
    """
    strains = axial_strains(beam, states)
    errors = np.abs(1.5 * strains + 0.5 * strains**2)
    sample, element = np.unravel_index(int(np.argmax(errors)), errors.shape)
    error, strain = float(errors[sample, element]), float(strains[sample, element])
    if not error >= NOTE:
        return ()
    values = {
        "body": beam.name, "strain": strain, "time": float(times[sample]), "element": int(element) + 1,
        "force_error": 1.5 * strain + 0.5 * strain**2,
    }  # fmt: skip
    side = "higher" if strain > 0 else "lower"
    message = (
        f"Beam {beam.name!r} has an axial strain of {100 * strain:.2g} % at {times[sample]:.4g} s. With Green's "
        f"strain, its axial force is {100 * error:.2g} % {side} there than by Hooke's law."
    )
    advice = "Use AncfCable, which has Hooke's law, unless the material follows Saint-Venant and Kirchhoff's law."
    return (Finding("beam-strain", "warning" if error > WARNING else "note", values, message, advice),)


def axial_strains(beam: "AncfBeam", coordinates: np.ndarray) -> np.ndarray:
    """Return the mean of |r_x| - 1 along each element, (samples, elements), by Simpson's rule.

    The mean leaves out the slopes of nodes, which vary within an element that bends.
    """
    nodes = coordinates.reshape(len(coordinates), beam.elements + 1, beam.vectors, 2)
    h = float(np.real(beam.length)) / beam.elements
    places, slopes = nodes[:, :, 0], nodes[:, :, 1]
    middle = 1.5 * np.diff(places, axis=1) / h - 0.25 * (slopes[:, 1:] + slopes[:, :-1])
    at_nodes, between = np.linalg.norm(slopes, axis=2), np.linalg.norm(middle, axis=2)
    return (at_nodes[:, :-1] + 4 * between + at_nodes[:, 1:]) / 6 - 1
