"""The likelihood against the multivariate normal density, its gradient, and what it refuses."""

import numpy as np
import pytest
from scipy.stats import multivariate_normal

from dalembert.data import Measurements
from dalembert.errors import DataError, InputError, SolveError
from dalembert.forward import PythonModel
from dalembert.inverse.experiments.experiment import Experiment
from dalembert.inverse.noise.likelihood.likelihood import likelihood
from dalembert.inverse.noise.models.correlated_noise import AutoregressiveNoise, OrnsteinUhlenbeckNoise
from dalembert.inverse.noise.models.independent_noise import ConstantNoise, KnownNoise, MixedNoise, ProportionalNoise
from dalembert.inverse.noise.models.whitening import correlations_of

TIMES = np.linspace(0.0, 2.9, 30)
GAPS = [1, 2, 9, 13, 14, 15, 20, 22, 24, 28]
UNEVEN = TIMES + 0.04 * np.sin(40 * TIMES)
SMALL = 1e-6


def line(times=TIMES, names=("x",)):
    def response(level, slope):
        return np.stack([(1 + k) * (level + slope * times) for k in range(len(names))], axis=1)

    return PythonModel(response, {"level": (0.0, 3.0), "slope": (-1.0, 2.0)}, list(names), times)


def measured(times=TIMES, names=("x",), *, gaps=(), deviations=None):
    random = np.random.default_rng(3)
    table = {name: (1 + k) * (1 + 0.5 * times) + 0.1 * random.normal(size=len(times)) for k, name in enumerate(names)}
    for column in table.values():
        column[list(gaps)] = np.nan
    return Measurements.of(times, table, deviations, missing="leave-out")


VALUES = {"deviation": 0.2, "relative": 0.1, "partial1": 0.6, "partial2": -0.3, "partial3": 0.2, "time": 0.3}


def vector_of(found):
    known = {"level": 1.1, "slope": 0.4}
    names = found.parameters.names
    return np.array([known[name] if name in known else VALUES[name.rpartition(".")[2]] for name in names])


MODELS = [
    (ConstantNoise(), TIMES, ()),
    (ProportionalNoise(), TIMES, GAPS),
    (MixedNoise(), TIMES, ()),
    (MixedNoise(deviation=0.2), TIMES, ()),
    (AutoregressiveNoise(order=1), TIMES, ()),
    (AutoregressiveNoise(order=3, deviation=MixedNoise()), TIMES, ()),
    (AutoregressiveNoise(order=2), TIMES, GAPS),
    (AutoregressiveNoise(order=2, partial=(0.5, 0.1)), TIMES, GAPS),
    (AutoregressiveNoise(order=0), TIMES, ()),
    (OrnsteinUhlenbeckNoise(), UNEVEN, GAPS),
    (OrnsteinUhlenbeckNoise(time=(0.05, 1.0), deviation=ProportionalNoise()), UNEVEN, ()),
]


def correlation(noise, times, present):
    """The correlation matrix of the present values, from its definition."""
    apart = np.abs(times[present][:, None] - times[present])
    if isinstance(noise, OrnsteinUhlenbeckNoise):
        return np.exp(-apart / VALUES["time"])
    if isinstance(noise, AutoregressiveNoise):
        partials = noise.partial or [VALUES[f"partial{k}"] for k in range(1, noise.order + 1)]
        return correlations_of(partials, len(times))[np.rint(apart / 0.1).astype(int)]
    return np.eye(np.count_nonzero(present))


@pytest.mark.parametrize(("noise", "times", "gaps"), MODELS)
def test_it_is_the_multivariate_normal_density(noise, times, gaps):
    model, data = line(times), measured(times, gaps=gaps)
    found = likelihood(model, data, noise=noise)
    vector, present = vector_of(found), data.present[:, 0]
    response = model.evaluate(vector[None, :2]).values[0, present, 0]
    kind = getattr(noise, "deviation", noise)
    kind = kind if isinstance(kind, ProportionalNoise | MixedNoise) else noise
    size = {ProportionalNoise: 0.1 * response, MixedNoise: np.hypot(0.2, 0.1 * response)}.get(type(kind), 0.2)
    sizes = np.broadcast_to(size, response.shape)
    covariance = sizes[:, None] * correlation(noise, times, present) * sizes
    expected = multivariate_normal(response, covariance).logpdf(data.values[present, 0])
    assert found.evaluate(vector) == pytest.approx([expected], rel=1e-10)
    assert found.pointwise(vector).sum() == pytest.approx(expected, rel=1e-10)
    value, _ = found.linearise(vector)
    assert value == pytest.approx(expected, rel=1e-10)
    apart = data.values[present, 0] - response
    white = found.whitened(vector)
    assert white @ white == pytest.approx(apart @ np.linalg.solve(covariance, apart), rel=1e-9)


@pytest.mark.parametrize(("noise", "times", "gaps"), MODELS)
def test_the_gradient_is_that_of_differences(noise, times, gaps):
    found = likelihood(line(times), measured(times, gaps=gaps), noise=noise)
    vector = vector_of(found)
    steps = SMALL * np.eye(len(vector))
    differences = (found.evaluate(vector + steps) - found.evaluate(vector - steps)) / (2 * SMALL)
    assert found.linearise(vector)[1] == pytest.approx(differences, rel=1e-6, abs=1e-5)


def test_known_deviations_are_the_usual_noise():
    data = measured(deviations=0.1)
    found = likelihood(line(), data)
    assert found.noise == KnownNoise()
    assert found.parameters.names == ("level", "slope")
    response = 1.1 + 0.4 * TIMES
    expected = multivariate_normal(response, 0.01).logpdf(data.values[:, 0])
    assert found.evaluate([[1.1, 0.4]]) == pytest.approx([expected])
    weighted = likelihood(line(), measured(), weights=[100.0])
    assert weighted.evaluate([[1.1, 0.4]]) == pytest.approx([expected])


def test_noise_parameters_have_units_positive_bounds_and_logarithms():
    model = PythonModel(lambda slope: slope * TIMES, {"slope": (0.0, 3.0)}, ["x"], TIMES)
    found = likelihood(model, measured(), noise=OrnsteinUhlenbeckNoise(deviation=MixedNoise()))
    assert found.noise_parameters.names == ("noise.x.deviation", "noise.x.relative", "noise.x.time")
    assert found.noise_parameters.items[2].unit == "s"
    assert all(item.lower > 0 and item.log for item in found.noise_parameters)
    fixed = likelihood(model, measured(), noise=MixedNoise(relative=0.0))
    assert fixed.parameters.names == ("slope", "noise.x.deviation")
    assert fixed.noise_parameters.fixed[0].name == "noise.x.relative"


def test_channels_may_have_different_noise():
    data = measured(names=("x", "y"))
    found = likelihood(line(names=("x", "y")), data, noise={"y": "mixed"})
    assert found.noise_parameters.names == ("noise.x.deviation", "noise.y.deviation", "noise.y.relative")
    assert found.places.channel.tolist() == ["x"] * 30 + ["y"] * 30
    assert found.places.row.tolist() == [*range(30)] * 2
    assert set(found.places.experiment.tolist()) == {""}


def test_experiments_share_noise_parameters_unless_they_are_local():
    runs = [Experiment(name, line(), measured()) for name in ("one", "two")]
    shared, local = likelihood(runs), likelihood(runs, noise=ConstantNoise(local=True))
    assert shared.noise_parameters.names == ("noise.x.deviation",)
    assert local.noise_parameters.names == ("noise.one.x.deviation", "noise.two.x.deviation")
    assert shared.evaluate([1.1, 0.4, 0.2]) == pytest.approx(local.evaluate([1.1, 0.4, 0.2, 0.2]))
    assert shared.places.experiment[[0, -1]].tolist() == ["one", "two"]
    single = likelihood(line(), measured()).evaluate([1.1, 0.4, 0.2])
    assert shared.evaluate([1.1, 0.4, 0.2]) == pytest.approx(2 * single)


def test_wrapping_channels_count_modulo_a_turn():
    data = measured()
    turned = Measurements.of(TIMES, {"x": data.values[:, 0] + 2 * np.pi}, wraps=["x"])
    there = [[1.1, 0.4, 0.2]]
    assert likelihood(line(), turned).evaluate(there) == pytest.approx(likelihood(line(), data).evaluate(there))


def failing(level):
    if level > 2:
        raise SolveError("too high")
    return level + 0 * TIMES


def test_a_failed_sample_does_not_end_a_batch():
    model = PythonModel(failing, {"level": (0.0, 3.0)}, ["x"], TIMES)
    found = likelihood(model, measured())
    values = found.evaluate([[2.5, 0.1], [1.5, 0.1]])
    assert values[0] == -np.inf
    assert np.isfinite(values[1])
    assert np.all(np.isnan(found.pointwise([[2.5, 0.1]])))
    with pytest.raises(SolveError, match="too high"):
        found.linearise([2.5, 0.1])


def test_noise_of_zero_deviation_is_impossible():
    model = PythonModel(lambda slope: slope * TIMES, {"slope": (0.0, 3.0)}, ["x"], TIMES)
    assert likelihood(model, measured(), noise="proportional").evaluate([[1.0, 0.1]]) == [-np.inf]


def test_replicas_have_the_noise():
    found = likelihood(line(UNEVEN), measured(UNEVEN, gaps=GAPS), noise=OrnsteinUhlenbeckNoise())
    vector = vector_of(found)
    made = found.replicas(np.tile(vector, (400, 1)), seed=1)
    assert made.shape == (400, 30, 1)
    assert np.isnan(made[:, GAPS]).all()
    noise = np.delete(made[:, :, 0] - (1.1 + 0.4 * UNEVEN), GAPS, axis=1)
    times = np.delete(UNEVEN, GAPS)
    expected = 0.04 * np.exp(-np.abs(times[:, None] - times) / 0.3)
    assert noise.T @ noise / 400 == pytest.approx(expected, abs=0.012)
    assert np.array_equal(made, found.replicas(np.tile(vector, (400, 1)), seed=1), equal_nan=True)


@pytest.mark.parametrize(
    ("noise", "times", "message"),
    [
        (
            "gaussian",
            TIMES,
            "noise: unknown noise model 'gaussian'; known: autoregressive, constant, known, mixed, ornstein-uhlenbeck, "
            "proportional",
        ),
        (
            3,
            TIMES,
            "noise is 3; expected a noise model such as ConstantNoise(), its name, or a mapping from channels to such "
            "models",
        ),
        ({"y": "mixed"}, TIMES, "noise: unknown channel 'y'; known: x"),
        (
            "known",
            TIMES,
            "noise of channel 'x': KnownNoise was given, but the data have no deviations; give them, or take "
            "ConstantNoise()",
        ),
        (
            "autoregressive",
            TIMES,
            "noise of channel 'x': the order of AutoregressiveNoise is open; give it, or take the noise of a fit, which "
            "chose it",
        ),
        (
            AutoregressiveNoise(order=1),
            UNEVEN + 0.04 * TIMES**2,
            "noise of channel 'x': AutoregressiveNoise needs evenly spaced samples, gaps allowed; take "
            "OrnsteinUhlenbeckNoise() for uneven ones",
        ),
        (
            AutoregressiveNoise(order=4),
            TIMES,
            "noise of channel 'x': AutoregressiveNoise of order 4 needs 40 samples, but there are 30; lower the order",
        ),
    ],
)
def test_what_does_not_fit_is_refused(noise, times, message):
    with pytest.raises(InputError) as refused:
        likelihood(line(times), measured(times), noise=noise)
    assert str(refused.value) == message


def test_experiments_with_shared_parameters_have_one_model():
    runs = [Experiment(name, line(), measured()) for name in ("one", "two")]
    with pytest.raises(InputError) as refused:
        likelihood(runs, noise={"one.x": ConstantNoise(), "two.x": MixedNoise()})
    assert str(refused.value) == (
        "noise of channel 'x': experiments share its parameters, but have different noise models; give all the same, "
        "or models with local=True"
    )


def test_data_must_fit_the_model():
    with pytest.raises(DataError):
        likelihood(line(), measured(names=("z",)))
