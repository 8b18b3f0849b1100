"""A model with an error of second order in its step, and a finer one."""

from dataclasses import dataclass, replace

import numpy as np

from dalembert.data import Measurements
from dalembert.errors import SolveError
from dalembert.forward import PythonModel, Refinement, error_factor

TIMES = np.linspace(0, 4, 101)
STEPPED_BOX = {"rate": (0.1, 3.0), "size": (0.5, 4.0)}
TRUTH = np.array([0.8, 2.0])


def decay_in_steps(rate, size, step, times=TIMES):
    """A decay with an error of second order in the step."""
    return size * np.exp(-rate * times) + 0.02 * step**2 * rate * np.sin(3 * times)


def slow_in_steps(rate, size, step, times=TIMES):
    """A decay whose rate has an error of second order in the step, which the identified rate takes up."""
    return size * np.exp(-rate * (1 + 0.01 * step**2) * times)


def growing_in_steps(rate, size, step, times=TIMES):
    """A growth whose error is of second order in the step."""
    return size * np.exp(rate * times) + 0.02 * step**2 * rate * np.sin(3 * times)


def quick_in_steps(rate, size, step, times=TIMES):
    """A decay with an error of second order in the step that swings too quickly for a parameter to take it up."""
    return size * np.exp(-rate * times) + 0.0025 * step**2 * np.sin(40 * times)


@dataclass(frozen=True)
class Stepped(PythonModel):
    """A decay with a step; ``finer`` tells what is made of the refined model."""

    def __init__(self, step=0.8, box=None, finer=lambda model: model, times=TIMES, method=decay_in_steps):
        super().__init__(lambda rate, size: method(rate, size, step, times), box or STEPPED_BOX, ["x"], times)
        object.__setattr__(self, "method", method)
        object.__setattr__(self, "step", step)
        object.__setattr__(self, "finer", finer)

    @property
    def fingerprint(self):
        return f"{super().fingerprint} {self.step}"

    def first(self, samples):
        return Stepped(self.step, self.parameters, self.finer, self.coordinate.values[:samples], self.method)

    def refined(self):
        finer = Stepped(self.step / 2, self.parameters, times=self.coordinate.values, method=self.method)
        return Refinement(self.finer(finer), error_factor(2), "at half the step")


def exact(noise=0.0, deviations=None, seed=0):
    values = 2.0 * np.exp(-0.8 * TIMES) + noise * np.random.default_rng(seed).standard_normal(101)
    return Measurements.of(TIMES, {"x": values}, deviations)


def failing(model):
    return replace_evaluate(model, lambda vectors: (_ for _ in ()).throw(SolveError("too stiff")))


def marked(model):
    def evaluate(vectors):
        found = PythonModel.evaluate(model, vectors)
        return replace(found, values=found.values * np.nan, failures=("too stiff",))

    return replace_evaluate(model, evaluate)


def replace_evaluate(model, evaluate):
    class Other(Stepped):
        def evaluate(self, vectors):
            return evaluate(vectors)

    return Other(model.step)
