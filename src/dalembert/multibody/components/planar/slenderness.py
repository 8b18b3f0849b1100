"""Findings on flexible bars whose element does not suit their slenderness."""

import numpy as np

from dalembert.findings import Finding

BEND = np.deg2rad(10.0)  # of the whole bar, for which locking is stated
POISSON_RATIO = 0.3  # assumed where a component has none
NOTE, WARNING = 0.01, 0.05  # errors from which a finding is a note, and a warning


def continuum_findings(
    name: str, length: float, height: float, elements: int, stiffnesses: tuple[float, float, float]
) -> tuple[Finding, ...]:
    """Return what is too stiff in the bending of a beam in continuum formulation.

    Straight, with C11 and C12: by C11 / (C11 - C12^2 / C11), since the section cannot contract where it is stretched,
    over 1 - 1/(3 n^2) for n elements, the ratio of a cantilever's deflections under its weight. Bent by the angle phi
    over the length L: by x^2 / (10 + x) more, with x = phi L / (n^2 H), as the stretch of an element cannot vanish. The
    constant 10 is exact for small x; the rest is an estimate.
    """
    c11, c12, _ = stiffnesses
    contraction = c11 / (c11 - c12**2 / c11) - 1
    straight = (1 + contraction) / (1 - 1 / (3 * elements**2)) - 1
    x = BEND * length / (elements**2 * height)
    locking = x**2 / (10 + x)
    bent = (1 + straight) * (1 + locking) - 1
    if bent < NOTE:
        return ()
    values = {
        "body": name, "length_by_height": length / height, "elements": elements, "contraction": contraction,
        "straight": straight, "locking": locking, "bent": bent,
    }  # fmt: skip
    message = (
        f"Beam {name!r} has the continuum formulation. Its bending stiffness is about {_percent(straight)} too high "
        "while it is straight."
    )
    if locking > NOTE:
        message += f" Its thin elements lock: after a bend of 10 degrees the stiffness is {_percent(bent)} too high."
    advice = 'Use formulation "structural", unless you repeat published results.'
    return (Finding("beam-locking", "warning" if locking > WARNING else "note", values, message, advice),)


def cable_findings(name: str, length: float, height: float) -> tuple[Finding, ...]:
    """Return by how much a cable is too stiff, as it has neither shear nor inertia of its sections.

    The first bending frequency of Timoshenko's beam between pins is lower by
    sqrt(1 + (pi H / L)^2 / 12 (1 + E / (k G))), with E / (k G) = (12 + 11 nu) / 5.
    """
    ratio = (12 + 11 * POISSON_RATIO) / 5
    error = float(np.sqrt(1 + (np.pi * height / length) ** 2 / 12 * (1 + ratio)) - 1)
    if error < NOTE:
        return ()
    values = {"body": name, "length_by_height": length / height, "frequency_error": error}
    message = (
        f"Cable {name!r} is thick: its length is {length / height:.3g} times its height. It has no shear, and its "
        f"first bending frequency between pins is about {_percent(error)} too high."
    )
    return (Finding("cable-shear", "warning" if error > WARNING else "note", values, message, "Use AncfBeam."),)


def _percent(part: float) -> str:
    return f"{100 * part:.2g} %" if part < 1 else "more than 100 %"
