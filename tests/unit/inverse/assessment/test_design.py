"""Designs against closed forms, their order, what is unseen, and in a file; and the look before solving."""

import numpy as np
import pytest
from inline_snapshot import snapshot

from conclusions import codes, only
from dalembert.data import Measurements
from dalembert.errors import InputError, SolveError
from dalembert.forward import PythonModel
from dalembert.inverse import (
    AutoregressiveNoise,
    ConstantNoise,
    Designs,
    Experiment,
    KnownNoise,
    ProportionalNoise,
    design,
    identifiability,
    identify,
)  # fmt: skip
from dalembert.parameter import Parameter
from small_models import LINE, TIMES, measured
from support import says

BOX = {"a": (0.0, 2.0), "b": (0.0, 4.0)}
TWO = PythonModel(
    lambda a, b: np.stack([a * TIMES, b + 0 * TIMES, (a + b) * TIMES], axis=1), BOX, ["p", "q", "r"], TIMES
)


def test_deviations_are_those_of_a_fit_of_such_data():
    designs = design(LINE, [1.0, -0.5], deviations={"x": 0.1, "y": 0.3}, sensors="all")
    data = Measurements.of(TIMES, dict(zip("xy", LINE.evaluate(np.array([[1.0, -0.5]])).values[0].T, strict=True)))
    fit = identify(LINE, Measurements(data.coordinate, data.channels, data.values, np.array([0.1, 0.3])))
    np.testing.assert_allclose(designs.deviations[0], fit.deviations, rtol=1e-6)
    np.testing.assert_allclose(designs.singular_values[0], fit.singular_values, rtol=1e-6)


def test_correlated_noise_has_the_deviations_of_generalised_least_squares():
    noise = AutoregressiveNoise(deviation=ConstantNoise(deviation=0.1), order=1, partial=[0.7])
    designs = design(TWO, noise={"p": noise, "q": noise}, sensors=[("p", "q")], horizons=[TIMES[9], TIMES[-1]])
    for place, end in enumerate(designs.horizons):
        along = TIMES[end >= TIMES]
        lags = np.abs(np.subtract.outer(np.arange(len(along)), np.arange(len(along))))
        precision = np.linalg.inv(0.01 * 0.7**lags)
        expected = along @ precision @ along, precision.sum()
        np.testing.assert_allclose(designs.deviations[place], 1 / np.sqrt(expected), rtol=1e-9)
    assert designs.noise == pytest.approx({"p": 0.1, "q": 0.1})


def test_the_noise_of_a_fit_plans_its_repetition():
    rng = np.random.default_rng(1)
    values = LINE.evaluate(np.array([[1.0, -0.5]])).values[0] + [0.1, 0.3] * rng.standard_normal((len(TIMES), 2))
    data = Measurements.of(TIMES, dict(zip("xy", values.T, strict=True)))
    fit = identify(LINE, data, noise={"x": ConstantNoise(), "y": AutoregressiveNoise(order=1)})
    designs = design(LINE, fit.values, noise=fit.noise, sensors="all")
    np.testing.assert_allclose(designs.deviations[0], fit.deviations, rtol=1e-6)
    assert designs.noise["x"] == pytest.approx(fit.noise.estimates["noise.x.deviation"])


def test_the_noise_of_experiments_plans_another_one_if_they_share_it():
    rng = np.random.default_rng(1)
    exact = LINE.evaluate(np.array([[1.0, -0.5]])).values[0]
    data = [exact + size * rng.standard_normal((len(TIMES), 2)) for size in (0.1, 0.5)]
    experiments = [
        Experiment(name, LINE, Measurements.of(TIMES, dict(zip("xy", values.T, strict=True))))
        for name, values in zip("AB", data, strict=True)
    ]
    shared, local = (identify(experiments, starts=1, noise=ConstantNoise(local=own)) for own in (False, True))
    designs = design(LINE, shared.values, noise=shared.noise, sensors="all")
    np.testing.assert_allclose(designs.deviations[0], np.sqrt(2) * shared.deviations, rtol=1e-6)
    sentence = (
        "design: the noise of channel 'x' differs between the experiments of the fit (A.x, B.x). Give a noise model "
        "with numbers for it"
    )
    with pytest.raises(InputError, match=says(sentence)):
        design(LINE, local.values, noise=local.noise)


def test_noise_that_needs_no_deviations_is_given_alone():
    sentence = "design: noise and deviations were given, and noise needs no deviations; leave one of them out"
    with pytest.raises(InputError, match=says(sentence)):
        design(LINE, deviations=0.1, noise=ConstantNoise(deviation=0.2))


def test_known_deviations_may_be_correlated():
    noise = AutoregressiveNoise(deviation=KnownNoise(), order=1, partial=[0.7])
    plain = design(TWO, deviations={"p": 0.1, "q": 0.2}, sensors="all")
    correlated = design(TWO, deviations={"p": 0.1, "q": 0.2}, noise={"q": noise}, sensors="all")
    assert correlated.deviations[0][0] == pytest.approx(plain.deviations[0][0])
    assert correlated.deviations[0][1] > 1.5 * plain.deviations[0][1]


@pytest.mark.parametrize("criterion", ["D", "E"])
def test_scores_are_determinant_and_smallest_singular_value(criterion):
    designs = design(LINE, deviations=0.1, horizons=(1.0, 2.0, 4.0), criterion=criterion)
    jacobian = LINE.jacobian(np.zeros(2)) * LINE.parameters.scale / 0.1
    for sensors, horizon, score in zip(designs.sensors, designs.horizons, designs.scores, strict=True):
        own = jacobian[: round(10 * horizon) + 1, "xy".index(sensors[0])]
        information = own.T @ own
        d = np.linalg.det(information) ** (-1 / 4)
        e = np.linalg.eigvalsh(information)[0] ** -0.5
        assert score == pytest.approx(d if criterion == "D" else e)
    assert np.all(np.diff(designs.scores) >= 0)
    assert designs.samples.tolist() == [round(10 * horizon) + 1 for horizon in designs.horizons]


def test_what_is_unseen_comes_last_and_is_counted():
    designs = design(TWO, deviations=0.1, sensors=["p", ("p", "q"), "r"])
    assert designs.sensors == (("p", "q"), ("p",), ("r",)) or designs.sensors == (("p", "q"), ("r",), ("p",))
    assert designs.unseen.tolist() == [0, 1, 1]
    assert np.isinf(designs.scores[1:]).all()
    assert designs.success
    assert only(designs, "unusable-designs").values == {"designs": 2}
    alone = design(TWO, deviations=0.1, sensors=["r"])
    assert not alone.success
    assert codes(alone) == ["insufficient-design"]
    assert alone.status == snapshot(
        "No design identifies all parameters: even the best one, r until time 4 s, does not determine 1 combination of 'a' and 'b'. Measure other channels, or fix one of 'a' and 'b' for each combination."
    )


def test_pairs_are_all_pairs():
    designs = design(TWO, deviations=0.1, sensors="pairs")
    assert {frozenset(pair) for pair in designs.sensors} == {frozenset("pq"), frozenset("pr"), frozenset("qr")}


def test_a_mapping_chooses_what_can_be_measured():
    assert {name for sensors in design(TWO, deviations={"p": 1, "q": 1}).sensors for name in sensors} == {"p", "q"}


def test_a_prior_tells_what_the_sensor_does_not():
    box = {"a": (0.0, 2.0), "b": Parameter("b", 0.0, 4.0, deviation=0.2)}
    designs = design(PythonModel(TWO.function, box, ["p", "q", "r"], TIMES), deviations=0.1, sensors=["p"])
    assert designs.success
    assert designs.deviations[0, 1] == pytest.approx(0.2)


def test_a_file_gives_back_the_same_bits(tmp_path):
    designs = design(TWO, {"a": 1.0, "b": 3.0}, deviations={"p": 0.1, "q": 0.2}, sensors="pairs", horizons=[1.0, 3.0])
    designs.save(tmp_path / "a.nc")
    back = Designs.load(tmp_path / "a.nc")
    assert back.summary() == designs.summary()
    for name in ("at", "horizons", "samples", "scores", "unseen", "deviations", "singular_values"):
        assert getattr(back, name).tobytes() == getattr(designs, name).tobytes()
    assert (back.sensors, back.noise, back.criterion) == (designs.sensors, designs.noise, designs.criterion)


@pytest.mark.parametrize(
    ("options", "sentence"),
    [
        ({"criterion": "A"}, "design: unknown criterion 'A'; known: D, E"),
        ({"sensors": "single"}, "design: unknown set of sensors 'single'; did you mean 'singles'?"),
        ({"sensors": ["s"]}, "design: sensors: unknown channel 's'; known: p, q, r"),
        ({"sensors": [()]}, "design: a set of sensors is empty; expected at least one channel in each"),
        ({"deviations": {"s": 1.0}}, "design: deviations: unknown channel 's'; known: p, q, r"),
        ({"deviations": -1.0}, "design: channel 'p': its deviation is -1.0; expected a positive number"),
        (
            {"deviations": [1.0, 2.0]},
            "design: deviations of shape (2,) were given; expected a number, or one for each of p, q, r",
        ),
        (
            {"horizons": [-1.0]},
            "design: horizon -1 s was given, but the model's first sample lies at 0 s; expected a later end",
        ),
        (
            {"deviations": {"p": 1.0}, "sensors": "pairs"},
            "design: pairs of sensors were asked for, but 'p' is the only channel",
        ),
        ({"deviations": None}, "design: the noise is not known; give deviations, or noise"),
        (
            {"noise": {"p": "constant"}},
            "design: the noise of channel 'p' has no value for 'deviation'; give a number, or the noise of a fit",
        ),
        ({"deviations": None, "noise": {"s": "constant"}}, "design: noise: unknown channel 's'; known: p, q, r"),
        (
            {"deviations": None, "noise": ProportionalNoise(relative=0.1)},
            "design: the noise of channel 'p' has no standard deviation at some samples; give its deviation, or MixedNoise where the response is 0",
        ),
    ],
)
def test_what_cannot_be_meant_is_refused(options, sentence):
    with pytest.raises(InputError, match=says(sentence)):
        design(TWO, **{"deviations": 0.1, **options})


def test_a_look_before_solving_foresees_the_deviations_of_the_fit():
    data = measured(LINE, [1.0, -0.5], noise=0.2, deviations=0.2)
    foreseen, fit = identifiability(LINE, data=data), identify(LINE, data)
    np.testing.assert_allclose(foreseen.deviations, fit.deviations, rtol=1e-9)
    np.testing.assert_allclose(foreseen.correlation, fit.correlation, rtol=1e-9, atol=1e-12)
    assert foreseen.findings == ()
    same = identifiability(LINE, deviations={"x": 0.2, "y": 0.2})
    np.testing.assert_allclose(same.deviations, foreseen.deviations, rtol=1e-12)


def test_gaps_count_in_the_look_before_solving():
    data = measured(LINE, [1.0, -0.5], deviations=0.2)
    values = data.values.copy()
    values[:, 1] = np.nan
    values[30:, 0] = np.nan
    gaps = Measurements(data.coordinate, data.channels, values, data.deviations, "leave-out")
    expected = design(LINE, deviations={"x": 0.2}, horizons=[TIMES[29]]).deviations[0]
    np.testing.assert_allclose(identifiability(LINE, data=gaps).deviations, expected, rtol=1e-9)


def test_three_that_only_move_together_are_named_in_one_sentence():
    box = {"a": (0.0, 2.0), "b": (0.0, 2.0), "c": (0.0, 4.0), "d": (0.0, 2.0)}
    model = PythonModel(
        lambda a, b, c, d: np.stack([(a + c) * TIMES, (b + c) * TIMES, d * TIMES], axis=1), box, ["p", "q", "r"], TIMES
    )
    told = identifiability(model, deviations=0.1)
    (finding,) = told.findings  # none on each of them, and none on pairs
    assert finding.values == {"parameters": "a, b, c", "unseen": True, "below": "rounding"}
    assert str(finding) == snapshot(
        "Only a combination of 'a', 'b' and 'c' is identifiable: changing 'a' by +0.2, 'b' by +0.2 and 'c' by -0.2 together does not change the response. Fix one of them, or measure a quantity that separates them."
    )


def test_three_that_move_the_response_by_less_than_its_noise_are_named():
    tilt = 1e-5 * TIMES**2
    model = PythonModel(
        lambda a, b, c: np.stack([(a + c) * TIMES, (b + c) * TIMES + c * tilt], axis=1),
        dict.fromkeys("abc", (0.0, 2.0)),
        ["p", "q"],
        TIMES,
    )
    told = identifiability(model, deviations=0.1)
    assert only(told, "unidentifiable-combination").values["unseen"] is False


def test_a_simulation_that_fails_and_twice_given_noise_are_refused():
    broken = PythonModel(lambda a: 1 / (a * np.arange(3.0)[1]), {"a": (-1.0, 1.0)}, ["x"], np.arange(3.0))
    with pytest.raises(SolveError, match=r"\(at a = 0\); look at the model there, or look elsewhere$"):
        identifiability(broken, [0.0], deviations=1.0)
    data = measured(LINE, [1.0, -0.5], deviations=0.2)
    with pytest.raises(InputError, match=says("identifiability: data and deviations were given; expected one of them")):
        identifiability(LINE, data=data, deviations=1.0)


def test_a_prior_that_decides_alone_is_named():
    box = {"offset": (-5.0, 5.0), "slope": Parameter("slope", -5.0, 5.0, start=1.0, deviation=1e-5)}
    told = identifiability(PythonModel(LINE.function, box, ["x", "y"], TIMES), deviations=0.1)
    assert str(told.findings[0]) == snapshot(
        "The data add nothing to the prior of 'slope': its standard deviation is 1e-05 in the prior and 1e-05 with the data. Check that the prior is not too narrow, or measure a quantity that depends on 'slope'."
    )


def test_two_that_their_priors_alone_tell_apart_are_named():
    priors = {name: Parameter(name, 0.0, 2.0, deviation=0.1) for name in "ab"}
    model = PythonModel(lambda a, b: (a + b) * TIMES, priors, ["x"], TIMES)
    told = identifiability(model, deviations=1e-3)
    finding = told.findings[0]
    assert (finding.code, finding.values) == ("prior-dominates", {"parameters": "a, b"})
    assert any("'a' by {}0.1 and 'b' by {}0.1".format(*signs) in finding.message for signs in ("+-", "-+"))


def test_many_combinations_that_priors_decide_are_one_finding():
    names = [f"e{k}" for k in range(9)]
    priors = {name: Parameter(name, -1.0, 1.0, deviation=0.1) for name in names}
    model = PythonModel(lambda **e: sum(e.values()) * TIMES, priors, ["x"], TIMES)
    told = identifiability(model, deviations=1e-3)
    findings = [item for item in told.findings if item.code == "prior-dominates"]
    assert [item.values["combinations"] for item in findings] == [8]
    assert "8 combinations of the parameters 'e0', 'e1', 'e2', 'e3' and 5 others." in findings[0].message


def test_a_prior_needs_data_whose_noise_is_known():
    box = {"offset": (-5.0, 5.0), "slope": Parameter("slope", -5.0, 5.0, deviation=0.1)}
    model = PythonModel(LINE.function, box, ["x", "y"], TIMES)
    sentence = (
        "parameter 'slope' has a prior (its deviation), but the noise level of the data is not known; give the data's "
        "deviations, or weights that are 1/variance"
    )
    with pytest.raises(InputError, match=says(sentence)):
        identify(model, measured(LINE, [1.0, -0.5], noise=0.1))


@pytest.mark.parametrize("method", ["Nelder-Mead", "L-BFGS-B", None])
def test_a_prior_is_one_more_measurement_for_every_method(method):
    """(JᵀWJ + D) p = JᵀW y + D m."""
    box = {"offset": (-5.0, 5.0), "slope": Parameter("slope", -5.0, 5.0, start=0.2, deviation=0.01)}
    model = PythonModel(LINE.function, box, ["x", "y"], TIMES)
    data = measured(LINE, [1.0, -0.5], noise=0.5, deviations=0.5)
    jacobian = LINE.jacobian(np.zeros(2)).reshape(-1, 2) / 0.5
    known = np.diag([0.0, 1e4])
    expected = np.linalg.solve(jacobian.T @ jacobian + known, jacobian.T @ data.values.ravel() / 0.5 + known @ [0, 0.2])
    fit = identify(model, data, method=method)
    np.testing.assert_allclose(fit.values, expected, atol=2e-4 if method == "Nelder-Mead" else 1e-5)
    residual = jacobian @ expected - data.values.ravel() / 0.5
    assert fit.misfit == pytest.approx(residual @ residual + ((expected[1] - 0.2) / 0.01) ** 2, rel=1e-6)


@pytest.mark.parametrize("deviation", [0.0, -1.0, np.nan])
def test_a_prior_deviation_is_positive(deviation):
    sentence = (
        f"parameter 'a': deviation is {deviation}; expected a positive number, the standard deviation of what is known "
        "of it before any data"
    )
    with pytest.raises(InputError, match=says(sentence)):
        Parameter("a", 0.0, 1.0, deviation=deviation)
