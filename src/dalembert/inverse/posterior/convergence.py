"""Whether chains have converged: rank-normalised R-hat and effective sample sizes (ArviZ)."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from dalembert.errors import listed
from dalembert.findings import Finding
from dalembert.inverse.posterior.packages import package

LARGEST_R_HAT = 1.01
LEAST_DRAWS = 400  # effective sample size; both limits are those of Vehtari and others, Bayesian Analysis 16 (2021)
FEWEST = 4  # draws of a chain below which R-hat is not defined


@dataclass(frozen=True, eq=False)
class Convergence:
    """Diagnostics of each parameter, shape (parameters,) each."""

    # Rank-normalised split R-hat: 1 if all chains, and both halves of each, have the same distribution.
    r_hat: np.ndarray
    # bulk, tail: effective sample sizes for the centre, and for the 5 % and 95 % quantiles.
    bulk: np.ndarray
    tail: np.ndarray
    error: np.ndarray  # Monte Carlo standard error of the mean


def convergence(draws: np.ndarray) -> Convergence:
    """Return the diagnostics of draws (chains, draws, parameters), NaN for chains of fewer than four draws."""
    count = draws.shape[2]
    if draws.shape[1] < FEWEST:
        return Convergence(*np.full((4, count), np.nan))
    arviz = package("arviz", "sample")
    columns = [np.ascontiguousarray(draws[:, :, k]) for k in range(count)]
    # R-hat of a single chain compares its halves only; it is not shown as if chains agreed.
    several = len(draws) > 1
    return Convergence(
        np.array([float(arviz.rhat(column)) if several else np.nan for column in columns]),
        np.array([float(arviz.ess(column)) for column in columns]),
        np.array([float(arviz.ess(column, method="tail")) for column in columns]),
        np.array([np.std(column, ddof=1) / np.sqrt(float(arviz.ess(column, method="mean"))) for column in columns]),
    )


def ended(names: Sequence[str], convergence_of_draws: Convergence, chains: int, draws: int) -> Iterator[Finding]:
    """Yield how sampling ended, from the diagnostics of the parameters with these names."""
    apart = [k for k in range(len(names)) if convergence_of_draws.r_hat[k] > LARGEST_R_HAT]
    sizes = np.minimum(convergence_of_draws.bulk, convergence_of_draws.tail)
    few = [k for k in range(len(names)) if not sizes[k] >= LEAST_DRAWS]
    if apart:
        worst = max(apart, key=lambda k: convergence_of_draws.r_hat[k])
        yield Finding(
            "chains-differ",
            "error",
            {"parameters": ", ".join(names[k] for k in apart), "r_hat": float(convergence_of_draws.r_hat[worst])},
            f"The chains have not converged: R-hat of {listed([repr(names[k]) for k in apart])} is up to "
            f"{convergence_of_draws.r_hat[worst]:.3f}, above {LARGEST_R_HAT:g}.",
            "Increase warmup and draws. If R-hat stays large, the posterior has several maxima: narrow the bounds to "
            "one, or give priors.",
        )
    if few:
        worst = min(few, key=lambda k: np.nan_to_num(sizes[k]))
        least = float(np.nan_to_num(sizes[worst]))
        # Effective sizes grow in proportion to the draws.
        factor = LEAST_DRAWS / max(least, 1.0)
        yield Finding(
            "few-draws",
            "warning" if least >= LEAST_DRAWS / 4 else "error",
            {"parameters": ", ".join(names[k] for k in few), "effective": least, "draws": chains * draws},
            f"There are too few draws: the {chains * draws} draws of {listed([repr(names[k]) for k in few])} are worth "
            f"{least:.0f} independent ones, fewer than {LEAST_DRAWS}.",
            f"Increase draws, to about {_rounded(draws * factor)} for each chain.",
        )
    if chains < 2:
        yield Finding(
            "one-chain",
            "warning",
            {},
            "There is one chain, so that nothing shows whether it has reached the whole posterior.",
            "Use chains=4.",
        )
    if not apart and not few and chains > 1:
        values = {
            "r_hat": float(np.max(convergence_of_draws.r_hat)),
            "effective": float(np.min(sizes)),
            "draws": chains * draws,
        }
        message = (
            f"{chains} chains of {draws} draws converged: R-hat is at most {values['r_hat']:.3f}, and the effective "
            f"sample size at least {values['effective']:.0f}."
        )
        yield Finding("chains-converged", "note", values, message)


def _rounded(draws: float) -> int:
    """Two significant digits, rounded up."""
    unit = 10 ** max(0, int(np.floor(np.log10(draws))) - 1)
    return int(np.ceil(draws / unit)) * unit
