"""Data with another zero than the response: suspected, and not where units or motions differ."""

import numpy as np
import pytest

from dalembert.data import Measurements
from dalembert.forward import Channel, PythonModel
from dalembert.inverse.plausibility.suspect_offsets import first_findings
from dalembert.parameter import Parameter
from dalembert.parameters import Parameters

TIMES = np.linspace(0, 4, 81)
SWING = 0.5 * np.exp(-0.2 * TIMES) * np.cos(3 * TIMES)
MODEL = PythonModel(
    lambda size: size * SWING - np.pi / 2,
    Parameters((Parameter("size", 0.1, 3.0, start=1.0),)),
    [Channel("angle", "rad")],
    TIMES,
)


def findings(values, **options):
    return first_findings(MODEL, Measurements.of(TIMES, {"angle": values}, **options))


def test_an_angle_from_the_vertical_is_suspected():
    (finding,) = findings(0.6 * SWING)
    assert (finding.code, finding.severity) == ("suspect-offset", "warning")
    assert finding.values["difference"] == pytest.approx(np.pi / 2, abs=0.02)
    assert finding.values["lower"] < np.pi / 2 < finding.values["upper"]
    assert f"offset = [{finding.values['lower']:g}, {finding.values['upper']:g}]" in finding.advice


def test_a_wrong_unit_is_no_offset():
    assert [finding.code for finding in findings(np.rad2deg(SWING - np.pi / 2))] == ["suspect-unit"]


def test_other_motions_have_no_offset():
    for values in (2 * SWING - np.pi / 2, -SWING - np.pi / 2, 0.3 * SWING - 1.5):
        assert findings(values) == ()


def test_wrapping_and_constant_channels_are_not_judged():
    assert findings(0.6 * SWING, wraps=["angle"]) == ()
    assert [one.code for one in findings(np.zeros(81))] == ["suspect-offset"]


def test_an_outlier_does_not_hide_an_offset():
    values = 0.6 * SWING
    values[40] = 30.0
    (finding,) = findings(values)
    assert finding.code == "suspect-offset"
    assert finding.values["difference"] == pytest.approx(np.pi / 2, abs=0.02)
