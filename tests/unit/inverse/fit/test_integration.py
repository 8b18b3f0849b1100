"""The bias that the integrator's error causes: closed forms, findings, models of several parts, and failures."""

import numpy as np
import pytest

from dalembert.data import Measurements
from dalembert.forward import Checkpoint, PythonModel, Recorded, Sensor, Sensors
from dalembert.inverse import Experiment, Fit, MultipleShooting, ShootingState, identify
from dalembert.parameter import Parameter
from stepped_models import STEPPED_BOX, TIMES, TRUTH, Stepped, decay_in_steps, exact, failing, marked, quick_in_steps


def codes(fit):
    return [finding.code for finding in fit.findings]


def test_the_bias_is_that_of_the_identified_values():
    """Without noise the fit at coarse steps is off by the bias alone."""
    fit = identify(Stepped(), exact(deviations=1e-3), starts=1)
    error = fit.values - TRUTH
    assert np.all(np.abs(error) > 3 * fit.plain_deviations)
    np.testing.assert_allclose(fit.integration.bias, error, rtol=0.02)
    fine = identify(Stepped(0.2), exact(deviations=1e-3), starts=1)
    np.testing.assert_allclose(fit.integration.bias / fine.integration.bias, 16, rtol=0.07)


def test_a_large_bias_is_a_finding_and_a_small_one_is_not():
    fit = identify(Stepped(), exact(1e-3, 1e-3), starts=1)
    finding = next(finding for finding in fit.findings if finding.code == "integration-bias")
    assert finding.doubtful
    assert finding.values["parameter"] == "size"
    assert finding.values["deviations"] == pytest.approx(np.max(np.abs(fit.integration.bias / fit.deviations)))
    assert "at half the step" in finding.message
    assert "integration-bias" not in codes(identify(Stepped(0.01), exact(1e-3, 1e-3), starts=1))


def test_an_error_that_biases_no_parameter_is_a_note():
    fit = identify(Stepped(method=quick_in_steps), exact(1e-3, 1e-3), starts=1)
    finding = next(finding for finding in fit.findings if finding.code == "integration-bias")
    assert finding.severity == "note"
    assert finding.values["deviations"] < 0.5 < abs(finding.values["change"])


def test_the_misfit_with_converged_steps():
    data = exact(1e-3, 1e-3)
    fit = identify(Stepped(), data, starts=1)
    converged = fit.values[1] * np.exp(-fit.values[0] * TIMES)
    same = np.sum(((converged - data.values[:, 0]) / 1e-3) ** 2)
    assert fit.integration.misfit == pytest.approx(same, rel=1e-4)
    fine = identify(Stepped(0.01), data, starts=1)
    assert fit.integration.corrected == pytest.approx(fine.misfit, rel=0.02)
    assert fit.integration.misfit > 2 * fine.misfit


def test_it_is_one_simulation():
    plain = PythonModel(lambda rate, size: decay_in_steps(rate, size, 0.8), STEPPED_BOX, ["x"], TIMES)
    fit, without = (identify(model, exact(1e-3, 1e-3), starts=1) for model in (Stepped(), plain))
    assert fit.simulations == without.simulations + 1
    np.testing.assert_array_equal(fit.values, without.values)
    assert without.integration is None
    assert np.isnan(without.integration_bias).all()


def test_data_of_the_same_steps_are_recognised():
    noisy = decay_in_steps(*TRUTH, 0.8) + 1e-3 * np.random.default_rng(1).standard_normal(101)
    fit = identify(Stepped(), Measurements.of(TIMES, {"x": noisy}, 1e-3), starts=1)
    (finding,) = fit.findings
    assert (finding.code, finding.severity) == ("integration-bias", "note")
    assert "simulated with the same steps" in finding.message
    assert not identify(Stepped(), Measurements.of(TIMES, {"x": decay_in_steps(*TRUTH, 0.8)}), starts=1).findings


@pytest.mark.parametrize("finer", [failing, marked])
def test_a_finer_simulation_that_fails_is_said_and_the_fit_stays(finer):
    fit = identify(Stepped(finer=finer), exact(1e-3, 1e-3), starts=1)
    assert fit.success
    assert np.isfinite(fit.deviations).all()
    finding = next(finding for finding in fit.findings if finding.code == "integration-bias-unknown")
    assert not finding.doubtful
    assert "too stiff" in finding.message
    assert np.isnan(fit.integration.bias).all()
    assert "bias by the integrator" not in fit.facts()


def test_only_experiments_that_can_be_refined_are():
    plain = PythonModel(lambda rate, size: size * np.exp(-rate * TIMES), STEPPED_BOX, ["x"], TIMES)
    data = exact(deviations=1e-3)
    both = [Experiment("a", Stepped(), data, local=("size",)), Experiment("b", plain, data, local=("size",))]
    fit = identify(both, starts=1)
    alone = identify(both[:1], starts=1)
    names = list(fit.parameters.names)
    bias = dict(zip(names, fit.integration.bias, strict=True))
    np.testing.assert_allclose(bias["rate"], fit.values[names.index("rate")] - 0.8, rtol=0.02)
    np.testing.assert_allclose(bias["a.size"], fit.values[names.index("a.size")] - 2, rtol=0.02)
    assert 0 < abs(bias["rate"]) < abs(alone.integration.bias[0])
    assert identify(both[1:], starts=1).integration is None


def test_a_prior_and_a_robust_loss():
    known = {"rate": STEPPED_BOX["rate"], "size": Parameter("size", 0.5, 4.0, start=2.0, deviation=1e-6)}
    fit = identify(Stepped(box=known), exact(deviations=1e-3), starts=1)
    np.testing.assert_allclose(fit.integration.bias, fit.values - TRUTH, rtol=0.02, atol=1e-7)
    assert abs(fit.integration.bias[1]) < 1e-6
    robust = identify(Stepped(), exact(deviations=1e-3), starts=1, loss="huber")
    np.testing.assert_allclose(robust.integration.bias, robust.values - TRUTH, rtol=0.02)


def test_sensors_and_wrapping_channels():
    seen = Sensors(Stepped(), {"x": Sensor(gain=(0.5, 2.0))})
    assert seen.refined().model.model.step == 0.4
    turned = Measurements.of(TIMES, {"x": np.angle(np.exp(1j * exact().values[:, 0]))}, 1e-3, wraps=["x"])
    fit = identify(Stepped(), turned, starts=1)
    np.testing.assert_allclose(fit.integration.bias, fit.values - TRUTH, rtol=0.02)


def test_held_out_samples_do_not_count():
    fit = identify(Stepped(), exact(deviations=1e-3), starts=1, validation=0.5)
    np.testing.assert_allclose(fit.integration.bias, fit.values - TRUTH, rtol=0.02)


def test_a_checkpoint_answers_for_the_finer_model_too(tmp_path):
    data, asked = exact(1e-3, 1e-3), []

    def counted(model):
        asked.append(model.step)
        return model

    with Checkpoint(tmp_path / "checkpoint") as checkpoint:
        first = identify(Recorded(Stepped(finer=counted), checkpoint), data, starts=1)
        again = identify(Recorded(Stepped(finer=counted), checkpoint), data, starts=1)
    assert asked == [0.4, 0.4]
    np.testing.assert_array_equal(first.integration.bias, again.integration.bias)
    assert np.any(first.integration.bias)
    assert first.integration.misfit == again.integration.misfit


def test_segments_that_merged_are_one_run():
    states = {"size": ShootingState("x", 0.01, 4.0)}
    shooting = MultipleShooting(states, segments=2)
    fit = identify(Stepped(0.05), exact(deviations=1e-3), shooting=shooting, starts=1)
    assert fit.nodes.segments == 1
    np.testing.assert_allclose(fit.integration.bias, fit.values - TRUTH, rtol=0.02)
    apart = identify(Stepped(), exact(deviations=1e-3), shooting=shooting, starts=1)
    assert apart.nodes.segments == 2
    assert "segments" in next(item.message for item in apart.findings if item.code == "integration-bias-unknown")


def test_a_file_gives_back_the_same_bits(tmp_path):
    fit = identify(Stepped(), exact(1e-3, 1e-3), starts=1)
    fit.save(tmp_path / "fit.nc")
    again = Fit.load(tmp_path / "fit.nc")
    np.testing.assert_array_equal(again.integration.bias, fit.integration.bias)
    assert again.integration.how == fit.integration.how
    for name in ("misfit", "corrected", "remainder"):
        assert getattr(again.integration, name) == getattr(fit.integration, name)
    assert "at half the step" in again.summary()
