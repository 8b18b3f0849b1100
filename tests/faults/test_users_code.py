"""Python code of the user's that cannot do what a study asks of it: a sentence with its file and line, at each step."""

from pathlib import Path

import numpy as np
import pytest

from dalembert.errors import DalembertError
from dalembert.study import load, plan, run_study
from dalembert.study.run.validation import forecast

IDENTIFY = """
[parameters.k]
lower = 0.5
upper = 2.0
[model]
{kind} = "model.py:model"
{more}
[data]
file = "motion.csv"
[data.columns]
x = "x"
[identify]
"""
SIMULATE = """
[parameters.k]
lower = 0.5
upper = 2.0
[model]
function = "model.py:model"
[solver]
step = 1e-3
[simulate]
end = 0.1
"""
RESPONSE = """
[parameters.k]
lower = 0.5
upper = 2.0
[model]
function = "model.py:model"
[harmonic_balance]
[frequency_response]
frequencies = [1.0]
"""
FORWARD = """import numpy as np
from dalembert import PythonModel
t = np.linspace(0.0, 1.0, 5)
def response(k):
    {body}
def model(parameters):
    return PythonModel(response, parameters, ["x"], t)
"""
"""The body of the function stands in line 5."""


def forward(body: str) -> tuple[str, str]:
    return IDENTIFY.format(kind="forward", more=""), FORWARD.format(body=body)


def whole(study: str, code: str) -> tuple[str, str]:
    return study, code


FACTORY = IDENTIFY.format(kind="forward", more="")
RAISED = "the study's Python code raised {}; mend it there"
CASES = {
    "import raises": (
        (FACTORY, "import numpy\nraise ValueError('no licence')"),
        "model.py cannot be imported: ValueError: no licence (model.py, line 2)",
    ),
    "import ends the program": (
        (FACTORY, "import sys\nsys.exit(3)"),
        "model.py cannot be imported: SystemExit: 3 (model.py, line 2)",
    ),
    "factory raises": (
        (FACTORY, "def model(parameters):\n    return 1 / 0"),
        RAISED.format("ZeroDivisionError: division by zero (model.py, line 2)"),
    ),
    "factory takes nothing": (
        (FACTORY, "def model():\n    pass"),
        "model.py:model cannot be called with a Parameters: too many positional arguments",
    ),
    "factory gives nonsense to the package": (
        (FACTORY, FORWARD.format(body="return t").replace(", t)", ", t, zero=0)")),
        RAISED.format("TypeError: PythonModel.__init__() got an unexpected keyword argument 'zero' (model.py, line 7)"),
    ),
    "factory gives texts as samples": (
        (FACTORY, FORWARD.format(body="return t").replace(", t)", ", ['a', 'b'])")),
        "PythonModel: samples is ['a', 'b']; expected real numbers",
    ),
    "factory ends the program": (
        (FACTORY, "def model(parameters):\n    raise SystemExit('licence')"),
        RAISED.format("SystemExit: licence (model.py, line 2)"),
    ),
    "model has other channels": (
        (FACTORY, FORWARD.format(body="return k * t").replace('"x"', '"y"')),
        "[data], columns: unknown channel 'x'; known: y",
    ),
    "call raises": (
        forward("return {}['k'] * t"),
        "KeyError: 'k' (model.py, line 5)",
    ),
    "call ends the program": (
        forward("raise SystemExit(3)"),
        "SystemExit: 3 (model.py, line 5)",
    ),
    "call returns nothing": (
        forward("pass"),
        "the model's function (model.py, line 4) returned a NoneType; expected an array of numbers",
    ),
    "call returns another shape": (
        forward("return np.zeros((2, 2))"),
        "the model's function (model.py, line 4) returned an array of shape (2, 2); expected (samples, channels) = "
        "(5, 1)",
    ),
    "call returns no numbers": (
        forward("return np.nan * t"),
        "the model's function (model.py, line 4) returned a value that is not finite",
    ),
    "mechanism raises": (
        (SIMULATE, "def model(k):\n    return [][1]"),
        RAISED.format("IndexError: list index out of range (model.py, line 2)"),
    ),
    "mechanism takes other parameters": (
        (SIMULATE, "def model(q):\n    pass"),
        "model.py:model cannot be called with 'k': missing a required argument: 'q'",
    ),
    "mechanism gives nonsense to the package": (
        (SIMULATE, "import dalembert as da\ndef model(k):\n    return da.System(gravitas=9.81)"),
        RAISED.format("TypeError: System.__init__() got an unexpected keyword argument 'gravitas' (model.py, line 3)"),
    ),
    "structure raises": (
        (RESPONSE, "def model(k):\n    raise RuntimeError"),
        RAISED.format("RuntimeError (model.py, line 2)"),
    ),
}


@pytest.mark.parametrize("case", CASES)
def test_it_is_told_with_its_place(case: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    (study, code), sentence = CASES[case]
    Path("model.py").write_text(code)
    Path("study.toml").write_text(study)
    times = np.linspace(0.0, 1.0, 5)
    Path("motion.csv").write_text("t,x\n" + "".join(f"{t},{t}\n" for t in times))
    with pytest.raises(DalembertError) as error:
        run_study(load("study.toml"))
    assert sentence in str(error.value)
    if case.startswith("call "):  # it is called when the run simulates
        assert sentence in (Path("runs/study/state.json").read_text()).replace('\\"', '"')
        assert sentence in " ".join(forecast(load("study.toml")))
        return
    assert not Path("runs").exists()
    with pytest.raises(DalembertError) as error:
        plan(load("study.toml"))
    assert sentence in str(error.value)


FAILING = """
import pathlib
import dalembert as da
def model(k):
    system = da.System()
    bar = system.add(da.RigidBar("bar", mass=1.0, length=k))
    system.add(da.RevoluteJoint("pin", system.ground, bar.start))
    return helper(system) if pathlib.Path("runs").exists() else system
def helper(system):
    return 1 / 0
"""


def test_the_traceback_lies_in_the_run(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    Path("model.py").write_text(FAILING)
    Path("study.toml").write_text(SIMULATE)
    with pytest.raises(DalembertError):
        run_study(load("study.toml"))
    told = Path("runs/study/error.txt").read_text()
    assert 'model.py", line 8, in model' in told
    assert 'model.py", line 10, in helper' in told
