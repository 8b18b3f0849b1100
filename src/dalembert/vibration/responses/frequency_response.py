"""The response of a vibrating system over frequency."""

from collections.abc import Sequence
from dataclasses import asdict, replace

import numpy as np

from dalembert.arguments import takes_checked
from dalembert.errors import InputError, require_known
from dalembert.forward import Checkpoint
from dalembert.threads import single_thread
from dalembert.vibration.balance.equations import require_one_period
from dalembert.vibration.balance.harmonic_balance import HarmonicBalance
from dalembert.vibration.balance.truncation import (
    RELIABLE,
    ForcedLevel,
    choice_findings,
    enough_harmonics,
    hardest,
)
from dalembert.vibration.paths.curve import FrequencyCurve
from dalembert.vibration.paths.curve_points import restarted
from dalembert.vibration.responses.control import HeldAmplitude
from dalembert.vibration.responses.followed_curve import (
    ARC_LENGTH,
    NATURAL,
    OnPoint,
    PosedCurve,
    conclude,
    follow,
)
from dalembert.vibration.system.requirements import positive_numbers, require_forces, require_viscous
from dalembert.vibration.system.system import VibrationSystem


@takes_checked("frequencies", "continuation", "observe")
@single_thread()
def frequency_response(
    system: VibrationSystem,
    frequencies: np.ndarray | tuple[float, float],
    method: HarmonicBalance | None = None,
    *,
    continuation: str = NATURAL,
    observe: Sequence[str] | None = None,
    start: tuple[FrequencyCurve, int] | None = None,
    stability: bool = False,
    control: HeldAmplitude | None = None,
    check: bool = True,
    checkpoint: Checkpoint | None = None,
    on_point: OnPoint | None = None,
) -> FrequencyCurve:
    """Return the periodic responses over frequency by harmonic balance.

    Parameters
    ----------
    system : VibrationSystem
    frequencies : array, shape (points,), or pair of float
        Hz, positive. A tuple of two: points between them, as dense as the curve needs.
    method : HarmonicBalance, optional
        With ``harmonics="auto"`` the curve is followed with more and more harmonics, until the truncation errors of its
        largest motion and of the three with the largest last harmonics are small. Motions below a tenth of the largest
        count with an error as part of that tenth.
    continuation : {"natural", "arc-length"}
        From a frequency to the next, or along the curve past its folds, which needs (begin, end).
    observe : sequence of str, optional
        Degrees of freedom, nodes or sets of nodes whose motion is kept; all of a small structure, and of a large one
        those with forces and contacts, if not given.
    start : (FrequencyCurve, int), optional
        A curve of the same system and the number of one of its points, from which to continue. Its harmonics are among
        those of ``method``.
    stability : bool
        Whether the stability of each point is found too, and the places where it changes: by Hill's method, or with
        friction or receptances by the linearised motion over a period (see :func:`floquet_multipliers`). On paths
        between two frequencies these places are separate points; with given frequencies the first one behind is marked.
    control : HeldAmplitude, optional
        An amplitude that is held by a factor of the varying forces, in the ``load_factors`` of the curve. Such a curve
        is not checked with twice the harmonics.
    check : bool
        Whether the largest motion is computed again with twice the harmonics. A change is the finding
        ``"few-harmonics"``.
    checkpoint : Checkpoint, optional
        File in which solutions are stored as they are found. A run that was interrupted and is started again with the
        same file reads them, and its results are equal to the bits.
    on_point : callable, optional
        Called with each point, a :class:`FollowedPoint`, as it is found.

    Returns
    -------
    FrequencyCurve
        A point that Newton's method does not find, from the point before, by halves of the step or from the point
        behind, is marked there and the curve continues.

    Raises
    ------
    InputError
        For frequencies that are not positive, unknown degrees of freedom, a start that does not fit, and stability of
        a structure that is too large for dense matrices, has hysteretic damping, or where several degrees of freedom
        share one mass. For a held amplitude together with stability, arc length, a start or ``harmonics="auto"``.
    ModelError
        For rigid contacts that depend on each other, and for mean forces along a motion that nothing holds.

    Examples
    --------
    >>> import numpy as np
    >>> from dalembert.structure import lumped
    >>> from dalembert.vibration import ElasticSlider, FrictionContact, HarmonicForce, VibrationSystem
    >>> system = VibrationSystem(lumped({"m": 1.0}, [("m", None, 1.0, 0.04)]))
    >>> force = system.add(HarmonicForce("m", 1.0))
    >>> law = ElasticSlider(tangential_stiffness=0.8)
    >>> damper = system.add(FrictionContact("damper", "m", friction=0.5, preload=2.0, law=law))
    >>> curve = frequency_response(system, np.array([1.12]) / (2 * np.pi), HarmonicBalance(harmonics=5))
    >>> curve.amplitude("m").round(3).tolist()
    [3.625]
    """
    is_path = isinstance(frequencies, tuple)
    places = positive_numbers(frequencies, "frequency_response", "frequencies", "Hz")
    require_forces(system.forces, places, "frequency_response")
    require_known("continuation", continuation, (NATURAL, ARC_LENGTH), "frequency_response")
    if continuation == ARC_LENGTH and not is_path:
        raise InputError(
            "frequency_response: a path by arc length finds its own frequencies; give a tuple of two, (begin, end)"
        )
    if stability:
        require_viscous(system.structure, "stability and Floquet multipliers")
    settings = {"continuation": continuation, "frequencies": list(map(float, frequencies)) if is_path else "given"}
    method = method or HarmonicBalance()
    omegas = 2 * np.pi * places / method.periods
    if control is not None:
        refused = {
            "continuation='arc-length'": continuation == ARC_LENGTH,
            "a start": start is not None,
            "stability=True": stability,
            "harmonics='auto'": method.automatic,
        }
        for what in (what for what, present in refused.items() if present):
            raise InputError(f"frequency_response: a held amplitude was asked for with {what}. Leave one of them out")
        settings["control"] = asdict(control)
        require_one_period(method, "frequency_response with a held amplitude")
        check = False
    posed = PosedCurve(system, omegas, is_path, settings, observe, start, stability, checkpoint, on_point, control)
    method = posed.solved(method)
    if method.automatic:
        return _refine(posed, method)
    return conclude(posed, follow(posed, posed.equations(method), start, stability, check))


def _refine(posed: PosedCurve, method: HarmonicBalance) -> FrequencyCurve:
    """Return the curve with enough harmonics for small truncation errors, starting from few."""
    start = posed.start
    level = method.keeping(posed.system.highest_harmonic).at_least(1 if start is None else start[0].orders[-1]).first()
    begin = start
    while True:
        problem = posed.equations(level)
        curve = conclude(posed, follow(posed, problem, begin, stability=False, check=False))
        points = hardest(curve.unknowns, curve.converged)
        solutions = [restarted(problem, curve, point, "frequency_response") for point in points]
        motions = [solution for solution in solutions if solution.converged]
        better, error = enough_harmonics(ForcedLevel.of(problem, motions), motions)
        if better.highest == level.highest:
            # With few harmonics a motion that is not converged may be one that more harmonics have.
            more = None if curve.converged.all() or level.highest >= RELIABLE else level.next()
            if more is None:
                break
            better = more
        level = better
        begin = (curve, 0) if start is None and curve.converged[0] else start
    if posed.stability:
        curve = conclude(posed, follow(posed, problem, begin, stability=True, check=False))
    return replace(curve, findings=(*curve.findings, *choice_findings(level, error)))
