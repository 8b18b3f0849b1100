"""Truncation error: the change of a motion with more harmonics."""

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from dalembert.findings import Finding
from dalembert.vibration.balance.condensation import norm
from dalembert.vibration.balance.equations import Equations
from dalembert.vibration.balance.fourier import Fourier, in_orders
from dalembert.vibration.balance.newton import Solution
from dalembert.vibration.laws.contacts import RIGID_KINDS
from dalembert.vibration.system.lowering import ELASTIC, Lowered

_, VELOCITY = RIGID_KINDS
SLOW = 2.5
"""Error over the change by twice the harmonics: about 2 where forces jump, so that it falls with 1/harmonics."""
LARGE = 5e-3
"""Error of the largest motion, as part of it, that is a finding."""
PHASES = 1024


def truncation_findings(problem: Equations, solution: Solution) -> Iterator[Finding]:
    """Yield a finding where twice the harmonics change the motion of the retained coordinates at a solution.

    Rigid contacts on coordinates with mass need the most harmonics, because their forces jump where motion stops.
    """
    error = float(problem.once("truncation", solution, lambda: np.array([_error(problem, solution)]))[0])
    if error <= LARGE:
        return
    frequency, harmonics = float(solution.omega) / (2 * np.pi), problem.method.harmonics
    heavy = any(_heavy(problem, solution.omega))
    if np.isnan(error):
        yield Finding(
            "unchecked-harmonics",
            "error" if heavy else "warning",
            {"frequency": frequency, "harmonics": harmonics},
            f"Whether {harmonics} harmonics resolve the motion at {frequency:.6g} Hz is not known: with "
            f"{2 * harmonics + 1} harmonics it was not found.",
            "Try another number of harmonics, or compare the curve with integration in time.",
        )
        return
    yield Finding(
        "few-harmonics",
        "error" if heavy else "warning",
        {"frequency": frequency, "harmonics": harmonics, "error": error},
        f"{harmonics} harmonics do not resolve the motion at {frequency:.6g} Hz: its error is about "
        f"{100 * error:.2g} %, by the change with {2 * harmonics + 1} harmonics.",
        "Keep more harmonics. "
        + (
            "The force of a rigid contact with mass jumps, so that the error falls slowly; an elastic law falls faster."
            if heavy
            else "Compare the curve with integration in time."
        ),
    )


def _error(problem: Equations, solution: Solution) -> float:
    """Return the relative error of the peak of the coordinate that moves most; NaN if no finer motion is converged."""
    method = problem.method.refined()
    if method is None or not problem.nonlinear:
        return 0.0
    finer = Equations(_robust(problem, solution.omega), method)
    samples = max(method.first_samples, solution.samples)
    begin = in_orders(solution.unknowns, problem.method.orders, method.orders)
    better = finer.solve(begin, solution.omega, samples)
    if not better.converged:
        better = finer.first(solution.omega)
    if not better.converged:
        return np.nan
    own, other = (
        np.ptp(Fourier(orders, PHASES).synthesis @ unknowns.T, axis=0) / 2
        for orders, unknowns in ((problem.method.orders, solution.unknowns), (method.orders, better.unknowns))
    )
    most = int(np.argmax(other))
    return SLOW * abs(own[most] - other[most]) / (other[most] or 1.0)


def _heavy(problem: Equations, omega: float) -> tuple[bool, ...]:
    """Whether the rigid contacts of each block carry mass.

    They do if the highest harmonic meets more inertia than stiffness, with everything else held.
    """
    lowered, (stiffness, mass, *_) = problem.lowered, problem.condensation.outer
    inertia = np.diag(mass) * (problem.method.harmonics * omega) ** 2
    place = {row: number for number, row in enumerate(lowered.coordinates.rows.tolist())}
    rows = [[place[row] for row in block.rows.ravel().tolist() if row in place] for block in lowered.blocks]
    return tuple(
        block.kind != ELASTIC and bool(np.any(inertia[own] > np.diag(stiffness)[own]))
        for block, own in zip(lowered.blocks, rows, strict=True)
    )


def _robust(problem: Equations, omega: float) -> Lowered:
    """The elements with rigid contacts of the velocity kind where these carry mass: it converges faster there."""
    blocks = tuple(
        replace(block, kind=VELOCITY) if heavy and block.memory else block
        for block, heavy in zip(problem.lowered.blocks, _heavy(problem, omega), strict=True)
    )
    return replace(problem.lowered, blocks=blocks)


def largest(best: Solution | None, solution: Solution) -> Solution | None:
    """The solution with the larger motion; None before one was found."""
    if not solution.converged or (best is not None and norm(best.unknowns) >= norm(solution.unknowns)):
        return best
    return solution
