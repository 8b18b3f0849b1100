"""Runs of more steps than anybody can wait for are refused before they begin."""

from dataclasses import replace
from typing import Any, cast

import numpy as np

from dalembert.arguments import is_real
from dalembert.errors import InputError, SolveError, shown
from dalembert.multibody.integrators.shared.integrator import Integrator
from dalembert.multibody.integrators.shared.run import make_problem
from dalembert.multibody.model.lowered import Lowered

MOST_STEPS = 1e8
"""Fixed steps of a simulation, minutes to hours of computing."""
LONG = 1e6
"""End of a motion, s, from which an adaptive method is tried first; the trial takes at most 0.2 % of such a run."""
TRIAL = 2_000  # steps


def check_steps(owner: str, solver: Integrator, end: float, most: float = MOST_STEPS, advice: str = "") -> None:
    """Refuse more fixed steps than ``most``."""
    if not (is_real(most) and most > 0):
        raise InputError(f"{owner}: most_steps is {shown(most)}; expected a positive number")
    steps = 0.0 if solver.fixed_step is None else end / solver.fixed_step
    if steps > most:
        raise InputError(
            f"{owner}: {solver} until {end:g} s takes {steps:.3g} steps; expected at most {most:g}, which take hours. "
            f"Use larger steps or a shorter motion{advice}"
        )


def works(lowered: Lowered) -> bool:
    """Whether loads, losses or prescribed motions may do work."""
    return lowered.dissipates or any(kind.driven or kind.loads for kind in lowered.data)


def check_pace(lowered: Lowered, solver: Integrator, end: float) -> None:
    """Refuse a long motion that an adaptive method would end at its limit of steps, after a trial of few steps."""
    most = getattr(solver, "most_steps", 0)
    if end < LONG or most <= TRIAL or solver.fixed_step is not None or works(lowered):
        return
    short = cast(Integrator, replace(cast(Any, solver), most_steps=TRIAL))
    (run,) = short.integrate([lowered], (), make_problem(lowered, np.array([0.0, end])), end)
    reached = float(run.ends[-1]) if run.reason and len(run.ends) >= TRIAL else end
    steps = TRIAL * end / reached
    if steps > most:
        raise SolveError(
            f"{solver} took {TRIAL} steps until t = {reached:.4g} s. At this rate the motion until {end:g} s takes "
            f"{steps:.2g} steps, and most_steps is {most:g}. Simulate a shorter motion, or increase tolerance or "
            "most_steps"
        )
