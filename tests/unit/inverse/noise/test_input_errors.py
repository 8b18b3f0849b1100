"""Errors of a measured input as parameters."""

import numpy as np
import pytest

import dalembert as da

TIMES = np.linspace(0.0, 1.0, 31)


def test_a_spline_through_few_knots_is_smooth():
    errors = da.input_errors("force", TIMES, deviation=0.2, knots=4, unit="N")
    assert [item.name for item in errors.parameters] == [f"force.error{k}" for k in range(1, 5)]
    assert {(item.unit, item.deviation, item.start) for item in errors.parameters} == {("N", 0.2, 0.0)}
    cubic = {f"force.error{k}": value**3 for k, value in enumerate(np.linspace(0.0, 1.0, 4), start=1)}
    assert errors.values(cubic) == pytest.approx(TIMES**3)
    line = da.input_errors("force", TIMES, deviation=0.2, knots=[0.0, 1.0])
    assert line.values({"force.error1": 1.0, "force.error2": 3.0 + 1j}) == pytest.approx(1 + (2 + 1j) * TIMES)


@pytest.mark.parametrize(
    ("settings", "message"),
    [
        ({"deviation": 0.0}, "input_errors: deviation is 0.0; expected a positive number"),
        ({"deviation": 0.1, "knots": 1}, "input_errors: knots is 1; expected at least 2"),
        (
            {"deviation": 0.1, "knots": [1.0, 0.0]},
            "input_errors: knots are [1.0, 0.0]; expected at least two increasing numbers",
        ),
    ],
)
def test_what_cannot_be_is_refused(settings, message):
    with pytest.raises(da.InputError) as refused:
        da.input_errors("force", TIMES, **settings)
    assert str(refused.value) == message
