"""Small posteriors that provoke the sentences and figures of their reports."""

from dataclasses import replace
from functools import cache
from typing import Any

import numpy as np

from dalembert.forward import PythonModel
from dalembert.inverse import Posterior, identify, profile, sample
from dalembert.parameter import Parameter
from dalembert.priors import Normal
from posterior_models import DECAY, DECAYED, TIMES, line, measured
from report_case import Case

SHORT: dict[str, Any] = {"chains": 2, "draws": 60, "warmup": 50, "start": [1.2, 0.3]}


@cache
def _posterior() -> Posterior:
    return sample(DECAY, DECAYED, chains=2, draws=500, warmup=100, start=[2.0, 1.0])


def _with_profiles() -> tuple[Posterior, dict[str, Any]]:
    return _posterior(), {"profiles": profile(DECAY, DECAYED, identify(DECAY, DECAYED))}


def _apart() -> Posterior:
    """Chains of which one is elsewhere; some of its draws are divergent."""
    found = _posterior()
    diverging = np.zeros(found.draws.shape[:2], dtype=bool)
    diverging[0, :5] = True
    return replace(found, r_hat=np.array([1.5, 1.0]), statistics={**found.statistics, "diverging": diverging})


def _alone() -> Posterior:
    model = PythonModel(lambda a: a * TIMES, {"a": (0.0, 3.0)}, ["x"], TIMES)
    return sample(model, measured(b=0.0), start=[1.2], chains=1, draws=10, warmup=20)


def _ghost() -> Posterior:
    box = {"a": (0.0, 3.0), "ghost": Parameter("ghost", -5.0, 5.0, prior=Normal(1.0, 0.5))}
    model = PythonModel(lambda a, ghost: a * TIMES + 0 * ghost, box, ["x"], TIMES)
    return sample(model, measured(b=0.0), **{**SHORT, "start": [1.2, 1.0], "draws": 100})


def _mirrored() -> Posterior:
    model = PythonModel(lambda a: a * a * TIMES, {"a": (-3.0, 3.0)}, ["x"], TIMES)
    return sample(model, measured(b=0.0), chains=2, draws=30, warmup=30, start=[1.1])


POSTERIOR_CASES = {
    "a posterior with profiles": Case(
        _with_profiles,
        (
            "2 chains of 500 draws converged: R-hat is at most",
            "The solid line is the profile likelihood, scaled to the same area.",
            "Chains that have converged overlap and do not drift.",
            "The band contains a new measurement with 95 %.",
        ),
        ("marginal-1", "marginal-2", "pairs", "trace-1", "trace-2", "predictive-1", "profile-1"),
    ),
    "chains that differ": Case(_apart, ("The chains have not converged: R-hat of 'rate' is up to 1.500",), ("pairs",)),
    "modes that no chain connects": Case(_mirrored, ("The posterior has 2 modes that no chain connects: a = ",)),
    "one short chain": Case(_alone, ("There are too few draws", "There is one chain, so that nothing shows")),
    "a prior that excludes the data": Case(
        lambda: sample(line(a=Normal(-1.0, 0.2)), measured(), **SHORT),
        ("The prior of 'a' excludes what the data show: they are 10.7 standard deviations apart.",),
    ),
    "a prior that alone decides": Case(_ghost, ("The data add nothing to the prior of 'ghost'",)),
    "a posterior at a bound": Case(
        lambda: sample(line(bounds=(-5.0, 1.1)), measured(), **{**SHORT, "start": [1.0, 0.3]}),
        ("of the draws of 'a' are at its upper bound 1.1.",),
    ),
}
