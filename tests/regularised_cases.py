"""Small regularised fits that provoke the sentences and figures of their reports."""

import numpy as np

import dalembert as da
from report_case import Case

TIMES = np.linspace(0.0, 1.0, 41)
COUNT = 12


def summed(**coefficients: complex) -> np.ndarray:
    """The integral of a history by lines, of which a part is squared: a mild nonlinearity."""
    values = np.array(list(coefficients.values()))
    hats = np.array([np.interp(TIMES, np.linspace(0.0, 1.0, COUNT), unit) for unit in np.eye(COUNT)])
    history = values @ hats
    return np.cumsum(history + 0.2 * history**2) / 40


MODEL = da.PythonModel(summed, {f"c{k}": (-2.0, 2.0) for k in range(COUNT)}, ["x"], TIMES)
TRUTH = np.sin(np.linspace(0.0, 3.0, COUNT))


def measured(deviations: bool = True) -> da.Measurements:
    """Its response to a half wave, with noise of a thousandth."""
    values = MODEL.evaluate(TRUTH[None]).values[0, :, 0] + 1e-3 * np.random.default_rng(0).normal(size=41)
    return da.Measurements.of(TIMES, {"x": values}, deviations={"x": 1e-3} if deviations else None)


REGULARISED_CASES = {
    "smooth parameters": Case(
        lambda: da.regularise(MODEL, measured(), rounds=1),
        (
            "The weight of the penalty still changed from",
            "Start from these values, or give the weight.",
            "The band is two standard deviations, with the penalty as a prior.",
            "A larger weight gives smoother parameters and a larger residual. The weight is chosen at the corner.",
            "Smooth parameters",
            "Response and data",
            "Download all values as CSV",
        ),
        ("smooth-parameters", "penalty-curve", "responses-1"),
    ),
    "smooth parameters beside another one": Case(
        lambda: da.regularise(MODEL, measured(), smooth=MODEL.parameters.names[1:], rounds=1),
        ("Parameters without a penalty",),
        ("smooth-parameters",),
    ),
    "smooth parameters, beyond their bounds": Case(
        lambda: da.regularise(
            da.PythonModel(summed, {f"c{k}": (-0.5, 0.5) for k in range(COUNT)}, ["x"], TIMES), measured()
        ),
        ("beyond the bounds, the first: 'c2' is", "Regularisation does not keep bounds."),
    ),
    "smooth parameters, unknown noise": Case(
        lambda: da.regularise(MODEL, measured(deviations=False)), ("noise not known",), ()
    ),
}
