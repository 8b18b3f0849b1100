"""Global minimisers of a batch misfit over a box at one price, PARTICLES × ITERATIONS evaluations: ours and others."""

import warnings
from collections.abc import Callable

import cma
import numpy as np
from pymoo.algorithms.soo.nonconvex.pso import PSO
from pymoo.core.problem import Problem
from pymoo.optimize import minimize
from scipy.optimize import differential_evolution

import dalembert as da

PARTICLES, ITERATIONS = 40, 100
PRICE = PARTICLES * ITERATIONS

Misfit = Callable[[np.ndarray], np.ndarray]
Method = Callable[[Misfit, np.ndarray, np.ndarray, int], float]


def swarm(settings) -> Method:
    """A swarm of ours."""

    def run(misfit: Misfit, lower: np.ndarray, upper: np.ndarray, seed: int) -> float:
        return settings.minimise(misfit, lower, upper, seed).misfit

    return run


def pymoo_swarm(misfit: Misfit, lower: np.ndarray, upper: np.ndarray, seed: int) -> float:
    """pymoo's adaptive particle swarm as it comes."""

    class Posed(Problem):
        def __init__(self) -> None:
            super().__init__(n_var=len(lower), n_obj=1, xl=lower, xu=upper)

        def _evaluate(self, x, out, *args, **kwargs) -> None:
            out["F"] = misfit(x)[:, None]

    return float(minimize(Posed(), PSO(pop_size=PARTICLES), ("n_eval", PRICE), seed=seed).F[0])


def covariance(misfit: Misfit, lower: np.ndarray, upper: np.ndarray, seed: int) -> float:
    """CMA-ES from random points, begun anew where it has converged until the evaluations are spent."""
    rng, spent, best = np.random.default_rng(seed), 0, np.inf
    while spent < PRICE:
        options = {"bounds": [0, 1], "seed": int(rng.integers(1, 2**31)), "verbose": -9, "tolfun": 1e-30}
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            strategy = cma.CMAEvolutionStrategy(rng.random(len(lower)), 0.3, options)
            while spent < PRICE and not strategy.stop():
                points = strategy.ask()
                values = misfit(lower + (upper - lower) * np.array(points))
                strategy.tell(points, values.tolist())
                spent, best = spent + len(points), min(best, float(np.min(values)))
    return best


def evolution(misfit: Misfit, lower: np.ndarray, upper: np.ndarray, seed: int) -> float:
    """SciPy's differential evolution, as many members as particles, unpolished."""
    members = max(5, PARTICLES // len(lower)) * len(lower)
    found = differential_evolution(
        lambda x: misfit(x.T) if x.ndim == 2 else float(misfit(x[None])[0]),
        list(zip(lower, upper, strict=True)),
        maxiter=PRICE // members - 1,
        popsize=members // len(lower),
        tol=0,
        polish=False,
        updating="deferred",
        vectorized=True,
        rng=seed,
    )
    return float(found.fun)


METHODS: dict[str, Method] = {
    "IPSO as published": swarm(da.ImprovedParticleSwarm(PARTICLES, ITERATIONS)),
    "IPSO, limit of the width": swarm(da.ImprovedParticleSwarm(PARTICLES, ITERATIONS, span="width")),
    "SPSO, c 2, inertia 0.9-0.4": swarm(da.ParticleSwarm(PARTICLES, ITERATIONS)),
    "SPSO, c 1.494, inertia 0.729": swarm(
        da.ParticleSwarm(PARTICLES, ITERATIONS, inertia=0.729, c1=1.494, c2=1.494, velocity_limit=None)
    ),
    "SPSO, c 1, inertia 0.8-0.1": swarm(da.ParticleSwarm(PARTICLES, ITERATIONS, inertia=(0.8, 0.1), c1=1.0, c2=1.0)),
    "pymoo PSO": pymoo_swarm,
    "CMA-ES": covariance,
    "SciPy differential evolution": evolution,
}
