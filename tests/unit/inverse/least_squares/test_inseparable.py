"""Fits of parameters of which only combinations are identifiable."""

import numpy as np
import pytest

import dalembert as da
from dalembert.study import load, run_study
from inseparable import PENDULUM_START, PENDULUM_TRUTH, pendulum_data, pendulum_model, stepped_product

STUDY = """
[parameters]
rate = { lower = 0.1, upper = 5.0, start = 3.0 }
size = { lower = 0.1, upper = 5.0, start = 0.4 }
[model]
forward = "models.py:product"
[data]
file = "data.csv"
columns = { x = "x" }
[identify]
starts = 1
horizon = "whole"
"""
MODELS = """
import numpy as np
from dalembert.forward import PythonModel

times = np.linspace(0, 2, 81)

def product(parameters):
    def response(rate, size):
        return np.sin(rate * size * times) + 1e-4 * np.sin(3 * rate * times)
    return PythonModel(response, parameters, ["x"], times)
"""


def combination(fit):
    (finding,) = (one for one in fit.conclusions if one.code == "unidentifiable-combination")
    return finding.values


@pytest.fixture(scope="module")
def pendulum():
    return pendulum_model()


@pytest.mark.parametrize(("noise", "below"), [(1e-3, "integrator"), (1e-2, "noise")])
def test_mass_centre_and_inertia_of_a_bar_that_swings_about_its_end(pendulum, noise, below):
    """Only m c and J + m c² enter the motion; the mass makes a difference by the error of the integrator alone."""
    fit = da.identify(pendulum, pendulum_data(pendulum, noise), starts=1, start=PENDULUM_START, horizon=None)
    assert fit.simulations <= 40
    assert fit.success
    assert fit.outcome[0].code == "partly-converged"
    assert fit.outcome[0].values["parameters"] == "mass, centre, inertia"
    assert fit.outcome[0].values["directions"] == 1
    assert combination(fit) == {"parameters": "mass, centre, inertia", "unseen": False, "below": below}

    def combinations(mass, centre, inertia):
        return np.array([mass * centre, inertia + mass * centre**2])

    np.testing.assert_allclose(combinations(*fit.values), combinations(*PENDULUM_TRUTH), rtol=1e-3)
    assert abs(fit.values[0] - PENDULUM_TRUTH[0]) > 0.3  # the mass is not that of the data


def test_an_error_of_the_integrator_hides_a_combination():
    model, data = stepped_product()
    fit = da.identify(model, data, starts=1, start=(0.8, 3.0), horizon=None)
    assert fit.outcome[0].code == "partly-converged"
    assert combination(fit) == {"parameters": "rate, size", "unseen": False, "below": "integrator"}
    assert np.prod(fit.values) == pytest.approx(2.25, rel=1e-3)


def test_a_study_names_the_combination(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    times = np.linspace(0, 2, 81)
    x = np.sin(1.5 * times) + 1e-4 * np.sin(3 * times) + 1e-2 * np.random.default_rng(0).standard_normal(81)
    np.savetxt(tmp_path / "data.csv", np.stack([times, x], axis=1), delimiter=",", header="t,x", comments="")
    (tmp_path / "models.py").write_text(MODELS, encoding="utf-8")
    (tmp_path / "study.toml").write_text(STUDY, encoding="utf-8")
    folder, _ = run_study(load(tmp_path / "study.toml"))
    fit = da.Fit.load(folder.path / "result.nc")
    assert fit.success
    assert fit.outcome[0].code == "partly-converged"
    assert fit.outcome[0].values["parameters"] == "rate, size"
    assert fit.simulations <= 40
    assert "Converged, except along 1 direction that the data do not identify" in folder.report.read_text("utf-8")
