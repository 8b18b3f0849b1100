"""Floquet multipliers of a point of a curve."""

from dataclasses import replace

import numpy as np

from dalembert.arguments import takes_checked
from dalembert.errors import InputError, require_known
from dalembert.threads import single_thread
from dalembert.vibration.balance.arc_length import MANY_ROWS
from dalembert.vibration.balance.equations import equations
from dalembert.vibration.balance.harmonic_balance import STIFFNESS, HarmonicBalance
from dalembert.vibration.interface.lowering import ELASTIC, lower
from dalembert.vibration.paths.curve import FrequencyCurve
from dalembert.vibration.paths.curve_points import require_full_load, restarted
from dalembert.vibration.stability.modal_map import MOST_ROWS
from dalembert.vibration.stability.stability import AUTO, HILL, TIME_MAP, exponents
from dalembert.vibration.system.system import VibrationSystem


@takes_checked("way")
@single_thread()
def floquet_multipliers(system: VibrationSystem, curve: FrequencyCurve, point: int, way: str = AUTO) -> np.ndarray:
    """Return the Floquet multipliers: the factors by which small perturbations of a periodic motion grow in a period.

    Parameters
    ----------
    system : VibrationSystem
        That of the curve.
    curve : FrequencyCurve
    point : int
    way : {"auto", "hill", "time map"}
        Hill's method in frequency, which has the accuracy of the harmonics (twice as many as the curve's where a stop
        is touched) but does not know the memory of sliders, or
        trapezoidal steps of the linearised motion over a period, whose error falls with their square. Automatic: Hill's
        method without contacts with friction, the linearised motion with such, and with ``solver="receptance"``.

    Returns
    -------
    array, shape (multipliers,), complex
        The largest first; the motion is stable where none is larger than 1 in magnitude.

    Raises
    ------
    InputError
        For another way, a curve of another system, a structure that is too large for dense matrices, more contacts that
        slip than the map by receptances takes, and, for the time map, degrees of freedom that only together with others
        have a mass.

    Examples
    --------
    >>> import numpy as np
    >>> from dalembert.structure import lumped
    >>> from dalembert.vibration import CubicSpring, HarmonicForce, VibrationSystem, frequency_response
    >>> system = VibrationSystem(lumped({"m": 1.0}, [("m", None, 1.0, 0.1)]))
    >>> force, spring = system.add(HarmonicForce("m", 0.1)), system.add(CubicSpring("cubic", "m", stiffness=0.1))
    >>> curve = frequency_response(system, np.array([0.15]))
    >>> factors = floquet_multipliers(system, curve, 0)
    >>> float(np.prod(factors).real.round(6)), float(np.exp(-0.1 / 0.15).round(6))  # exp(-c T/m), Liouville's formula
    (0.513417, 0.513417)
    """
    require_known("way", way, (AUTO, HILL, TIME_MAP), "floquet_multipliers")
    require_full_load(curve, "floquet_multipliers")
    method = HarmonicBalance(**curve.provenance["method"])
    if way == HILL or any(block.kind != ELASTIC for block in lower(system).blocks):
        method = replace(method, solver=STIFFNESS)
    problem = equations(system, method, stability=way != HILL)
    begin = restarted(problem, curve, point, "floquet_multipliers")
    known = exponents(problem, begin, way)
    if known.unjudged == MANY_ROWS:
        raise InputError(
            f"floquet_multipliers: more than {MOST_ROWS} displacements of contacts slip or open at this point. Use "
            "fewer contacts, or compare the motion with integration in time"
        )
    factors = np.exp(2 * np.pi * known.values)
    return factors[np.argsort(-np.abs(factors), kind="stable")]
