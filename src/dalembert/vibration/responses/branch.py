r"""The branch that leaves a curve at a branch point or a period doubling.

At such a point the Jacobian of the balance has a null vector φ: at a period doubling, that of motions with twice the
period. The other branch leaves along φ, and a plane across φ at some distance separates it from the curve.
"""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from dalembert.arguments import takes_checked
from dalembert.errors import InputError, SolveError, counted
from dalembert.threads import single_thread
from dalembert.vibration.balance.arc_length import direction_at
from dalembert.vibration.balance.equations import Equations, equations
from dalembert.vibration.balance.harmonic_balance import HarmonicBalance
from dalembert.vibration.balance.newton import CrossingPlane, Solution
from dalembert.vibration.balance.tangents import DenseTangent
from dalembert.vibration.fourier import in_orders
from dalembert.vibration.interface.condensed_structure import norm
from dalembert.vibration.paths.curve import FrequencyCurve
from dalembert.vibration.paths.curve_points import restarted
from dalembert.vibration.responses.followed_curve import ARC_LENGTH, BranchStart, PosedCurve, conclude, follow
from dalembert.vibration.stability.bifurcations import BRANCH, DOUBLING
from dalembert.vibration.system.requirements import positive_numbers
from dalembert.vibration.system.system import VibrationSystem

DISTANCES = (0.05, 0.02, 0.1, 0.2, 0.4)
"""Distances from the curve at which the other branch is sought, as parts of the motion."""
ABSENT, PRESENT = 1e-6, 1e-4
"""Coefficients that the curve lacks, as parts of its motion, and that the other branch has, as parts of φ."""
SINGULAR = 1e-2
"""Smallest singular value of the Jacobian, as part of the one before it, that is none at a bifurcation."""
INVERSE = 3
"""Steps of inverse iteration, each of which reduces the error of the null vector by that part."""


@takes_checked("observe")
@single_thread()
def follow_branch(
    system: VibrationSystem,
    curve: FrequencyCurve,
    number: int = 0,
    between: tuple[float, float] | None = None,
    *,
    observe: Sequence[str] | None = None,
    stability: bool = False,
    check: bool = True,
) -> FrequencyCurve:
    """Return the branch that leaves a curve at a branch point or a period doubling, by arc length.

    Parameters
    ----------
    system : VibrationSystem
        That of the curve.
    curve : FrequencyCurve
        With ``stability=True`` and arc length, so that it has markers.
    number : int
        Among the markers ``"branch point"`` and ``"period doubling"`` of the curve.
    between : pair of float, optional
        Hz, where the branch ends; those of the curve if not given.
    observe, stability, check
        As of :func:`frequency_response`.

    Returns
    -------
    FrequencyCurve
        From near the bifurcation on. Behind a period doubling the motion has twice the period: its harmonics and its
        phases are those of half the frequency, and ``frequencies`` stay those of the excitation. It ends where it
        comes back to the curve, with the finding ``"end-not-reached"`` and the reason ``"joined"``.

    Raises
    ------
    InputError
        For a curve without such a marker.
    SolveError
        Where no other branch is found.

    Examples
    --------
    An oscillator moves farther to one side than to the other, though nothing in it prefers a side:

    >>> import dalembert as da
    >>> system = da.VibrationSystem(da.lumped({"m": 1.0}, [("m", None, 1.0, 0.1)]))
    >>> force = system.add(da.HarmonicForce("m", 4.0))
    >>> spring = system.add(da.CubicSpring("k3", "m", stiffness=1.0))
    >>> method = da.HarmonicBalance(9)
    >>> curve = da.frequency_response(system, (0.12, 0.2), method, continuation="arc-length", stability=True)
    >>> [kind for kind, _ in curve.markers]
    ['branch point', 'branch point']
    >>> branch = follow_branch(system, curve)
    >>> float(abs(branch.harmonics("m")[:, 0]).max().round(1))  # the mean, which the symmetric motion lacks
    0.3
    """
    points = [(kind, point) for kind, point in curve.markers if kind in (BRANCH, DOUBLING)]
    if not 0 <= number < len(points):
        raise InputError(
            f"follow_branch: bifurcation {number} is asked for, and the curve has {counted(len(points), 'marker')} "
            f"{BRANCH!r} or {DOUBLING!r}. Follow it by arc length with stability=True, or choose another number"
        )
    kind, point = points[number]
    known = HarmonicBalance(**curve.provenance["method"])
    method = replace(known, odd_only=False, periods=known.periods * (2 if kind == DOUBLING else 1))
    problem, before = equations(system, method, stability=stability), equations(system, known)
    # The motion at the bifurcation, with the harmonics of the branch.
    ratio = method.periods // known.periods
    motion = restarted(before, curve, point, "follow_branch")
    unknowns = in_orders(motion.unknowns, tuple(ratio * order for order in known.orders), method.orders)
    samples = max(method.first_samples, ratio * motion.samples)
    start = _beside(problem, problem.solve(unknowns, motion.omega / ratio, samples))
    ends = between or (float(np.nanmin(curve.frequencies)), float(np.nanmax(curve.frequencies)))
    low, high = sorted(positive_numbers(tuple(ends), "follow_branch", "frequencies", "Hz").tolist())
    omegas = np.array([problem.omega(low), problem.omega(high)])
    settings = {"continuation": ARC_LENGTH, "frequencies": [low, high], "branch": kind}
    posed = PosedCurve(system, omegas, True, settings, observe, None, stability, None, None, branch=start)
    return conclude(posed, follow(posed, problem, None, stability, check))


def _beside(problem: Equations, at: Solution) -> BranchStart:
    """Return a motion on the other branch, and the direction away from the curve."""
    shape = _null_vector(at)
    size, width = norm(at.unknowns) or 1.0, 0.1 * at.omega
    if shape is not None:
        direction = np.append(shape.ravel(), 0.0)
        # What the curve lacks by its symmetry, or its shorter period: zero there, and moved by φ.
        broken = (np.abs(at.unknowns) < ABSENT * size) & (np.abs(shape) > PRESENT)
        for part in (sign * distance for distance in DISTANCES for sign in (1.0, -1.0)):
            guess = at.unknowns + part * size * shape
            # The plane is across φ: the curve crosses it at the bifurcation alone.
            plane = CrossingPlane(direction, guess, at.omega, size, width)
            solution = problem.solve(guess, at.omega, at.samples, plane)
            if solution.converged and solution.omega > 0:
                return BranchStart(solution, direction_at(solution, np.sign(part) * direction, width), broken)
    raise SolveError(
        f"follow_branch: no other branch is found at {problem.hertz(at.omega):.6g} Hz. Follow the curve with smaller "
        "steps (resolution), or with more harmonics"
    )


def _null_vector(at: Solution) -> np.ndarray | None:
    """The unit null vector φ of the Jacobian, (unknowns, coefficients); None where it has none, or several."""
    tangent = at.tangent
    if isinstance(tangent, DenseTangent):
        _, sizes, shapes = np.linalg.svd(tangent.matrix)
        alone = len(sizes) > 1 and sizes[-1] <= SINGULAR * sizes[-2]
        return shapes[-1].reshape(at.unknowns.shape) if alone else None
    # Inverse iteration on two vectors at once: one of them has to grow far more than the other.
    space = np.linalg.qr(np.random.default_rng(0).normal(size=(at.unknowns.size, 2)))[0]
    growth = np.zeros((2, 2))
    for _ in range(INVERSE):
        space, growth = np.linalg.qr(tangent.solve(space.reshape(*at.unknowns.shape, 2)).reshape(-1, 2))
    first, other = np.abs(np.diag(growth))
    return space[:, 0].reshape(at.unknowns.shape) if other <= SINGULAR * first else None
