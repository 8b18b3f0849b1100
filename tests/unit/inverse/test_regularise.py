"""Smooth parameters by regularised least squares."""

import numpy as np
import pytest
from inline_snapshot import snapshot
from scipy.optimize import least_squares

import dalembert as da
from dalembert.errors import InputError
from dalembert.inverse.regularised.smoothness import Smoothed, differences
from refusals import refused
from regularised_cases import COUNT, MODEL, TIMES, TRUTH, measured

HATS = np.array([np.interp(TIMES, np.linspace(0.0, 1.0, COUNT), unit) for unit in np.eye(COUNT)])
MATRIX = np.cumsum(HATS.T, axis=0) / 40
BOX = {f"c{k}": (-2.0, 2.0) for k in range(COUNT)}
LINEAR = da.PythonModel(lambda **c: MATRIX @ np.array(list(c.values())), BOX, ["x"], TIMES)


def noisy(deviations: float | None = 1e-3) -> da.Measurements:
    """The linear response to a half wave, with noise of a thousandth."""
    values = MATRIX @ TRUTH + 1e-3 * np.random.default_rng(0).normal(size=len(TIMES))
    return da.Measurements.of(TIMES, {"x": values}, deviations=None if deviations is None else {"x": deviations})


@pytest.mark.parametrize("order", [1, 2])
def test_a_linear_model_has_the_solution_of_the_normal_equations(order: int) -> None:
    fit = da.regularise(LINEAR, noisy(), order=order, weight=3.0)
    scale = LINEAR.parameters.scale
    d = np.diff(np.eye(COUNT), n=order, axis=0) / scale
    normal = MATRIX.T @ MATRIX * 1e6 + 9.0 * d.T @ d
    expected = np.linalg.solve(normal, MATRIX.T @ noisy().values[:, 0] * 1e6)
    np.testing.assert_allclose(fit.values, expected, rtol=0, atol=1e-6)
    np.testing.assert_allclose(fit.deviations, np.sqrt(np.diag(np.linalg.inv(normal))), rtol=1e-6)
    assert fit.rule == "given"
    assert not fit.findings


def test_a_given_weight_has_the_minimum_of_the_nonlinear_problem() -> None:
    """Against SciPy's least squares of the residuals with the rows of the penalty below them."""
    rows = 0.5 * np.diff(np.eye(COUNT), n=2, axis=0) / MODEL.parameters.scale

    def residuals(vector: np.ndarray) -> np.ndarray:
        response = MODEL.evaluate(vector[None]).values[0, :, 0]
        return np.concatenate([(response - measured().values[:, 0]) / 1e-3, rows @ vector])

    other = least_squares(residuals, np.zeros(COUNT), xtol=1e-14, ftol=1e-14, gtol=1e-10)
    fit = da.regularise(MODEL, measured(), weight=0.5)
    np.testing.assert_allclose(fit.values, other.x, rtol=0, atol=0.05 * fit.deviations.max())
    assert not fit.findings


def test_norms_of_the_standard_form_are_those_of_the_solutions() -> None:
    matrix = np.random.default_rng(0).normal(size=(20, 7))
    many = Smoothed(matrix, np.arange(20.0), differences(np.arange(7), 7, 2))
    for weight in (0.1, 1.0, 30.0):
        z = many.solution(weight)
        residual, step = np.linalg.norm(matrix @ z - many.right), np.linalg.norm(many.penalty @ z)
        assert many.standard.residual_norms(weight) == pytest.approx(residual, rel=1e-10)
        assert many.standard.step_norms(weight) == pytest.approx(step, rel=1e-10)


def test_a_large_weight_leaves_the_line_that_explains_the_data_best() -> None:
    fit = da.regularise(LINEAR, noisy(), weight=1e7)
    lines = np.stack([np.ones(COUNT), np.arange(COUNT)], axis=1)
    line, *_ = np.linalg.lstsq(MATRIX @ lines, noisy().values[:, 0])
    np.testing.assert_allclose(fit.values, lines @ line, rtol=0, atol=1e-4)
    assert fit.effective == pytest.approx(2.0, abs=1e-3)


def test_the_discrepancy_principle_leaves_residuals_as_large_as_the_noise() -> None:
    fit = da.regularise(MODEL, measured(), weight="discrepancy")
    assert fit.residual_norm == pytest.approx(np.sqrt(len(TIMES)), rel=0.02)
    assert fit.weight == fit.discrepancy


def test_both_rules_come_near_the_truth() -> None:
    for rule in ("l-curve", "discrepancy"):
        fit = da.regularise(MODEL, measured(), weight=rule)
        assert np.abs(fit.values - TRUTH).max() < 0.06
        assert fit.vector["c3"] == fit.values[3]


def test_parameters_that_are_not_smooth_are_not_penalised() -> None:
    def response(gain: complex, **c: complex) -> np.ndarray:
        return gain + MATRIX @ np.array(list(c.values()))

    model = da.PythonModel(response, {"gain": (-1.0, 1.0), **BOX}, ["x"], TIMES)
    data = da.Measurements.of(TIMES, {"x": 0.5 + MATRIX @ TRUTH}, deviations={"x": 1e-3})
    fit = da.regularise(model, data, smooth=list(BOX), weight=0.1)
    assert fit.values[0] == pytest.approx(0.5, abs=1e-3)
    assert fit.smooth == tuple(BOX)


def test_without_deviations_the_noise_is_estimated() -> None:
    known, unknown = da.regularise(LINEAR, noisy(), weight=1.0), da.regularise(LINEAR, noisy(None), weight=1e-3)
    np.testing.assert_allclose(known.values, unknown.values, rtol=0, atol=1e-6)
    np.testing.assert_allclose(unknown.deviations / known.deviations, 0.87, rtol=0.2)
    assert np.isnan(unknown.discrepancy)


def test_it_is_stored_and_read(tmp_path) -> None:
    fit = da.regularise(MODEL, measured())
    fit.save(tmp_path / "fit.nc")
    again = da.RegularisedFit.load(tmp_path / "fit.nc")
    np.testing.assert_array_equal(again.values, fit.values)
    assert again.summary() == fit.summary()
    np.testing.assert_array_equal(again.residuals, fit.residuals)


def test_what_cannot_be_meant_is_refused() -> None:
    with refused(
        InputError,
        snapshot(
            "regularise: the discrepancy principle needs the noise of the data. Give their deviations, or take "
            "weight='l-curve'"
        ),
    ):
        da.regularise(MODEL, measured(deviations=False), weight="discrepancy")
    with refused(
        InputError,
        snapshot(
            "regularise: 2 smooth parameters have no differences of order 2. Name more of them, or lower the order"
        ),
    ):
        da.regularise(MODEL, measured(), smooth=["c1", "c2"])
    with refused(
        InputError,
        snapshot("regularise: unknown parameter 'cc'; known: c0, c1, c10, c11, c2, c3, c4, c5, c6, c7, c8, c9"),
    ):
        da.regularise(MODEL, measured(), smooth=["c1", "c2", "cc"])
    with refused(InputError, snapshot("regularise: unknown weight 'corner'; known: discrepancy, l-curve")):
        da.regularise(MODEL, measured(), weight="corner")


def test_the_response_is_that_of_the_values_and_each_round_is_an_event() -> None:
    events = []
    fit = da.regularise(MODEL, measured(), on_event=events.append)
    np.testing.assert_allclose(fit.response, MODEL.evaluate(fit.values[None]).values[0], rtol=0, atol=1e-12)
    weighted = fit.residuals / measured().deviations
    assert np.linalg.norm(weighted) == pytest.approx(fit.residual_norm, rel=1e-9)
    assert {event.kind for event in events} == {"penalised"}
    rounds = [event.round for event in events]
    assert rounds == sorted(rounds)
    assert rounds[0] == 1


BLUR = 0.1 * np.exp(-0.5 * ((np.linspace(0, 1, 60)[:, None] - np.linspace(0, 1, 20)) / 0.08) ** 2)
COEFFICIENTS = [f"u{k}" for k in range(20)]


def blurred(deviation: float) -> tuple[da.PythonModel, da.Measurements]:
    """A history that the data determine after blurring only, with noise of 0.01."""
    along, times = np.linspace(0, 1, 20), np.linspace(0, 1, 60)
    box = dict.fromkeys(COEFFICIENTS, (-10.0, 10.0))
    model = da.PythonModel(lambda **u: BLUR @ np.array([u[name] for name in COEFFICIENTS]), box, ["x"], times)
    values = BLUR @ np.sin(4 * along) + 0.01 * np.random.default_rng(0).standard_normal(60)
    return model, da.Measurements.of(times, {"x": values}, deviations=deviation)


def test_parameters_that_nothing_determines_are_named() -> None:
    box, times = dict.fromkeys(COEFFICIENTS, (-9.0, 9.0)), np.linspace(0, 1, 60)
    flat = da.PythonModel(lambda **u: u["u0"] + u["u1"] * times + u["u2"] * times**2, box, ["x"], times)
    with refused(
        InputError,
        snapshot(
            "regularise: neither the data nor the penalty determine 'u3', 'u4', 'u5', 'u6' and 13 others. Name them in "
            "smooth, fix them by equal bounds, or measure what shows them"
        ),
    ):
        da.regularise(flat, blurred(0.01)[1], smooth=["u0", "u1", "u2"])
    with refused(
        InputError,
        snapshot(
            "regularise: smooth names 'u0' more than once. Name each parameter once, in the order in which the values "
            "change smoothly"
        ),
    ):
        da.regularise(*blurred(0.01), smooth=[*COEFFICIENTS, "u0"])


def test_the_discrepancy_principle_needs_a_weight_that_balances_the_noise() -> None:
    with refused(
        InputError,
        snapshot(
            "regularise: parameters whose penalty is 0 explain the data within their standard deviations, so that the "
            "discrepancy principle gives no weight. Correct the deviations of the data, or give a weight"
        ),
    ):
        da.regularise(*blurred(100.0), weight="discrepancy")
    finding, beyond = da.regularise(*blurred(0.001), weight="discrepancy").findings
    assert (finding.code, beyond.code) == ("misfit-above-noise", "values-beyond-bounds")
    assert finding.values["ratio"] > 5
    assert da.regularise(*blurred(0.01), weight="discrepancy").findings == ()
