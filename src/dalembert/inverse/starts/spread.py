"""Points spread over the box of the parameters, for starts to be chosen from."""

import numpy as np
import scipy

from dalembert.inverse.problem.problem import MisfitProblem
from dalembert.latin_hypercube import latin_hypercube

SPREADS = ("latin-hypercube", "sobol")


def spread_points(problem: MisfitProblem, number: int, seed: int, spread: str) -> np.ndarray:
    """Search points (number, parameters) over the box: a Latin hypercube, or a scrambled sequence of Sobol's. Sobol's
    sequence is even in all parameters together where the hypercube is in each alone; it is whole where the number is a
    power of 2.
    """
    low, high = problem.search.lower, problem.search.upper
    rng = np.random.default_rng((seed, 1))
    if spread == "sobol":
        unit = scipy.stats.qmc.Sobol(len(low), rng=rng).random_base2(max(0, (number - 1).bit_length()))[:number]
    else:
        unit = latin_hypercube(len(low), number, rng)
    return low + (high - low) * unit
