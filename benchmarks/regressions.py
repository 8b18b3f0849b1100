"""Nonlinear regressions of NIST: evaluations of one descent from both starts, beside those of SciPy and lmfit."""

import sys
import tomllib
import warnings
from pathlib import Path

import lmfit
import numpy as np

from benchmarks.timing import report

TESTS = Path(__file__).parents[1] / "tests"
CERTIFIED = TESTS / "verification" / "references" / "nist_regressions.toml"


def main() -> None:
    """Count evaluations; a jacobian counts as one evaluation a parameter. lmfit takes differences."""
    sys.path.append(str(TESTS))
    from nist_regressions import Regression, digits, lm, ours, trf

    methods = {"dalembert": ours, "scipy trf": trf, "scipy lm, without bounds": lm, "lmfit leastsq": _lmfit}
    problems = [Regression(name, given) for name, given in tomllib.loads(CERTIFIED.read_text()).items()]
    rows: list[dict[str, object]] = []
    for problem in problems:
        row: dict[str, object] = {"problem": problem.name}
        for name, method in methods.items():
            problem.evaluations = 0
            reached = 0
            for start in problem.starts:
                with warnings.catch_warnings():
                    warnings.simplefilter("ignore")  # of overflows far away
                    values, _ = problem.as_certified(method(problem, start))
                reached += bool(digits(values / problem.values) > 4)  # none of NaN
            row[f"{name}: evaluations"] = problem.evaluations
            row[f"{name}: four digits"] = f"{reached} of {len(problem.starts)}"
        rows.append(row)
    report("regressions", "Regressions of NIST: evaluations of one descent from each of two starts", rows)


def _lmfit(problem, start: np.ndarray) -> np.ndarray:
    """Levenberg and Marquardt by lmfit, within the same bounds."""
    names = [f"b{number}" for number in range(len(start))]
    parameters = lmfit.Parameters()
    for name, value, bound in zip(names, start, problem.bounds, strict=True):
        parameters.add(name, value=value, min=-bound, max=bound)

    def residual(given: lmfit.Parameters) -> np.ndarray:
        return problem.residual(np.array([given[name].value for name in names]))

    try:
        fit = lmfit.minimize(residual, parameters, "leastsq", max_nfev=20_000, ftol=1e-14, xtol=1e-14)
    except ValueError:  # it refuses responses that are not finite
        return np.full(len(start), np.nan)
    return np.array([fit.params[name].value for name in names])  # type: ignore[attr-defined]
