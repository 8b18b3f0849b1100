"""Several experiments at once: shared and own parameters, the growing horizon, files, refusals."""

import numpy as np
import pytest

from conclusions import only
from dalembert.data import Measurements
from dalembert.errors import DataError, InputError, ModelError, SolveError
from dalembert.forward import PythonModel, Sensor, Sensors
from dalembert.inverse import Experiment, Fit, identify
from dalembert.inverse.experiments.experiments import joint
from dalembert.multibody import DistanceJoint, RevoluteJoint, RigidBar, System, TimeResponse
from dalembert.optimize import ParticleSwarm
from support import says

SHORT, LONG = np.linspace(0, 2, 21), np.linspace(0, 5, 41)
BOUNDS = {"size": (0.5, 4.0), "rate": (0.1, 3.0)}
TRUE = {"short": (2.0, 0.8), "long": (1.5, 0.8)}


def decay(times, **options):
    return PythonModel(lambda size, rate: size * np.exp(-rate * times), BOUNDS, ["x"], times, **options)


def line(times):
    return PythonModel(
        lambda offset, slope: np.stack([offset + slope * times, slope * times**2], axis=1),
        {"offset": (-5.0, 5.0), "slope": (-5.0, 5.0)},
        ["x", "y"],
        times,
    )


def measured(name, times, noise=0.0, **options):
    size, rate = TRUE[name]
    noisy = size * np.exp(-rate * times) + noise * np.random.default_rng(len(name)).standard_normal(len(times))
    return Measurements.of(times, {"x": noisy}, **options)


def pair(noise=0.0, local=("size",), **options):
    return [
        Experiment(name, decay(times), measured(name, times, noise, **options), local)
        for name, times in (("short", SHORT), ("long", LONG))
    ]


def test_shared_and_own_parameters_are_found_at_once():
    fit = identify(pair())
    assert fit.parameters.names == ("short.size", "rate", "long.size")
    np.testing.assert_allclose(fit.values, [2.0, 0.8, 1.5], rtol=1e-8)
    short, long = fit.experiments
    assert (short.name, short.data.channels, long.data.coordinate.name) == ("short", ("x",), "time")
    np.testing.assert_array_equal(long.data.coordinate.values, LONG)
    np.testing.assert_array_equal(short.data.values, measured("short", SHORT).values)
    np.testing.assert_allclose(long.response[:, 0], 1.5 * np.exp(-0.8 * LONG), rtol=1e-7)
    np.testing.assert_allclose(short.residuals, 0.0, atol=1e-8)


def test_a_linear_problem_has_the_closed_form_of_all_samples_stacked():
    rng = np.random.default_rng(3)
    experiments, design, values = [], [], []
    for number, times in enumerate((SHORT, LONG)):
        model, at = line(times), (np.array([1.0 + number, 0.0]), np.array([0.0, 1.0]))
        noisy = model.evaluate(np.array([[1.0 + number, 2.0]])).only()[0] + 0.1 * rng.standard_normal((len(times), 2))
        data = Measurements.of(times, {"x": noisy[:, 0], "y": noisy[:, 1]}, {"x": 0.1, "y": 0.2})
        experiments.append(Experiment(f"run{number}", model, data, ("offset",)))
        offset, slope = (model.jacobian(at[0])[:, :, k] / [0.1, 0.2] for k in (0, 1))
        nothing = np.zeros(2 * len(times))
        own = [nothing, nothing]
        own[number] = offset.ravel()
        design.append(np.stack([own[0], slope.ravel(), own[1]], axis=1))
        values.append((noisy / [0.1, 0.2]).ravel())
    stacked, target = np.concatenate(design), np.concatenate(values)
    expected, *_ = np.linalg.lstsq(stacked, target, rcond=None)
    fit = identify(experiments)
    assert fit.parameters.names == ("run0.offset", "slope", "run1.offset")
    np.testing.assert_allclose(fit.values, expected, rtol=1e-7)
    np.testing.assert_allclose(fit.misfit, np.sum((target - stacked @ expected) ** 2), rtol=1e-9)
    np.testing.assert_allclose(fit.deviations, np.sqrt(np.diag(np.linalg.inv(stacked.T @ stacked))), rtol=1e-9)


def test_two_alike_experiments_are_one_with_every_value_twice():
    data = measured("short", SHORT, 0.05)
    one = identify(decay(SHORT), data)
    two = identify([Experiment(name, decay(SHORT), data) for name in ("a", "b")])
    assert two.parameters.names == one.parameters.names
    np.testing.assert_allclose(two.values, one.values, rtol=1e-7)
    np.testing.assert_allclose(two.misfit, 2 * one.misfit, rtol=1e-9)


def test_the_first_rows_are_the_same_part_of_each_experiment():
    model, data = joint(pair())
    assert model.coordinate.values[[0, -1]].tolist() == [0.0, 1.0]
    assert len(model.coordinate.values) == 41  # the short one's samples lie at every second part of the long one's
    half = model.first(21)
    assert [part.coordinate.values[-1] for part in half.parts] == [1.0, 2.5]
    vector = np.array([2.0, 0.8, 1.5])
    whole, slopes = model.linearise(vector)
    response, jacobian = half.linearise(vector)
    np.testing.assert_array_equal(response, whole[:21])
    np.testing.assert_array_equal(jacobian, slopes[:21])
    np.testing.assert_array_equal(model.evaluate(vector[None]).only()[0], whole)
    assert np.isnan(data.values[1, 0])
    assert whole[1, 0] == 0
    assert not slopes[:, 0, 2].any()  # the own parameter of the other experiment
    assert not slopes[:, 1, 0].any()


def test_the_joint_jacobian_is_that_of_differences():
    model, _ = joint(pair())
    vector, step = np.array([2.0, 0.8, 1.5]), 1e-6
    moved = [model.evaluate(np.stack([vector + step * way, vector - step * way])).only() for way in np.eye(len(vector))]
    differences = np.stack([(up - down) / (2 * step) for up, down in moved], axis=2)
    np.testing.assert_allclose(model.jacobian(vector), differences, atol=1e-8)


def test_every_method_takes_experiments_and_failed_samples_name_theirs():
    def fragile(size, rate):
        if np.real(rate) > 2:
            raise RuntimeError("too fast")
        return size * np.exp(-rate * SHORT)

    experiments = pair()
    experiments[0] = Experiment("short", PythonModel(fragile, BOUNDS, ["x"], SHORT), experiments[0].data, ("size",))
    fit = identify(experiments, method=ParticleSwarm(20, 30), polish=True)
    np.testing.assert_allclose(fit.values, [2.0, 0.8, 1.5], rtol=1e-5)
    place = f"test_experiments.py, line {fragile.__code__.co_firstlineno + 2}"
    failed = only(fit, "failed-simulations").values["first"]
    assert failed.startswith(f"experiment 'short': RuntimeError: too fast ({place}) (at short.size = ")


def test_weights_are_given_by_the_experiments_name():
    experiments = pair(noise=0.05)
    light = identify(experiments, weights={"long": [1e-9]})
    alone = identify(experiments[0].model, experiments[0].data)
    np.testing.assert_allclose(light.values[:2], alone.values, rtol=1e-5)


def test_wrapping_channels_and_gaps_go_with_their_experiment():
    times = np.linspace(0, 3, 31)
    turning = PythonModel(lambda speed: speed * times, {"speed": (1.0, 4.0)}, ["angle"], times)
    angle = np.mod(3.0 * times + np.pi, 2 * np.pi) - np.pi
    angle[4] = np.nan
    wrapped = Measurements.of(times, {"angle": angle}, missing="leave-out", wraps=["angle"])
    plain = Measurements.of(times, {"angle": 3.0 * times})
    fit = identify([Experiment("wrapped", turning, wrapped), Experiment("plain", turning, plain)])
    np.testing.assert_allclose(fit.values, [3.0], rtol=1e-9)
    assert [part.data.wraps for part in fit.experiments] == [("angle",), ()]
    np.testing.assert_allclose(np.delete(fit.experiments[0].residuals, 4), 0, atol=1e-9)


def test_the_summary_and_the_file_keep_the_experiments_apart(tmp_path):
    fit = identify(pair(noise=0.01, deviations=0.01), validation=0.2)
    lines = [line.split() for line in fit.summary().splitlines()]
    assert [line[:2] for line in lines if line[:1] in (["short"], ["long"])] == [["short", "x"], ["long", "x"]]
    fit.save(tmp_path / "fit.nc")
    back = Fit.load(tmp_path / "fit.nc")
    assert back.summary() == fit.summary()
    for one, same in zip(fit.experiments, back.experiments, strict=True):
        assert same.data.fingerprint == one.data.fingerprint
        assert same.response.tobytes() == one.response.tobytes()
        assert same.weights.tobytes() == one.weights.tobytes()
    assert [step.samples for step in back.history] == [step.samples for step in fit.history]


X = Measurements.of(SHORT, {"x": np.exp(-SHORT)})


@pytest.mark.parametrize(
    ("build", "kind", "sentence"),
    [
        (list, InputError, "no experiments were given; expected at least one Experiment(name, model, data)"),
        (
            lambda: [(decay(SHORT), X)],
            InputError,
            "a tuple was given; expected only Experiment(name, model, data)",
        ),
        (
            lambda: [Experiment("a", decay(SHORT), X), Experiment("a", decay(SHORT), X)],
            InputError,
            "experiments must have different names; repeated: a",
        ),
        (
            lambda: [Experiment("a", decay(SHORT), X, ("sise",))],
            InputError,
            "experiment 'a', local: unknown parameter 'sise'; did you mean 'size'?",
        ),
        (
            lambda: [
                Experiment("a", decay(SHORT), X),
                Experiment("b", PythonModel(lambda rate: np.exp(-rate * SHORT), {"rate": (0.2, 3)}, ["x"], SHORT), X),
            ],
            InputError,
            "parameter 'rate' is shared by the experiments 'a' and 'b', but is between 0.1 and 3 in one and between "
            "0.2 and 3 in the other, or differs in unit, scale or start; give it alike, or name it in own",
        ),
        (
            lambda: [
                Experiment("a", decay(SHORT), measured("short", SHORT, deviations=0.1)),
                Experiment("b", decay(SHORT), X),
            ],
            InputError,
            "experiment 'b' has no deviations, but 'a' has; give them for all experiments or for none, so that their "
            "residuals can be compared",
        ),
        (
            lambda: [Experiment("a", decay(LONG), X)],
            DataError,
            "experiment 'a': the data have 21 samples and the model 41; expected the same; build the model with the "
            "samples of the data",
        ),
        (
            lambda: [Experiment("a", decay(SHORT), Measurements.of(SHORT, {"z": SHORT}))],
            DataError,
            "experiment 'a': the data name a channel that the model does not give: unknown channel 'z'; known: x",
        ),
    ],
)
def test_experiments_that_do_not_fit_together_are_told(build, kind, sentence):
    with pytest.raises(kind, match=says(sentence)):
        identify(build())


def test_arguments_that_do_not_go_with_experiments_are_told():
    for arguments, options, sentence in [
        ((pair(), X), {}, "identify: experiments have their own data; leave out the second argument"),
        (
            (decay(SHORT),),
            {},
            "identify: no data were given; expected identify(model, data), or identify([Experiment(...)])",
        ),
        (
            (decay(SHORT), X),
            {"weights": {"x": 1.0}},
            "weights by name are for several experiments; expected an array (channels,)",
        ),
        (
            (pair(),),
            {"weights": [1.0, 1.0]},
            "weights: with several experiments expected a mapping from the name of an experiment to its weights, not a "
            "list",
        ),
        (
            (pair(),),
            {"weights": {"shrt": [1.0]}},
            "weights: unknown experiment 'shrt'; did you mean 'short'?",
        ),
    ]:
        with pytest.raises(InputError, match=says(sentence)):
            identify(*arguments, **options)


def test_a_model_that_always_fails_names_its_experiment():
    def broken(size, rate):
        raise RuntimeError("no")

    experiments = [*pair(), Experiment("third", PythonModel(broken, BOUNDS, ["x"], SHORT), X, ("size",))]
    with pytest.raises(SolveError, match="the first failure: experiment 'third': RuntimeError: no"):
        identify(experiments, method=ParticleSwarm(4, 2))


def loop(rod, mass):
    """A closed loop that no crank angle closes where the rod is shorter than 0.9 m."""
    system = System()
    crank = system.add(RigidBar("crank", length=0.3, mass=1.0, angle=0.8))
    system.add(RevoluteJoint("pin", system.ground, crank.start))
    bar = system.add(RigidBar("rod", length=rod, mass=mass, start=crank.end, angle=-0.3))
    system.add(RevoluteJoint("joint", crank.end, bar.start))
    system.add(DistanceJoint("link", system.ground.point(1.4, 0.0), bar.end, length=0.2))
    return system


def test_mechanisms_are_built_first_where_the_search_starts():
    """At the middle of the bounds the loop cannot be closed."""
    times = np.linspace(0.0, 0.3, 16)

    def model(lower):
        return TimeResponse(loop, {"rod": (lower, 1.15), "mass": (0.5, 3.0)}, ["crank.end.angle"], times)

    exact = model(1.0).evaluate(np.array([[1.05, 2.0]])).only()[0, :, 0]
    data = Measurements.of(times, {"crank.end.angle": exact}, 1e-4)
    with pytest.raises(ModelError, match="the mechanism cannot be assembled"):
        identify(model(0.3), data)
    fit = identify(model(0.3), data, start={"rod": 1.1, "mass": 1.0})
    np.testing.assert_allclose(fit.values, [1.05, 2.0], rtol=1e-5)
    several = [Experiment(name, model(0.3), data, local=("mass",)) for name in "ab"]
    fit = identify(several, start={"rod": 1.1, "a.mass": 1.0, "b.mass": 1.5})
    np.testing.assert_allclose(fit.values, [1.05, 2.0, 2.0], rtol=1e-5)
    seen = Sensors(model(0.3), {"crank.end.angle": Sensor(offset=(-0.1, 0.1))})
    fit = identify(seen, data, start={"rod": 1.1, "mass": 1.0, "crank.end.angle offset": 0.0})
    np.testing.assert_allclose(fit.values, [1.05, 2.0, 0.0], atol=1e-4)
