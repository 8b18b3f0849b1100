"""Branches that a curve does not pass, from motions that a path over the amplitude of the forces finds."""

from collections.abc import Sequence

import numpy as np

from dalembert.arguments import takes_checked
from dalembert.errors import InputError
from dalembert.forward import Checkpoint
from dalembert.threads import single_thread
from dalembert.vibration.balance.arc_length import CLOSED
from dalembert.vibration.balance.equations import Equations, equations
from dalembert.vibration.balance.harmonic_balance import HarmonicBalance
from dalembert.vibration.interface.condensed_structure import norm
from dalembert.vibration.paths.curve import FrequencyCurve
from dalembert.vibration.paths.curve_points import require_full_load
from dalembert.vibration.responses.coexisting_motions import SAME, coexisting_motions
from dalembert.vibration.responses.followed_curve import ARC_LENGTH
from dalembert.vibration.responses.frequency_response import frequency_response
from dalembert.vibration.system.requirements import positive_numbers
from dalembert.vibration.system.system import VibrationSystem


@takes_checked("frequencies")
@single_thread()
def isolated_branches(
    system: VibrationSystem,
    curve: FrequencyCurve,
    frequencies: np.ndarray | Sequence[float],
    *,
    most: float = 10.0,
    stability: bool = False,
    checkpoint: Checkpoint | None = None,
) -> tuple[FrequencyCurve, ...]:
    """Return the branches that pass motions at some frequencies and are no part of a curve.

    Motions are those of :func:`coexisting_motions`. From each that neither the curve nor a branch before passes, the
    branch is followed by arc length. An isolated one is closed; one that leaves the range has two parts, from the
    motion to each side.

    Parameters
    ----------
    system : VibrationSystem
        That of the curve.
    curve : FrequencyCurve
        Of which the branches have the harmonics, the range of frequencies and the observed degrees of freedom.
    frequencies : array, shape (frequencies,)
        Hz, in the range of the curve.
    most, checkpoint
        As of :func:`coexisting_motions`.
    stability : bool
        Whether that of the points of the branches is found.

    Raises
    ------
    InputError
        As of :func:`coexisting_motions`, for frequencies outside the range of the curve, and for a curve of a held
        amplitude or of one frequency.

    Examples
    --------
    >>> import dalembert as da
    >>> def damper(u, v, z, numbers, force):
    ...     force[0] = -0.1 * v[0] ** 3 + 0.03 * v[0] ** 5
    >>> system = da.VibrationSystem(da.lumped({"m": 1.0}, [("m", None, 1.0, 0.1)]))
    >>> force, law = system.add(da.HarmonicForce("m", 0.0375)), system.add(da.UserLaw("d", "m", function=damper))
    >>> curve = da.frequency_response(system, (0.12, 0.2), da.HarmonicBalance(1))
    >>> (branch,) = isolated_branches(system, curve, [0.159])
    >>> branch.findings[0].values["reason"], float(branch.amplitude("m").max().round(2))
    ('closed', 1.47)
    """
    require_full_load(curve, "isolated_branches")
    method = HarmonicBalance(**curve.provenance["method"])
    options = {"observe": curve.dofs, "stability": stability, "checkpoint": checkpoint}
    window = float(np.nanmin(curve.frequencies)), float(np.nanmax(curve.frequencies))
    places = positive_numbers(np.atleast_1d(frequencies).tolist(), "isolated_branches", "frequencies", "Hz")
    if places.min() < window[0] or places.max() > window[1] or window[0] == window[1]:
        raise InputError(
            f"isolated_branches: the frequencies reach from {places.min():.6g} to {places.max():.6g} Hz, and the curve "
            f"from {window[0]:.6g} to {window[1]:.6g} Hz. Use frequencies inside a curve between two frequencies"
        )
    motions = coexisting_motions(system, frequencies, method, most=most, observe=curve.dofs, checkpoint=checkpoint)
    problem = equations(system, method, checkpoint, highest=2 * np.pi * window[1] / method.periods)
    branches: list[FrequencyCurve] = []
    for point in range(len(motions)):
        if any(_passes(problem, known, motions, point) for known in (curve, *branches)):
            continue
        for ends in (window, (window[1], window[0])):
            start = motions, point
            branch = frequency_response(
                system, ends, method, continuation=ARC_LENGTH, start=start, check=False, **options
            )
            branches.append(branch)
            if any(finding.values.get("reason") == CLOSED for finding in branch.findings):
                break
    return tuple(branches)


def _passes(problem: Equations, curve: FrequencyCurve, motions: FrequencyCurve, point: int) -> bool:
    """Whether a curve passes a motion at its frequency."""
    place, motion = motions.frequencies[point], motions.unknowns[point]
    ahead = curve.frequencies - place
    for first in np.flatnonzero((ahead[:-1] * ahead[1:] <= 0) & curve.converged[:-1] & curve.converged[1:]):
        span = curve.frequencies[first + 1] - curve.frequencies[first]
        part = -ahead[first] / span if span else 0.0
        guess = curve.unknowns[first] + part * (curve.unknowns[first + 1] - curve.unknowns[first])
        solution = problem.solve(guess, problem.omega(place), int(motions.samples[point]))
        if solution.converged and norm(solution.unknowns - motion) <= SAME * norm(motion):
            return True
    return False
