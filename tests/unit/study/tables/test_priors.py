"""Priors in study files."""

from pathlib import Path

import numpy as np
import pytest
from inline_snapshot import snapshot

from dalembert.errors import InputError
from dalembert.priors import CorrelatedNormal, HalfNormal, LogNormal, LogUniform, Normal, Uniform
from dalembert.study import load

HEAD = """
[model]
function = "model.py:line"

[solver]
kind = "GeneralizedAlpha"
step = "10 ms"

[data]
file = "data.csv"
time = "t"
columns = { x = "x" }
deviations = { x = 0.1 }

[identify]
"""


def study(folder: Path, text: str) -> Path:
    (folder / "data.csv").write_text("t,x\n0,0\n0.5,0.4\n1,1.1\n")
    (folder / "model.py").write_text("def line(**given):\n    raise NotImplementedError\n")
    path = folder / "study.toml"
    path.write_text(text + HEAD)
    return path


def test_a_parameter_has_a_prior_in_its_unit(tmp_path: Path) -> None:
    text = """
[parameters]
a = { lower = "1 mm", upper = "9 mm", prior = { kind = "normal", mean = "4 mm", deviation = 0.001 } }
b = { lower = "1 mm", upper = "9 mm", prior = { kind = "log-normal", median = "4 mm", log_deviation = 0.1 } }
c = { lower = "0 mm", upper = "9 mm", prior = { kind = "half-normal", deviation = "2 mm" } }
d = { lower = "1 mm", upper = "9 mm", prior = { kind = "uniform" } }
e = { lower = "1 mm", upper = "9 mm", prior = { kind = "log-uniform" } }
"""
    items = load(study(tmp_path, text)).parameters
    assert [item.prior for item in items] == [
        Normal(0.004, 0.001),
        LogNormal(0.004, 0.1),
        HalfNormal(0.002),
        Uniform(0.001, 0.009),
        LogUniform(0.001, 0.009),
    ]


def test_normal_priors_are_correlated(tmp_path: Path) -> None:
    text = """
prior_correlations = [{ parameters = ["a", "b"], correlation = 0.5 }]
[parameters]
a = { lower = 1, upper = 9, start = 4, deviation = 2 }
b = { lower = 1, upper = 9, prior = { kind = "normal", mean = 5, deviation = 3 } }
"""
    found = load(study(tmp_path, text)).parameters.items[0].prior
    assert isinstance(found, CorrelatedNormal)
    assert found.mean == (4.0, 5.0)
    np.testing.assert_allclose(found.covariance, [[4.0, 3.0], [3.0, 9.0]])


MISTAKES = {
    "excluded": "[parameters]\na = { lower = 1, upper = 2, prior = { kind = 'normal', mean = 9, deviation = 0.1 } }\n",
    "zero": "[parameters]\na = { lower = 0, upper = 2, prior = { kind = 'log-uniform' } }\n",
    "unit": "[parameters]\na = { lower = '1 m', upper = '2 m', prior = { kind = 'half-normal', deviation = '1 s' } }\n",
    "unknown": "prior_correlations = [{ parameters = ['a', 'c'], correlation = 0.5 }]\n"
    "[parameters]\na = { lower = 1, upper = 2 }\nb = { lower = 1, upper = 2 }\n",
    "uniform": "prior_correlations = [{ parameters = ['a', 'b'], correlation = 0.5 }]\n"
    "[parameters]\na = { lower = 1, upper = 2, deviation = 0.1 }\nb = { lower = 1, upper = 2 }\n",
    "impossible": "prior_correlations = [{ parameters = ['a', 'b'], correlation = 1.5 }]\n"
    "[parameters]\na = { lower = 1, upper = 2, deviation = 0.1 }\nb = { lower = 1, upper = 2, deviation = 0.1 }\n",
    "matrix": "prior_correlations = [{ parameters = ['a', 'b'], correlation = [[1.0]] }]\n"
    "[parameters]\na = { lower = 1, upper = 2, deviation = 0.1 }\nb = { lower = 1, upper = 2, deviation = 0.1 }\n",
}


def test_wrong_priors_are_explained(tmp_path: Path) -> None:
    told = {}
    for name, text in MISTAKES.items():
        with pytest.raises(InputError) as error:
            load(study(tmp_path, text))
        told[name] = str(error.value).replace(str(tmp_path), "FOLDER")
    assert told == snapshot(
        {
            "excluded": "study.toml: [parameters.a]: its prior has the probability 0 between the bounds (1, 2). Correct the prior or the bounds",
            "zero": "study.toml: [parameters.a]: LogUniform: lower is 0, which makes the prior improper; expected a positive number",
            "unit": "study.toml: [parameters.a]: '1 s' was given; expected a length such as '400 mm' or 0.4 in m",
            "unknown": "study.toml: [[prior_correlations]]: unknown parameter 'c'; known: a, b",
            "uniform": "study.toml: [[prior_correlations]]: parameter 'b' has no normal prior; give it prior = {kind = 'normal', ...}, or a start and a deviation",
            "impossible": "study.toml: [[prior_correlations]]: CorrelatedNormal: covariance is not positive definite, which makes the prior improper; expected positive variances, and correlations between −1 and 1 that are possible together",
            "matrix": "study.toml: [[prior_correlations]]: correlation is no number and no matrix of 2 rows and columns",
        }
    )
