"""Nonlinear regressions of NIST with certified values, and descents to count the evaluations of."""

from itertools import permutations

import numpy as np
from scipy.optimize import least_squares

import dalembert as da

WIDE = 10.0
"""Bounds of a parameter, in units of the larger of its two starts, on both sides of zero."""


def gauss(x, height, centre, width):
    return height * np.exp(-(((x - centre) / width) ** 2))


def wave(x, period, cosine, sine):
    return cosine * np.cos(2 * np.pi * x / period) + sine * np.sin(2 * np.pi * x / period)


def ratio(x, above, below):
    return np.polynomial.polynomial.polyval(x, above) / (1 + x * np.polynomial.polynomial.polyval(x, below))


MODELS = {
    "Bennett5": lambda x, a, b, c: a * (b + x) ** (-1 / c),
    "BoxBOD": lambda x, a, b: a * (1 - np.exp(-b * x)),
    "Chwirut2": lambda x, a, b, c: np.exp(-a * x) / (b + c * x),
    "DanWood": lambda x, a, b: a * x**b,
    "Eckerle4": lambda x, a, b, c: a / b * np.exp(-0.5 * ((x - c) / b) ** 2),
    "ENSO": lambda x, a, c, s, p, d, e, q, f, g: a + wave(x, 12.0, c, s) + wave(x, p, d, e) + wave(x, q, f, g),
    "Gauss1": lambda x, a, b, h, m, w, k, n, v: a * np.exp(-b * x) + gauss(x, h, m, w) + gauss(x, k, n, v),
    "Hahn1": lambda x, *b: ratio(x, b[:4], b[4:]),
    "Kirby2": lambda x, *b: ratio(x, b[:3], b[3:]),
    "Lanczos3": lambda x, a, b, c, d, e, f: a * np.exp(-b * x) + c * np.exp(-d * x) + e * np.exp(-f * x),
    "MGH09": lambda x, a, b, c, d: a * x * (x + b) / (x * (x + c) + d),
    "MGH10": lambda x, a, b, c: a * np.exp(b / (x + c)),
    "MGH17": lambda x, a, b, c, d, e: a + b * np.exp(-x * d) + c * np.exp(-x * e),
    "Misra1a": lambda x, a, b: a * (1 - np.exp(-b * x)),
    "Rat42": lambda x, a, b, c: a / (1 + np.exp(b - c * x)),
    "Roszman1": lambda x, a, b, c, d: a - b * x - np.arctan(c / (x - d)) / np.pi,
    "Thurber": lambda x, *b: ratio(x, b[:4], b[4:]),
}

TOO_FAR = ("MGH10", 0)
"""A start in a valley that is 46 decades of the first parameter long; a fit from there is no success."""

ALIKE = {  # groups of parameters that may be exchanged
    "ENSO": [(3, 4, 5), (6, 7, 8)],
    "Gauss1": [(2, 3, 4), (5, 6, 7)],
    "Lanczos3": [(0, 1), (2, 3), (4, 5)],
    "MGH17": [(1, 3), (2, 4)],
}
MIRRORED = {"Eckerle4": [(0, 1)], "ENSO": [(3, 5), (6, 8)], "Gauss1": [(4,), (7,)]}  # that change their signs together


class Regression:
    """One of the problems, as a model with data and as residuals that count what is computed."""

    def __init__(self, name, given):
        self.name, self.given = name, given
        self.x, self.y = np.array(given["x"]), np.array(given["y"])
        self.starts, self.values = np.array(given["starts"]), np.array(given["values"])
        self.bounds = WIDE * np.max(np.abs(self.starts), axis=0)
        self.evaluations = 0

    def response(self, values):
        with np.errstate(all="ignore"):  # far away powers and exponentials overflow
            return MODELS[self.name](self.x, *values)

    def fit(self, start, **settings):
        names = [f"b{k + 1}" for k in range(len(self.values))]
        rows = np.arange(len(self.x), dtype=float)
        box = {name: (-bound, bound) for name, bound in zip(names, self.bounds, strict=True)}
        model = da.PythonModel(
            lambda **values: self.response(values.values()), box, ["y"], rows, coordinate="row", unit=""
        )
        data = da.Measurements(model.coordinate, ("y",), self.y[:, None])
        return da.identify(model, data, start=start, **settings)

    def residual(self, values):
        self.evaluations += 1
        return self.response(values) - self.y

    def jacobian(self, values):
        self.evaluations += len(values)
        steps = np.asarray(values) + 1e-30j * np.eye(len(values))
        return np.stack([self.response(step).imag / 1e-30 for step in steps], axis=1)

    def as_certified(self, values):
        """The values, permuted and mirrored to be as near to the certified ones as they can be, and the order."""
        groups, signs = ALIKE.get(self.name, []), MIRRORED.get(self.name, [])
        nearest = []
        for exchanged in permutations(groups):
            order = np.arange(len(values))
            for group, other in zip(groups, exchanged, strict=True):
                order[list(group)] = other
            for negative in np.ndindex(*[2] * len(signs)):
                sign = np.ones(len(values))
                for flip, members in zip(negative, signs, strict=True):
                    sign[list(members)] = -1 if flip else 1
                moved = sign * np.asarray(values)[order]
                nearest.append((np.max(np.abs(moved / self.values - 1)), tuple(order), moved))
        _, order, moved = min(nearest, key=lambda one: one[0])
        return moved, list(order)


def digits(ratios):
    return -np.log10(np.maximum(np.max(np.abs(ratios - 1)), 1e-11))


def ours(problem, start):
    return da.LeastSquares().minimise(problem.residual, problem.jacobian, -problem.bounds, problem.bounds, start).x


def trf(problem, start):
    box = -problem.bounds, problem.bounds
    settings = {"x_scale": "jac", "ftol": 1e-14, "xtol": 1e-10, "gtol": None, "max_nfev": 1000}
    return least_squares(problem.residual, start, problem.jacobian, box, "trf", **settings).x


def lm(problem, start):
    settings = {"x_scale": "jac", "ftol": 1e-14, "xtol": 1e-10, "gtol": 1e-15, "max_nfev": 1000}
    return least_squares(problem.residual, start, problem.jacobian, method="lm", **settings).x
