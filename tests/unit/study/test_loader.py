"""Study files read and checked: what is understood, and every sentence about what cannot be."""

from pathlib import Path

import numpy as np
import pytest

from dalembert.errors import InputError
from dalembert.study import json_schema, load, plan
from dalembert.study.tables.builder import named_values
from dalembert.study.tasks import TASKS
from json_schemas import fits
from support import says

# Every task, in the order in which messages list them.
ALL_TASKS = ", ".join(f"[{name}]" for name in TASKS)
DECAY = """
import numpy as np
from dalembert.forward import PythonModel

def decay(parameters, count=11):
    times = np.linspace(0, 1, count)
    return PythonModel(lambda rate, height: height * np.exp(-rate * times), parameters, ["x"], times)

def number(parameters):
    return 3
"""
SWEEP = """
[study]
name = "decay"
title = "Decay"
[parameters]
rate = { lower = 0.5, upper = "3 1/s" }
height = { lower = "100 mm", upper = 1.0, start = "pi/10" }
[model]
forward = "decay.py:decay"
arguments = { count = 21 }
[sweep]
at = 0.5
channels = ["x"]
over = { rate = { count = 5 }, height = [0.2, "300 mm"] }
"""
PENDULUM = """
[parameters]
theta = { lower = "30 deg", upper = 1.0 }
[constants]
L = "1 m"
m = "2*L*theta"
[model]
[[model.body]]
kind = "RigidBar"
name = "rod"
length = "L"
mass = "m"
angle = "-theta"
[[model.joint]]
kind = "RevoluteJoint"
name = "pin"
a = "ground"
b = "rod.start"
[[model.load]]
kind = "Torque"
name = "drive"
at = "rod.start"
torque = { kind = "Harmonic", amplitude = "0.1*m", angular_frequency = "60 rpm" }
[solver]
step = "1 ms"
[simulate]
end = "1 s"
"""


@pytest.fixture
def write(tmp_path):
    (tmp_path / "decay.py").write_text(DECAY)

    def write(text: str, name: str = "study.toml") -> Path:
        path = tmp_path / name
        path.write_text(text, encoding="utf-8")
        return path

    return write


def mistakes(path: Path) -> list[str]:
    with pytest.raises(InputError) as caught:
        plan(load(path))
    return str(caught.value).split("\n")


def test_a_study_is_understood_in_si(write):
    study = load(write(SWEEP))
    assert (study.name, study.title, study.task) == ("decay", "Decay", "sweep")
    assert study.parameters.mapping(study.parameters.start) == {"rate": 1.75, "height": np.pi / 10}
    assert [parameter.unit for parameter in study.parameters] == ["1/s", "m"]
    assert study.table.over["height"] == (0.2, 0.3)
    assert study.settings["parameters"]["rate"]["upper"] == 3.0
    assert plan(study) == "sweeps rate (5), height (2) at time 0.5 s: 7 simulations, each with 2 sensitivities"


def test_the_same_study_from_its_own_settings(write):
    """Settings are a study themselves, but for the files' places."""
    first = load(write(PENDULUM))
    text = "\n".join(_toml(first.settings))
    assert load(write(text, "again.toml")).settings == first.settings


def test_a_model_is_a_function_of_its_parameters(write):
    study = load(write(PENDULUM))
    system = study.builder(theta=0.6)
    rod, drive = system.bodies[0], system.loads[0]
    assert (rod.mass, rod.angle) == (1.2, -0.6)
    assert drive.torque.amplitude == pytest.approx(0.12)


def test_a_model_is_complex_safe(write):
    rod = load(write(PENDULUM)).builder(theta=0.6 + 1e-30j).bodies[0]
    assert rod.mass.imag == pytest.approx(2e-30)
    assert rod.angle.imag == pytest.approx(-1e-30)
    assert rod.length == 1.0


def test_a_model_may_stand_in_a_file_of_its_own(write):
    model = PENDULUM[PENDULUM.index("[constants]") : PENDULUM.index("[solver]")]
    write(model.replace('L = "1 m"', 'L = "3 m"'), "model.toml")
    rest = PENDULUM[: PENDULUM.index("[constants]")] + PENDULUM[PENDULUM.index("[solver]") :]
    path = write(rest + '[constants]\nL = 2.0\n[model]\nfile = "model.toml"\n')
    study = load(path)
    assert study.builder(theta=0.5).bodies[0].mass == 2.0
    assert set(study.files) == {"model.toml"}


def test_a_parameter_wins_over_a_constant_of_the_model_file(write):
    model = PENDULUM[PENDULUM.index("[constants]") : PENDULUM.index("[solver]")]
    write(model, "model.toml")
    rest = PENDULUM[: PENDULUM.index("[constants]")] + PENDULUM[PENDULUM.index("[solver]") :]
    path = write(rest + '[parameters.L]\nlower = 1.0\nupper = 3.0\n[model]\nfile = "model.toml"\n')
    assert load(path).builder(theta=0.5, L=2.5).bodies[0].length == 2.5


def test_a_mistake_in_the_model_file_names_that_file(write):
    write('[model]\n[[model.body]]\nkind = "PointMass"\nname = "p"\nmass = "1 m"\n', "model.toml")
    path = write('[solver]\nstep = 1\n[simulate]\nend = -1\n[model]\nfile = "model.toml"\n')
    assert mistakes(path) == [
        "model.toml: [[model.body]] 'p', mass: '1 m' was given; expected a mass such as '500 g' or 0.5 in kg",
        "study.toml: [simulate]: end is -1 s; expected a time after 0",
    ]


def test_constants_in_their_order(write):
    study = load(write(PENDULUM))
    assert named_values(study.file.constants, {"theta": 0.5}) == {"theta": 0.5, "L": 1.0, "m": 1.0}


def test_a_seed_for_what_draws_no_random_numbers_is_refused(write):
    with pytest.raises(InputError, match=r"^a seed was given, but \[sweep\] draws no random numbers; leave it out$"):
        load(write(SWEEP)).with_seed(3)


def test_all_mistakes_at_once(write):
    path = write("""
[studdy]
title = "Decay"
[constants]
L = "400 mm"
half = "0.5*M"
[parameters.theta1]
lower = 1.0
upper = 0.6
[parameters.theta2]
lower = "3 kg"
upper = "x"
unit = "rad"
[parameters.theta3]
lower = 0.0
upper = 1.0
unit = "deg"
[model]
gravity = [0, "-9.81 m"]
[[model.body]]
kind = "AncfBeam"
name = "OA"
lenght = 1.0
elements = 2.5
youngs_modulus = "2e8 Pa"
poisson_ratio = 0.3
density = "5540 kg"
height = "3 kg"
width = "w"
[[model.body]]
kind = "AncfBaem"
[[model.body]]
kind = "RigidBody"
name = "plate"
mass = true
inertia = 1
velocity = [1]
points = { tip = "0.1" }
[[model.body]]
name = "what"
[[model.joint]]
kind = "RevoluteJoint"
name = "O"
a = "ground(0)"
b = "OA-end"
[[model.load]]
kind = "Torque"
name = "T"
at = "OA.start"
torque = { kind = "Harmonik" }
[solver]
step = 1e-3
spectral_radius = 2
[data]
file = "none.csv"
columns = { x = 1.5 }
[identify]
method = "nelder-meat"
starts = 0
polish = "yes"
horizon = "growin"
""")
    names = "; known: L, half, theta1, theta2, theta3; "
    length = "expected a length such as '400 mm' or 0.4 in m"
    more = ", or an expression of parameters and constants"
    assert mistakes(path) == [
        "study.toml: [constants]: half: '0.5*M' was given, but unknown name 'M'; known: L, theta1, theta2, theta3; "
        "expected a number in SI units, or a number with its unit such as '400 mm'" + more,
        "study.toml: [parameters.theta1]: bounds are (1.0, 0.6); expected two finite numbers, the lower one first",
        "study.toml: [parameters.theta2]: lower: '3 kg' was given; "
        "expected an angle such as '45 deg' or 0.785398 in rad",
        "study.toml: [parameters.theta2]: upper: 'x' was given, but unknown name 'x'; "
        "expected an angle such as '45 deg' or 0.785398 in rad",
        "study.toml: [parameters.theta3]: unit 'deg' was given; expected an SI unit such as 'm', 'rad' or 'Pa', in "
        "which the numbers are; a bound may have another unit with it: lower = '100 MPa'",
        "study.toml: [model], gravity, entry 2: '-9.81 m' was given; "
        "expected an acceleration such as '980 cm/s^2' or 9.8 in m/s^2",
        "study.toml: [[model.body]] 'OA': the key 'length' is missing",
        "study.toml: [[model.body]] 'OA', elements: 2.5 was given; expected a whole number",
        "study.toml: [[model.body]] 'OA', density: '5540 kg' was given; "
        "expected a density such as '7.85 g/cm^3' or 7850 in kg/m^3",
        f"study.toml: [[model.body]] 'OA', height: '3 kg' was given; {length}",
        f"study.toml: [[model.body]] 'OA', width: 'w' was given, but unknown name 'w'{names}{length}{more}",
        "study.toml: [[model.body]] 'OA': unknown key 'lenght'; did you mean 'length' or 'height'?",
        "study.toml: [[model.body]] number 2: unknown kind 'AncfBaem'; did you mean 'AncfBeam' or 'AncfCable'?",
        "study.toml: [[model.body]] 'plate', mass: True was given; expected a mass such as '500 g' or 0.5 in kg",
        "study.toml: [[model.body]] 'plate', points, tip: '0.1' was given; expected a list",
        "study.toml: [[model.body]] 'plate', velocity: [1] was given; expected at least 2 entries",
        "study.toml: [[model.body]] 'what': the key 'kind' is missing",
        "study.toml: [[model.joint]] 'O', a: 'ground(0)' was given; "
        "expected x and y, or x, y and an angle, such as 'ground(0.3, 0)'",
        "study.toml: [[model.joint]] 'O', b: 'OA-end' was given; "
        "expected a point such as 'ground', 'OA.end', 'ground(0.3, 0)' or [0.3, 0.0]",
        "study.toml: [[model.load]] 'T', torque: unknown kind 'Harmonik'; did you mean 'Harmonic'?",
        "study.toml: [solver]: GeneralizedAlpha: spectral_radius is 2; expected a number from 0 to 1",
        f"study.toml: [data], file: 'none.csv' was given, but there is no file {path.parent / 'none.csv'}",
        "study.toml: [data.columns], x: 1.5 was given; expected the name of a column in quotes, or its number from 1",
        "study.toml: [identify], method: unknown method 'nelder-meat'; did you mean 'Nelder-Mead'?",
        "study.toml: [identify], starts: 0 was given; expected a number of at least 1",
        "study.toml: [identify], polish: 'yes' was given; expected true or false",
        "study.toml: [identify], horizon: 'growin' was given; expected 'growing' or 'whole'; did you mean 'growing'?",
        "study.toml: unknown key 'studdy'; did you mean 'study'?",
    ]


@pytest.mark.parametrize(
    ("change", "messages"),
    [
        (
            ('b = "rod.start"', 'b = "rot.start"'),
            ["study.toml: [[model.joint]] 'pin', b: 'rot.start' was given; unknown body 'rot'; did you mean 'rod'?"],
        ),
        (
            ('angle = "-theta"', 'angle = "-theta"\nstart = "rod.end"'),
            [
                "study.toml: [[model.body]] 'rod', start: 'rod.end' was given; unknown body 'rod'; known: none; "
                "a body must stand before those placed at it"
            ],
        ),
        (
            ('b = "rod.start"', 'b = "rod.strat"'),
            ["[[model.joint]] 'pin', b: body 'rod': unknown point 'strat'; did you mean 'start'?"],
        ),
        (
            ('name = "pin"', 'name = "rod"'),
            ["study.toml: [model]: 2 components are called 'rod'; expected different names"],
        ),
        (
            ("[solver]", "[sweep]\nat=1\nchannels=['x']\nover.theta=[1.0]\n[solver]"),
            [
                "study.toml: [simulate] and [sweep] are given; a study has one task, one of " + ALL_TASKS
            ],
        ),
        (
            ('[simulate]\nend = "1 s"', ""),
            [
                "study.toml: no task is given; a study has one task, one of " + ALL_TASKS
            ],
        ),
        (('[solver]\nstep = "1 ms"', ""), ["study.toml: the table [solver] is missing; expected at least its step"]),
        (
            ("[model]", '[model]\nfunction = "decay.py:decay"'),
            [
                "study.toml: [model]: function and body are given; expected either the [[model.body]] tables of "
                "a mechanism, or the [[model.mass]] tables or the [model.structure] of a structure, or "
                "function = 'model.py:name', or forward = 'model.py:name'"
            ],
        ),
        (
            ('"2*L*theta"', '"2*L/(theta - theta)"'),
            ["[constants], m: '2*L/(theta - theta)' has no value: float division by zero"],
        ),
        (
            ("theta = {", "'my theta' = { lower = 0, upper = 1 }\ntheta = {"),
            [
                "study.toml: [parameters]: 'my theta' cannot be the name of a parameter or constant; expected letters, "
                "digits and _, a letter first, and none of abs, acos, asin, atan2, cos, exp, hypot, log, "
                "pi, sin, sqrt, tan"
            ],
        ),
        (
            ("theta = {", "L = { lower = 0, upper = 1 }\ntheta = {"),
            ["study.toml: L is both a parameter and a constant; give each name once"],
        ),
        (
            ('[simulate]\nend = "1 s"', "[identify]"),
            ["study.toml: [identify] needs a [data] table"],
        ),
    ],
)  # fmt: skip
def test_what_does_not_fit_together(write, change, messages):
    assert PENDULUM.count(change[0]) == 1
    assert mistakes(write(PENDULUM.replace(*change))) == messages


@pytest.mark.parametrize(
    ("change", "messages"),
    [
        (
            ("decay.py:decay", "decay.py:decai"),
            ["decay.py: unknown function 'decai'; did you mean 'decay'?"],
        ),
        (
            ("decay.py:decay", "dekay.py:decay"),
            ["study.toml: [model], forward: 'dekay.py:decay' was given, but there is no file {folder}/dekay.py"],
        ),
        (
            ("decay.py:decay", "decay"),
            [
                "study.toml: [model], forward: 'decay' was given; expected a function such as 'model.py:function' "
                "(a file beside the study) or 'package.module:function'"
            ],
        ),
        (
            ("decay.py:decay", "no_such_module:decay"),
            ["no_such_module cannot be imported: ModuleNotFoundError: No module named 'no_such_module'"],
        ),
        (
            ("arguments = { count = 21 }", ""),
            [],
        ),
        (
            ("forward = \"decay.py:decay\"\narguments = { count = 21 }", "forward = \"decay.py:number\""),
            ["decay.py:number returned a int; expected a ForwardModel such as PythonModel"],
        ),
        (
            ("at = 0.5", "at = 0.52"),
            ["[sweep], at: 0.52 was given, but the model has no sample there; the nearest is 0.5"],
        ),
        (('channels = ["x"]', 'channels = ["y"]'), ["[sweep], channels: unknown channel 'y'; known: x"]),
        (
            ("height = [0.2", "hight = [0.2"),
            ["study.toml: [sweep.over]: unknown parameter 'hight'; did you mean 'height'?"],
        ),
    ],
)  # fmt: skip
def test_models_that_are_functions(write, change, messages):
    path = write(SWEEP.replace(*change))
    if messages:
        assert mistakes(path) == [message.format(folder=path.parent) for message in messages]
    else:
        assert plan(load(path)).startswith("sweeps")


@pytest.mark.parametrize(
    ("at", "sentence"),
    [
        ("-1", "times: the first is -1 s, but the motion begins at 0 s; give times from 0 s on"),
        ("0", "TimeResponse: the last of the times is 0 s; expected a motion of some duration"),
    ],
)
def test_an_instant_before_the_motion_names_its_key(write, at, sentence):
    sweep = f"[sweep]\nat = {at}\nchannels = ['rod.end.x']\nover.theta = [0.6]\n"
    assert mistakes(write(PENDULUM.replace('[simulate]\nend = "1 s"\n', sweep))) == [f"[sweep], at: {sentence}"]


def test_an_error_in_the_users_file_is_placed(write, tmp_path):
    (tmp_path / "broken.py").write_text("x = 1\ny = 1 / 0\n")
    (tmp_path / "garbled.py").write_text("x = 1\ny = (\n")
    assert mistakes(write(SWEEP.replace("decay.py", "broken.py"))) == [
        "broken.py cannot be imported: ZeroDivisionError: division by zero (broken.py, line 2)"
    ]
    assert mistakes(write(SWEEP.replace("decay.py", "garbled.py"))) == [
        "garbled.py cannot be imported: SyntaxError: '(' was never closed (garbled.py, line 2)"
    ]


@pytest.mark.parametrize(
    ("content", "message"),
    [
        (b"a = \n", "{path}: no valid TOML: Invalid value (at line 1, column 5)"),
        (b"a = 1\na = 2\n", "{path}: no valid TOML: Cannot overwrite a value (at line 2, column 6)"),
        (b"[study]\ntitle = \"caf\xe9\"\n", "{path}, line 2: the file is not UTF-8 text; save it as UTF-8"),
        (b"", "study.toml: the file holds no tables; a study needs a [model] and one task, one of [simulate], "),
        (
            b"[model]\nbody = []\n[constants]\na = 1\n",
            "study.toml: no task is given; a study needs a [model] and one task, one of [simulate], ",
        ),
        (b"model = 3\n[simulate]\nend=1\n", "study.toml: model: 3 was given; expected a table"),
        (b"a = " + b"[" * 5000, "{path}: no valid TOML: "),
    ],
)  # fmt: skip
def test_files_that_are_no_study(tmp_path, content, message):
    path = tmp_path / "study.toml"
    path.write_bytes(content)
    with pytest.raises(InputError) as caught:
        load(path)
    assert str(caught.value).startswith(message.format(path=path))


def test_a_file_that_is_not_there_names_the_near_one(write):
    path = write(SWEEP, "pendulum.toml")
    with pytest.raises(InputError) as caught:
        load(path.with_name("pendulun.toml"))
    assert (
        str(caught.value) == f"folder {path.parent}: unknown study file 'pendulun.toml'; did you mean 'pendulum.toml'?"
    )
    with pytest.raises(InputError, match=says(f"{path.parent} is a folder; expected a study file such as {path}")):
        load(path.parent)
    (path.parent / "empty").mkdir()
    with pytest.raises(InputError, match=says(f"{path.parent / 'empty'} is a folder; expected a study file")):
        load(path.parent / "empty")


def test_a_model_alone_is_told_how_a_study_names_it(write):
    with pytest.raises(InputError) as caught:
        load(write("[model]\nbody = []\n", "pendulum.toml"))
    assert str(caught.value) == (
        f"pendulum.toml: no task is given; a study needs a [model] and one task, one of {ALL_TASKS}; a study in another "
        "file names a model by file = 'pendulum.toml' in [model]"
    )


def test_the_json_schema_accepts_each_form_of_a_start():
    schema = json_schema()
    start = schema["$defs"]["DataTable"]["properties"]["start"]
    for value in ("first", 1.5, "1 ms", {"lower": 0.0, "upper": 1.0}):
        assert fits(value, start, schema), value
    assert not fits([1.0], start, schema)


def test_the_json_schema_knows_all_kinds():
    schema = json_schema()
    assert {"AncfBeam", "RigidBar", "RevoluteJoint", "Spring", "Harmonic", "GeneralizedAlpha"} <= schema["$defs"].keys()
    assert {"model", "parameters", "simulate", "identify", "sweep", "data"} <= schema["properties"].keys()
    assert schema["$defs"]["AncfBeam"]["properties"]["density"]["description"].startswith("a density such as")


def _toml(settings: dict) -> list[str]:
    """Settings as TOML, in inline tables."""
    return [f"{key} = {_inline(value)}" for key, value in settings.items()]


def _inline(value: object) -> str:
    if isinstance(value, dict):
        return (
            "{ " + ", ".join(f'"{key}" = {_inline(entry)}' for key, entry in value.items() if entry is not None) + " }"
        )
    if isinstance(value, list):
        return "[" + ", ".join(map(_inline, value)) + "]"
    if isinstance(value, bool):
        return str(value).lower()
    return repr(value) if not isinstance(value, str) else f"'{value}'"
