"""identify_bands: closed forms, fixed unknowns, logarithms, weights, methods, events, seeds, refusals."""

import re

import numpy as np
import pytest
from inline_snapshot import snapshot

import dalembert
from conclusions import codes, only
from dalembert.data import Bands
from dalembert.errors import DataError, InputError, SolveError
from dalembert.findings import Finding
from dalembert.forward import PythonModel
from dalembert.inverse import GlobalSurrogate, Nested, as_record, identify_bands
from dalembert.optimize import ImprovedParticleSwarm, ParticleSwarm
from dalembert.surrogate import Adaptive, Tensor, TotalDegree
from small_models import DECAY, LINE, TIMES, banded
from support import says

EXACT = banded(DECAY, [1.8, 0.7], [2.2, 0.9], points=2)


def noisy(bands, deviation, seed):
    """Return bands of one channel with normal noise on each bound, exchanged where they cross."""
    noise = deviation * np.random.default_rng(seed).standard_normal((2, len(bands.lower)))
    lower, upper = np.sort([bands.lower[:, 0] + noise[0], bands.upper[:, 0] + noise[1]], axis=0)
    return Bands.of(bands.coordinate, {bands.channels[0]: (lower, upper)})


NESTED = Nested(ImprovedParticleSwarm(particles=24, iterations=60, velocity_limit=0.05))


def test_bands_of_a_monotonic_model_give_back_their_box():
    fit = identify_bands(DECAY, EXACT)
    np.testing.assert_allclose(fit.box.lower, [1.8, 0.7], rtol=1e-6)
    np.testing.assert_allclose(fit.box.upper, [2.2, 0.9], rtol=1e-6)
    assert fit.success
    assert fit.misfit < 1e-10
    assert fit.checked_misfit < 1e-10
    np.testing.assert_allclose(fit.checked_lower, EXACT.lower, atol=1e-6)
    np.testing.assert_allclose(fit.lower, fit.checked_lower, atol=1e-6)


def test_bounds_inside_the_box_count_as_those_at_its_corners():
    """x² about zero: the lower bound is taken inside, and only the upper one tells the box."""
    model = PythonModel(lambda x: np.array([x**2, x]), {"x": (-2.0, 3.0)}, ["y"], np.arange(2.0))
    fit = identify_bands(model, Bands.of(np.arange(2.0), {"y": ([0.0, -0.5], [1.0, 1.0])}))
    np.testing.assert_allclose([fit.box.lower[0], fit.box.upper[0]], [-0.5, 1.0], atol=1e-6)


def test_a_parameter_that_is_no_interval_is_identified_as_a_number():
    bands = banded(DECAY, [2.0, 0.7], [2.0, 0.9])
    fit = identify_bands(DECAY, bands, intervals=["rate"])
    assert fit.unknowns == ("size middle", "rate middle", "rate radius")
    assert fit.intervals == ("rate",)
    assert fit.box.lower[0] == fit.box.upper[0] == pytest.approx(2.0, rel=1e-6)
    np.testing.assert_allclose([fit.box.lower[1], fit.box.upper[1]], [0.7, 0.9], rtol=1e-6)
    assert fit.radius_deviations[0] == 0
    assert fit.correlation.shape == (3, 3)


def test_a_parameter_whose_bands_ask_for_no_interval_gets_none_and_it_is_said():
    fit = identify_bands(DECAY, banded(DECAY, [2.0, 0.7], [2.0, 0.9]))
    assert fit.radius[0] < 1e-6
    assert only(fit, "zero-radius").values["parameter"] == "size"


def test_with_no_interval_at_all_bands_without_width_are_measurements():
    bands = banded(DECAY, [2.0, 0.8], [2.0, 0.8])
    fit = identify_bands(DECAY, bands, intervals=[])
    np.testing.assert_allclose(fit.middle, [2.0, 0.8], rtol=1e-6)
    np.testing.assert_array_equal(fit.radius, 0)


def test_a_parameter_over_decades_is_searched_by_its_logarithm():
    model = PythonModel(
        lambda stiffness: np.sin(np.log10(stiffness) * TIMES / 4), {"stiffness": (1e3, 1e9)}, ["x"], TIMES
    )
    fit = identify_bands(model, banded(model, [2e6], [3e6]))
    np.testing.assert_allclose([fit.box.lower[0], fit.box.upper[0]], [2e6, 3e6], rtol=1e-5)
    np.testing.assert_allclose(fit.middle, 2.5e6, rtol=1e-5)


def test_deviations_are_those_of_the_linear_closed_form():
    """With offsets alone, each bound is an end of the interval plus noise: the ends are means of as many values."""
    model = PythonModel(lambda offset: offset + 0 * TIMES, {"offset": (-5.0, 5.0)}, ["x"], TIMES)
    random = np.random.default_rng(0)
    lower, upper = 1 + 0.1 * random.standard_normal(41), 3 + 0.1 * random.standard_normal(41)
    fit = identify_bands(model, Bands.of(TIMES, {"x": (lower, upper)}))
    np.testing.assert_allclose([fit.box.lower[0], fit.box.upper[0]], [lower.mean(), upper.mean()], rtol=1e-7)
    squares = np.sum((lower - lower.mean()) ** 2) + np.sum((upper - upper.mean()) ** 2)
    deviation = np.sqrt(squares / (82 - 2) / 82)
    np.testing.assert_allclose(fit.misfit, squares, rtol=1e-9)
    np.testing.assert_allclose([fit.middle_deviations[0], fit.radius_deviations[0]], deviation, rtol=1e-7)
    np.testing.assert_allclose(fit.correlation, np.eye(2), atol=1e-9)


@pytest.mark.slow
def test_deviations_say_how_far_identified_middles_and_radii_scatter():
    """Over 40 noisy bands, the scatter is the mean of the deviations within 25 %."""
    fits = []
    for seed in range(40):
        noise = 0.01 * np.random.default_rng(seed).standard_normal((2, *EXACT.lower.shape))
        lower, upper = np.sort([EXACT.lower + noise[0], EXACT.upper + noise[1]], axis=0)
        bands = Bands.of(TIMES, {"x": (lower[:, 0], upper[:, 0])})
        fits.append(
            identify_bands(DECAY, bands, method=GlobalSurrogate(Adaptive(1e-5), starts=1, checks=0, tolerance=0.1))
        )
    for own, deviation in (("middle", "middle_deviations"), ("radius", "radius_deviations")):
        scatter = np.std([getattr(fit, own) for fit in fits], axis=0)
        np.testing.assert_allclose(np.mean([getattr(fit, deviation) for fit in fits], axis=0), scatter, rtol=0.25)


def test_a_weight_of_zero_leaves_a_channel_out():
    bands = banded(LINE, [1.0, 2.0], [1.5, 2.5], points=2)
    wrong = Bands.of(
        TIMES, {"x": (bands.lower[:, 0] + 7, bands.upper[:, 0] + 9), "y": (bands.lower[:, 1], bands.upper[:, 1])}
    )
    fit = identify_bands(LINE, wrong, weights=[0.0, 2.0])
    np.testing.assert_allclose(fit.box.lower, [1.0, 2.0], rtol=1e-6)
    np.testing.assert_allclose(fit.box.upper, [1.5, 2.5], rtol=1e-6)


def test_a_model_may_have_more_channels_than_the_bands_in_another_order():
    whole = banded(LINE, [1.0, 2.0], [1.5, 2.5], points=2)
    fit = identify_bands(LINE, Bands.of(TIMES, {"y": (whole.lower[:, 1], whole.upper[:, 1])}))
    np.testing.assert_allclose(fit.box.upper, [1.5, 2.5], rtol=1e-6)
    assert fit.lower.shape == (41, 1)


METHODS = [GlobalSurrogate(), GlobalSurrogate(Tensor(6), Tensor(6)), GlobalSurrogate(TotalDegree(6)), NESTED]


@pytest.mark.parametrize("method", METHODS, ids=["adaptive", "tensor", "total degree", "nested"])
def test_every_method_goes_through_the_same_call_and_ends_with_the_same_bits(method):
    one, same = (identify_bands(DECAY, EXACT, method=method, seed=4) for _ in range(2))
    np.testing.assert_allclose(one.box.lower, [1.8, 0.7], rtol=0.03)
    np.testing.assert_allclose(one.box.upper, [2.2, 0.9], rtol=0.03)
    for name in ("lower", "upper", "error", "correlation", "middle_deviations", "radius_deviations", "checked_lower"):
        assert getattr(one, name).tobytes() == getattr(same, name).tobytes(), name
    assert one.box.lower.tobytes() == same.box.lower.tobytes()
    assert [step.best for step in one.history] == [step.best for step in same.history]
    assert (one.simulations, one.status, one.provenance) == (same.simulations, same.status, same.provenance)


@pytest.mark.parametrize(("name", "kind"), [("global", GlobalSurrogate), (None, GlobalSurrogate)])
def test_methods_have_names(name, kind):
    assert identify_bands(DECAY, EXACT, method=name).provenance["method"]["name"] == kind.__name__


def test_nested_costs_what_is_published_and_then_its_answer_once_more_with_a_check():
    method = Nested(ParticleSwarm(particles=10, iterations=5))
    events = []
    fit = identify_bands(DECAY, EXACT, method=method, on_event=events.append)
    assert fit.method == "nested ParticleSwarm"
    assert fit.history[-1].simulations == 10 * 5 * 12
    assert 10 * 5 * 12 + 12 < fit.simulations < 10 * 5 * 12 + 12 + 2 * 2 * 41
    assert [step.best for step in fit.history] == sorted((step.best for step in fit.history), reverse=True)
    assert fit.misfit == pytest.approx(fit.history[-1].best, rel=1e-6)


def test_nested_with_a_number_among_the_intervals_makes_runs_only_along_the_intervals():
    bands = banded(DECAY, [2.0, 0.7], [2.0, 0.9])
    fit = identify_bands(DECAY, bands, intervals=["rate"], method=NESTED)
    assert fit.history[-1].simulations == 24 * 60 * 6
    np.testing.assert_allclose(fit.middle, [2.0, 0.8], rtol=0.03)
    assert fit.radius[0] == 0
    assert np.isfinite(fit.middle_deviations).all()


def test_events_tell_of_runs_starts_checks_and_the_end():
    events = []
    fit = identify_bands(DECAY, EXACT, on_event=events.append)
    kinds = [event.kind for event in events]
    assert kinds[0] == "sampled"
    assert kinds[-1] == "finished"
    assert {"start-began", "iteration", "start-ended", "checked"} <= set(kinds)
    assert kinds.count("start-ended") == len(fit.starts)
    last = [event for event in events if event.kind == "checked"][-1]
    assert last.misfit == pytest.approx(fit.checked_misfit)
    assert last.simulations == fit.simulations
    np.testing.assert_array_equal(events[-1].values, np.concatenate([fit.middle, fit.radius]))
    assert all(isinstance(as_record(event)["event"], str) for event in events)


def test_bands_that_no_box_has_show_themselves():
    lower, upper = EXACT.lower.copy(), EXACT.upper.copy()
    upper[20] += 0.5
    fit = identify_bands(DECAY, Bands.of(TIMES, {"x": (lower[:, 0], upper[:, 0])}))
    assert only(fit, "bands-differ").message == snapshot(
        "The rms difference between the reproduced and the given bands of 'x' is 0.21 of their mean width; the largest difference relative to a channel's range is 0.48 (SI unit), in the upper bound of channel 'x', time 2 s."
    )
    assert 8 < only(fit, "outlying-bound").values["ratio"] < 9


def test_bands_with_noise_are_said_to_have_it():
    noise = 0.01 * np.random.default_rng(2).standard_normal((2, 41))
    lower, upper = np.sort([EXACT.lower[:, 0] + noise[0], EXACT.upper[:, 0] + noise[1]], axis=0)
    assert "uncorrelated-residuals" in codes(identify_bands(DECAY, Bands.of(TIMES, {"x": (lower, upper)})))


@pytest.mark.parametrize("shape", ["wave", "slip", "drift"])
def test_bands_that_no_box_has_are_inconsistent_and_no_success(shape):
    """Bands of another model, with one slip, and with noise that adds up from sample to sample."""
    lower, upper = EXACT.lower[:, 0].copy(), EXACT.upper[:, 0].copy()
    if shape == "wave":
        lower, upper = np.cos(3 * TIMES) - 0.1, np.cos(3 * TIMES) + 0.1
    elif shape == "slip":
        upper[20] += 0.5
    else:
        drift = np.cumsum(0.03 * np.random.default_rng(0).standard_normal(len(TIMES)))
        lower, upper = lower + drift, upper + drift
    fit = identify_bands(DECAY, Bands.of(TIMES, {"x": (lower, upper)}))
    assert not fit.success
    assert [(item.code, item.severity) for item in fit.findings] == [("inconsistent-bands", "error")]


@pytest.mark.parametrize("seed", [1326, 1360])
def test_white_noise_that_alternates_by_chance_does_not_make_bands_inconsistent(seed):
    """These two of 1,400 seeds have an autocorrelation below -3 of its deviations."""
    fit = identify_bands(DECAY, noisy(EXACT, 0.01, seed))
    assert "uncorrelated-residuals" in codes(fit)
    assert fit.success
    assert fit.findings == ()


def waves(slow, fast):
    """Return two cosines of a few decimetres, whose sum has false minima over both frequencies."""
    return 0.3 * np.cos(slow * INSTANTS) + 0.2 * np.cos(fast * INSTANTS)


INSTANTS = np.linspace(0, 2, 41)
WAVES = PythonModel(waves, {"slow": (2.0, 8.0), "fast": (2.0, 12.0)}, ["x"], INSTANTS)
WAVING = banded(WAVES, [3.8, 8.8], [4.2, 9.2], points=21)


@pytest.mark.parametrize("seed", [2, 3, 37])
def test_descents_from_other_starts_leave_false_minima_until_the_best_is_reached_twice(seed):
    """With 5 mm of noise, the first four starts of seeds 2 and 37 all end in false minima, 5 deviations off."""
    bands = noisy(WAVING, 0.005, seed)
    fit = identify_bands(WAVES, bands, seed=seed)
    known = np.array([4.0, 9.0, 0.2, 0.2])
    apart = np.concatenate([fit.middle, fit.radius]) - known
    assert np.all(np.abs(apart) < 3 * np.concatenate([fit.middle_deviations, fit.radius_deviations]))
    assert "minimum-reached-once" not in {item.code for item in fit.findings}
    descents = np.array([end.misfit for end in fit.starts[:-1]])  # the last one refines the answer
    assert np.count_nonzero(descents < 1.01 * descents.min()) >= 2
    many = identify_bands(WAVES, bands, method=GlobalSurrogate(starts=40), seed=seed)
    assert len(many.starts) >= 32
    assert fit.misfit == pytest.approx(many.misfit, rel=1e-6)
    np.testing.assert_allclose([fit.box.lower, fit.box.upper], [many.box.lower, many.box.upper], rtol=1e-5)


def test_a_best_end_that_only_one_descent_reached_is_a_finding():
    fit = identify_bands(DECAY, EXACT, method=GlobalSurrogate(starts=1))
    assert [(item.code, item.severity) for item in fit.findings] == [("minimum-reached-once", "warning")]


def test_a_surrogate_that_is_better_than_the_noise_of_the_bands_is_not_refused():
    """The surrogate's error is above its tolerance, and below the 5 mm that noise leaves."""
    assert identify_bands(WAVES, noisy(WAVING, 0.005, 35), seed=35).success


@pytest.mark.parametrize("consistent", [True, False])
def test_findings_on_the_model_join_those_on_the_bands(consistent):
    class Doubted(PythonModel):
        def findings(self, vector):
            return (Finding("beam-locking", "warning", {"middle": vector.tolist()}, "The beam locks."),)

    wave = np.cos(3 * TIMES)
    bands = EXACT if consistent else Bands.of(TIMES, {"x": (wave - 0.1, wave + 0.1)})
    fit = identify_bands(Doubted(DECAY.function, DECAY.parameters, ["x"], TIMES), bands)
    assert [item.code for item in fit.findings] == [*([] if consistent else ["inconsistent-bands"]), "beam-locking"]
    assert fit.findings[-1].values["middle"] == pytest.approx(fit.middle)
    assert fit.success == consistent


def test_an_interval_on_its_bound_is_said():
    model = PythonModel(DECAY.function, {"size": (1.9, 4.0), "rate": (0.1, 3.0)}, ["x"], TIMES)
    fit = identify_bands(model, EXACT)
    assert str(only(fit, "interval-at-bound")) == snapshot(
        "The lower end of 'size' is at its bound 1.9. Widen the bound if the true interval may reach beyond it."
    )


@pytest.mark.slow
def test_a_parameter_that_the_response_does_not_see_is_said():
    model = PythonModel(
        lambda size, rate, ghost: size * np.exp(-rate * TIMES) + 0 * ghost,
        {"size": (0.5, 4.0), "rate": (0.1, 3.0), "ghost": (0.0, 1.0)},
        ["x"],
        TIMES,
    )
    fit = identify_bands(model, EXACT)
    assert np.isinf(fit.middle_deviations[2])
    assert np.isinf(fit.radius_deviations[2])
    unseen = [item.values["parameter"] for item in fit.conclusions if item.code == "unidentifiable-parameter"]
    assert unseen == ["ghost middle", "ghost radius"]
    assert "'rate" not in str(fit.identifiability())


def test_a_surrogate_that_is_not_to_be_trusted_is_refused_before_and_after_the_check():
    wave = PythonModel(lambda rate: np.cos(rate * TIMES), {"rate": (1.0, 20.0)}, ["x"], TIMES)
    bands = banded(wave, [5.0], [5.5])
    refused = (
        r"^the surrogate of order 4 is wrong by about [\d.]+ at channel 'x', time [\d.]+ s, more than the tolerance of "
        r"0\.002; about order 8 is to be tried next, as no decay shows yet: take Tensor\(8\), raise the tolerance, or "
        r"make the box smaller$"
    )
    for method in (GlobalSurrogate(Tensor(4), checks=0), GlobalSurrogate(Tensor(4), Tensor(4), checks=1)):
        with pytest.raises(SolveError, match=refused):
            identify_bands(wave, bands, method=method)


def test_without_a_check_the_result_says_so():
    fit = identify_bands(DECAY, EXACT, method=GlobalSurrogate(Adaptive(1e-6), checks=0))
    assert fit.checked_misfit is None
    assert fit.checked_lower is None
    assert "surrogate-unchecked" in codes(fit)
    assert "not checked" in fit.summary()


def test_a_check_whose_runs_all_fail_is_none():
    """The surrogate is made of runs on a root grid; at the corners of the answer the model fails."""
    runs = []

    def fragile(size, rate):
        runs.append((size, rate))
        if len(runs) > 4 + 81:
            raise RuntimeError("enough")
        return DECAY.function(size, rate)

    model = PythonModel(fragile, DECAY.parameters, ["x"], TIMES)
    fit = identify_bands(model, EXACT, method=GlobalSurrogate(Tensor(8), tolerance=1.0))
    assert fit.checked_misfit is None
    place = f"test_identify_bands.py, line {fragile.__code__.co_firstlineno + 3}"
    failed = only(fit, "failed-simulations").values["first"]
    assert failed.startswith(f"RuntimeError: enough ({place}) (at size = ")
    np.testing.assert_allclose(fit.box.lower, [1.8, 0.7], rtol=1e-3)


def test_the_public_name_is_the_same():
    assert dalembert.identify_bands is identify_bands


def test_the_summary_names_intervals_misfit_and_effort():
    text = identify_bands(DECAY, EXACT, intervals=["rate"], method=GlobalSurrogate(tolerance=1.0)).summary()
    assert "given number" in text
    assert re.search(r"^fitted bounds +82$", text, re.MULTILINE)
    assert re.search(r"^misfit by true runs +\d", text, re.MULTILINE)


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (
            lambda: identify_bands(DECAY, EXACT, method="globl"),
            "unknown method of identifying bands 'globl'; did you mean 'global'?",
        ),
        (
            lambda: identify_bands(DECAY, EXACT, method=3),
            "method is 3; expected GlobalSurrogate(...), Nested(...), 'global' or 'nested'",
        ),
        (
            lambda: identify_bands(DECAY, EXACT, intervals=["rat"]),
            "intervals: unknown parameter 'rat'; did you mean 'rate'?",
        ),
        (
            lambda: identify_bands(DECAY, EXACT, intervals=[], method=NESTED),
            "no intervals were given; expected the name of at least one parameter",
        ),
        (lambda: GlobalSurrogate(starts=0), "GlobalSurrogate: starts is 0; expected a whole number of at least 1"),
        (lambda: GlobalSurrogate(checks=-1), "GlobalSurrogate: checks is -1; expected zero or a positive whole number"),
        (
            lambda: GlobalSurrogate(held_out=-1),
            "GlobalSurrogate: held_out is -1; expected zero or a positive whole number",
        ),
        (lambda: GlobalSurrogate(tolerance=0.0), "GlobalSurrogate: tolerance is 0; expected a positive number"),
        (
            lambda: identify_bands(DECAY, EXACT, weights=[1.0, 2.0]),
            "weights of shape (2,) were given; expected (channels,) = (1,) or (samples, channels) = (41, 1)",
        ),
    ],
)
def test_arguments_that_cannot_be_meant_are_told(call, message):
    with pytest.raises(InputError, match=says(message)):
        call()


def test_bands_at_other_samples_or_of_other_channels_are_told():
    with pytest.raises(DataError, match=r"^the data have 5 samples and the model 41; expected the same; build"):
        identify_bands(DECAY, EXACT.first(5))
    with pytest.raises(DataError, match=r"^the data name a channel that the model does not give: unknown channel 'z'"):
        identify_bands(DECAY, Bands.of(TIMES, {"z": (EXACT.lower[:, 0], EXACT.upper[:, 0])}))
