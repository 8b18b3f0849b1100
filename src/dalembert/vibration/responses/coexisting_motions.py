"""All motions at a frequency that a path over the amplitude of the forces passes."""

from collections.abc import Iterator, Sequence

import numpy as np

from dalembert.arguments import takes_checked
from dalembert.errors import InputError
from dalembert.forward import Checkpoint
from dalembert.threads import single_thread
from dalembert.vibration.balance.arc_length import PathPoint, along, on_border
from dalembert.vibration.balance.equations import Equations, require_one_period
from dalembert.vibration.balance.first_guesses import Loading
from dalembert.vibration.balance.harmonic_balance import HarmonicBalance
from dalembert.vibration.balance.newton import Solution
from dalembert.vibration.interface.condensed_structure import norm
from dalembert.vibration.paths.curve import FrequencyCurve
from dalembert.vibration.responses.followed_curve import PosedCurve, conclude, follow
from dalembert.vibration.system.requirements import positive_numbers, require_forces, require_viscous
from dalembert.vibration.system.system import VibrationSystem

LEAST = 1e-3
"""Part of the forces from which the path begins, at which pressed contacts stick."""
SAME = 1e-5
"""Distance of two motions, as part of the larger one, that are the same."""


@takes_checked("frequencies")
@single_thread()
def coexisting_motions(
    system: VibrationSystem,
    frequencies: np.ndarray | Sequence[float],
    method: HarmonicBalance | None = None,
    *,
    most: float = 10.0,
    observe: Sequence[str] | None = None,
    stability: bool = False,
    checkpoint: Checkpoint | None = None,
) -> FrequencyCurve:
    """Return the motions at each frequency that a path over the amplitude of the forces passes.

    At each frequency the varying forces are scaled from almost none up to ``most`` times their value, by arc length.
    Motions at the value itself are kept, also those of an isolated branch, to which no curve from outside comes. From
    one of its motions, a curve by arc length is the whole of a closed one.

    Parameters
    ----------
    system : VibrationSystem
    frequencies : array, shape (frequencies,)
        Hz.
    method : HarmonicBalance, optional
        With a number of harmonics.
    most : float
        Largest factor of the forces. A path with a fold above it is not followed.
    observe, stability, checkpoint
        As of :func:`frequency_response`.

    Returns
    -------
    FrequencyCurve
        One point for each motion, in the order of the frequencies, then of the path; none where the path does not come
        to the value.

    Raises
    ------
    InputError
        For frequencies that are not positive, and ``most`` of 1 or less.

    Examples
    --------
    A hardening spring has three motions beside its resonance, of which one is unstable:

    >>> import dalembert as da
    >>> system = da.VibrationSystem(da.lumped({"m": 1.0}, [("m", None, 1.0, 0.05)]))
    >>> force, spring = system.add(da.HarmonicForce("m", 0.18)), system.add(da.CubicSpring("k3", "m", stiffness=0.1))
    >>> motions = coexisting_motions(system, [0.19], da.HarmonicBalance(3), stability=True)
    >>> motions.amplitude("m").round(2).tolist(), motions.stable.tolist()
    ([0.43, 2.23, 2.51], [1, 0, 1])
    """
    places = positive_numbers(np.atleast_1d(frequencies).tolist(), "coexisting_motions", "frequencies", "Hz")
    method = method or HarmonicBalance()
    require_one_period(method, "coexisting_motions")
    require_forces(system.forces, places, "coexisting_motions")
    if not np.isfinite(most) or most <= 1:
        raise InputError(f"coexisting_motions: most is {most}; expected a factor above 1, such as 10")
    if method.automatic:
        raise InputError('coexisting_motions: harmonics is "auto"; expected a number')
    if stability:
        require_viscous(system.structure, "stability and Floquet multipliers")
    settings = {"continuation": "force", "frequencies": "given", "most": float(most)}
    posed = PosedCurve(system, 2 * np.pi * places, False, settings, observe, None, stability, checkpoint, None)
    problem = posed.equations(posed.solved(method))
    points = (
        # Motions side by side are no neighbours on a path: none of them is a bifurcation of another.
        PathPoint(solution, returned=True)
        for omega in posed.omegas
        for solution in _passed(problem, float(omega), float(most))
    )
    return conclude(posed, follow(posed, problem, None, stability, check=False, points=points))


def _passed(problem: Equations, omega: float, most: float) -> Iterator[Solution]:
    """Yield the different motions at which the path over the force passes its value."""
    known: list[Solution] = []
    samples = problem.method.first_samples
    loading = Loading(problem.balance(samples), problem.method, problem.at(omega))
    before: Solution | None = None
    # A path may turn back behind its first point, through none of the force even, before it comes to all of it.
    for point in along(loading, -most, most, loading.first(LEAST)):
        solution = point.solution  # its ω is the factor of the forces
        if not solution.converged:
            return
        if before is not None and (before.omega - 1) * (solution.omega - 1) <= 0:
            guess, _ = on_border(before, solution, 1.0)
            motion = problem.solve(guess, omega, samples)
            size = SAME * norm(motion.unknowns)
            if motion.converged and all(norm(motion.unknowns - other.unknowns) > size for other in known):
                known.append(motion)
                yield motion
        before = solution
