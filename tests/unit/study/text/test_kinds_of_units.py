"""Units of columns, inputs, deviations, offsets and constants are those of what they stand for."""

import numpy as np
import pytest

from dalembert.errors import DataError, InputError
from dalembert.study.loader import load
from dalembert.study.run.model_findings import time_scale_findings
from dalembert.study.run.validation import forecast, plan
from dalembert.study.sources import source_lines
from dalembert.study.tables.posing import posed

STUDY = """
[parameters]
drag = {{ lower = 0.0, upper = 0.1, unit = "N*m*s" }}
[constants]
L = "{constant}"
[inputs.torque]
column = "{torque}"
{more_input}
[[model.body]]
kind = "RigidBar"
name = "bar"
length = "{length}"
mass = 0.4
angle = "-90 deg"
[[model.joint]]
kind = "RevoluteJoint"
name = "pin"
a = "ground"
b = "bar.start"
viscous = "drag"
[[model.load]]
kind = "Torque"
name = "motor"
at = "bar.start"
torque = {{ input = "torque" }}
[solver]
step = "20 ms"
[data]
file = "run.csv"
time = "t (s)"
columns = {{ "{channel}" = "{angle}" }}
{more}
[identify]
"""
USUAL = {
    "constant": "50 cm", "length": "L", "torque": "torque (Nm)", "more_input": "", "channel": "bar.start.angle",
    "angle": "angle (deg)", "more": "",
}  # fmt: skip


@pytest.fixture
def study(tmp_path):
    def make(**changed):
        words = USUAL | changed
        times = np.arange(11) * 0.1
        rows = [f"{t:.1f};{30 * t:.3f};{0.1 * t:.4f}" for t in times]
        (tmp_path / "run.csv").write_text("\n".join([f"t (s);{words['angle']};{words['torque']}", *rows]) + "\n")
        (tmp_path / "study.toml").write_text(STUDY.format(**words))
        return load(tmp_path / "study.toml")

    return make


def test_a_torque_in_newton_metres_is_read_as_such(study):
    assert study().inputs["torque"].values[-1] == 0.1
    assert study(torque="torque (mNm)").inputs["torque"].values[-1] == pytest.approx(1e-4)


def test_units_that_fit_are_named(study):
    assert list(source_lines(study()))[1:] == ["Units: time in s, bar.start.angle in deg", "Input torque: Nm"]
    assert list(source_lines(study(angle="angle", torque="torque")))[1:] == [
        "Units: time in s; no unit is given for bar.start.angle, read in SI units",
        "Input torque: no unit is given, read in SI units",
    ]


@pytest.mark.parametrize(
    ("changed", "sentence"),
    [
        (
            {"angle": "angle (mm)"},
            "the data of channel 'bar.start.angle': the unit 'mm' was given; expected that of an angle such as '45 deg' "
            "or 0.785398 in rad; choose another column, or correct its unit in units",
        ),
        (
            {"channel": "bar.end.ax", "angle": "a (deg/s)"},
            "the unit 'deg/s' was given; expected that of an acceleration",
        ),
        (
            {"torque": "torque (N)"},
            "[inputs.torque], column 'torque (N)', for [[model.load]] 'motor', torque: the unit 'N'",
        ),
        ({"torque": "torque (N)", "more_input": 'unit = "mm"'}, "the unit 'mm' was given; expected that of a torque"),
        ({"more": 'deviations = { "bar.start.angle" = "1 s" }'}, "deviations, bar.start.angle: '1 s' was given"),
        ({"more": 'sensors."bar.start.angle".x = 1'}, "unknown key 'sensors'"),
        (
            {"more": '[sensors."bar.start.angle"]\noffset = ["-1 mm", "1 mm"]'},
            "[sensors], offset of, bar.start.angle: '-1 mm'",
        ),
        ({"constant": "0.8 kg"}, "length: 'L' was given, but it measures something else, in kg"),
        ({"length": "2*L**2/L"}, ""),
        ({"length": "L*L"}, "length: 'L*L' was given, but it measures something else, in m^2"),
        ({"length": "drag"}, "length: 'drag' was given, but it measures something else, in N*m*s"),
        ({"length": "L + drag"}, "'L + drag' adds quantities of different kinds"),
    ],
)
def test_another_kind_is_a_sentence(study, changed, sentence):
    if not sentence:
        plan(study(**changed))
        return
    with pytest.raises((DataError, InputError)) as caught:
        plan(study(**changed))
    assert sentence in str(caught.value)


@pytest.mark.parametrize(
    ("changed", "sentence"),
    [
        (
            {"channel": "bar.end.x", "angle": "x", "more": 'wraps = ["bar.end.x"]'},
            "wraps names the channel 'bar.end.x', which is in m and no angle; leave it out",
        ),
        (
            {"more": 'derivatives = { "bar.end.x" = "bar.start.angle" }'},
            "[data], derivatives, bar.end.x: a derivative of 'bar.start.angle' in rad of order 1 was given for a channel "
            "in m; expected one of the channel's kind",
        ),
        (
            {"more": 'derivatives = { "bar.start.rate" = { of = "bar.start.angle", order = 2 } }'},
            "of order 2 was given",
        ),
        ({"more": 'derivatives = { "bar.start.rate" = "bar.start.angle" }\nwraps = ["bar.start.angle"]'}, ""),
    ],
)
def test_turns_and_derivatives_have_the_kind_of_their_channel(study, changed, sentence):
    if not sentence:
        posed(study(**changed))
        return
    with pytest.raises((DataError, InputError)) as caught:
        plan(study(**changed))
    assert sentence in str(caught.value)


@pytest.mark.parametrize("more", ["scale = 0.5", 'integrals = 1\nunit = "N*m*s^-1"', 'integrals = 2\nunit = "N*m/s^2"'])
def test_a_scale_or_integrals_change_the_kind_of_an_input(study, more):
    plan(study(torque="current (A)" if "scale" in more else "torque", more_input=more))


@pytest.mark.parametrize(
    ("torque", "scale", "sentence"),
    [
        ("current (A)", '"0.05 N*m/A"', ""),
        ("current (mA)", '"0.02 N*m/A"', ""),
        ("current (A)", '"L"', "the column in 'A' times a scale in m is in m*A; expected a torque"),
        ("current (A)", '"0.05 N/A"', "is in N; expected a torque such as '500 N*mm'"),
        ("current", '"0.05 N/A"', ""),
        (
            "torque (Nm)",
            '2.0\noffset = "3 N"',
            "[inputs.torque], offset, for [[model.load]] 'motor', torque: its unit is N",
        ),
        ("torque (Nm)", '2.0\noffset = "3 Nmm"', ""),
    ],
)
def test_a_scale_with_a_unit_must_give_what_the_input_drives(study, torque, scale, sentence):
    case = study(torque=torque, more_input=f"scale = {scale}")
    if not sentence:
        plan(case)
        return
    with pytest.raises(DataError) as caught:
        plan(case)
    assert sentence in str(caught.value)


EXPERIMENTS = """
[[experiments]]
name = "a"
file = "run.csv"
time = "t (s)"
columns = {{ "bar.start.angle" = "angle (deg)" }}
constants = {{ {constant} }}
"""


@pytest.mark.parametrize(
    ("shared", "constant", "sentence"),
    [
        ("50 cm", 'L = "40 cm"', ""),
        ("0.5", 'L = "40 cm"', ""),
        ("50 cm", "L = 0.4", ""),
        ("50 cm", 'L = "0.8 kg"', "constants: L: '0.8 kg' was given; expected a length such as '400 mm'"),
        ("0.5", 'L = "0.8 kg"', "[[experiments]] 'a', constants: [[model.body]] 'bar', length: 'L' was given"),
    ],
)
def test_a_constant_of_an_experiment_has_the_kind_of_the_shared_one(study, tmp_path, shared, constant, sentence):
    study(constant=shared)
    text = (tmp_path / "study.toml").read_text()
    begin, end = text.index("[data]"), text.index("[identify]")
    text = text[:begin] + EXPERIMENTS.format(constant=constant) + text[end:]
    (tmp_path / "study.toml").write_text(
        text.replace(f'L = "{shared}"', f"L = {shared}" if shared == "0.5" else f'L = "{shared}"', 1)
    )
    if not sentence:
        load(tmp_path / "study.toml")
        return
    with pytest.raises(InputError) as caught:
        load(tmp_path / "study.toml")
    assert sentence in str(caught.value)


def test_a_reading_with_a_gain_may_have_any_unit(study):
    more = 'deviations = { "bar.start.angle" = "5 mV" }\n[sensors."bar.start.angle"]\ngain = [0.1, 10]\noffset = ["-1 V", "1 V"]'
    plan(study(angle="angle (V)", more=more))


def test_a_gram_of_acceleration_is_the_one_of_gravity(study):
    _, data = posed(study(channel="bar.end.ax", angle="a (g)"))
    assert data.values[-1, 0] == pytest.approx(30 * 9.80665)


def test_milliseconds_read_as_seconds_are_named_before_a_fit(study, tmp_path):
    case = study(torque="torque")
    times = np.arange(101) * 10.0
    rows = [f"{t:.1f};{-90 + 20 * np.cos(5e-3 * t):.4f};0.01" for t in times]
    (tmp_path / "run.csv").write_text("\n".join(["t (s);angle (deg);torque", *rows]) + "\n")
    (finding,) = time_scale_findings(case)
    assert (finding.code, finding.values["step"]) == ("suspect-time-unit", 10.0)
    assert next(forecast(case)) == f"Warning: {finding}"
    (tmp_path / "run.csv").write_text("\n".join(["t (ms);angle (deg);torque", *rows]) + "\n")
    text = (tmp_path / "study.toml").read_text().replace('"t (s)"', '"t (ms)"')
    (tmp_path / "study.toml").write_text(text)
    assert list(time_scale_findings(load(tmp_path / "study.toml"))) == []
