"""identify_set: closed forms, brute scans, emptiness, errors a channel, and its file."""

import numpy as np
import pytest
from inline_snapshot import snapshot

import dalembert
from conclusions import codes, only
from dalembert.data import Measurements
from dalembert.errors import DataError, InputError
from dalembert.findings import Finding
from dalembert.forward import PythonModel
from dalembert.inverse import ParameterSet, as_record, identify_set
from dalembert.parameter import Parameter
from dalembert.surrogate import Adaptive, Tensor
from small_models import DECAY, LINE, TIMES, measured
from support import says

NOWHEN = np.zeros(1)
DISC = PythonModel(lambda x, y: np.array([x**2 + y**2]), {"x": (-2.0, 2.0), "y": (-2.0, 2.0)}, ["r"], NOWHEN)
AT_ZERO = Measurements.of(NOWHEN, {"r": [0.0]})
BALL = PythonModel(lambda x, y, z: np.array([x**2 + y**2 + z**2]), dict.fromkeys("xyz", (-2.0, 2.0)), ["r"], NOWHEN)


def test_one_parameter_has_the_interval_of_the_closed_form():
    data = Measurements.of(TIMES, {"x": np.exp(-TIMES)})
    model = PythonModel(lambda rate: np.exp(-rate * TIMES), {"rate": (0.1, 3.0)}, ["x"], TIMES)
    found = identify_set(model, data, error=0.02)
    positive = TIMES[1:]
    lower = np.max(-np.log(np.exp(-positive) + 0.02) / positive)
    upper = np.min(-np.log(np.maximum(np.exp(-positive) - 0.02, 1e-300)) / positive)
    for box, outside in ((found.outer, 1), (found.inner, -1)):
        assert 0 <= outside * (lower - box.lower[0]) < 2e-3
        assert 0 <= outside * (box.upper[0] - upper) < 2e-3
    assert found.success
    assert found.contains(np.array([[1.0], [2.0]])).tolist() == [1.0, 0.0]


@pytest.mark.parametrize(("radius", "codes"), [(1.0, ["beam-locking"]), (-9.0, [])], ids=["a disc", "empty"])
def test_findings_on_the_model_in_the_middle_of_the_set_join_those_on_the_set(radius, codes):
    class Doubted(PythonModel):
        def findings(self, vector):
            return (Finding("beam-locking", "warning", {"middle": vector.tolist()}, "The beam locks."),)

    model = Doubted(DISC.function, DISC.parameters, ["r"], NOWHEN)
    found = identify_set(model, Measurements.of(NOWHEN, {"r": [radius]}), error=0.5)
    assert [item.code for item in found.findings] == ["unseen-features", *codes]
    if codes:
        assert found.findings[-1].values["middle"] == pytest.approx(found.outer.middle)


@pytest.mark.parametrize(("model", "exact"), [(DISC, np.pi), (BALL, 4 * np.pi / 3)], ids=["disc", "ball"])
def test_a_disc_and_a_ball_have_volumes_between_the_bounds(model, exact):
    found = identify_set(model, AT_ZERO, error=1.0)
    smallest, largest = found.volume
    assert smallest < exact < largest
    assert np.all(found.outer.lower <= -1)
    assert np.all(found.outer.upper >= 1)
    assert np.sum(np.maximum(np.abs(found.inner.lower), np.abs(found.inner.upper)) ** 2) <= 1


def test_the_set_of_a_curve_is_that_of_a_brute_scan():
    data = measured(DECAY, [2.0, 0.8])
    found = identify_set(DECAY, data, error=0.05)
    random = np.random.default_rng(0)
    points = random.uniform(found.outer.lower - 0.05, found.outer.upper + 0.05, (4000, 2))
    consistent = np.all(np.abs(DECAY.evaluate(points).values - data.values) <= 0.05, axis=(1, 2))
    told = found.contains(points)
    assert np.all(told[consistent] != 0)
    assert np.all(told[~consistent] != 1)
    assert np.mean(told[consistent] == 1) > 0.3
    assert consistent.sum() > 200


def test_a_set_in_pieces_has_them_all():
    model = PythonModel(lambda x: np.array([x**2]), {"x": (-2.0, 2.0)}, ["y"], NOWHEN)
    found = identify_set(model, Measurements.of(NOWHEN, {"y": [1.0]}), error=0.1)
    assert np.all(found.contains(np.array([[-1.0], [1.0]])) == 1)
    assert found.contains(np.array([[0.0]])) == 0


def test_a_parameter_over_decades_is_paved_by_its_logarithm():
    model = PythonModel(lambda k: np.log10(k) * np.ones(1), {"k": (1e2, 1e8)}, ["y"], NOWHEN)
    found = identify_set(model, Measurements.of(NOWHEN, {"y": [5.0]}), error=0.5)
    np.testing.assert_allclose(found.outer.lower, 10**4.5, rtol=0.02)
    np.testing.assert_allclose(found.outer.upper, 10**5.5, rtol=0.02)
    found = identify_set(
        PythonModel(lambda k: k * np.ones(1), [Parameter("k", 1.0, 100.0, log=False)], ["y"], NOWHEN),
        Measurements.of(NOWHEN, {"y": [50.0]}),
        error=5.0,
    )
    np.testing.assert_allclose(found.outer.upper, 55, rtol=1e-2)


@pytest.mark.parametrize(
    "error", [{"x": 0.1, "y": 10.0}, [0.1, 10.0], np.tile([0.1, 10.0], (41, 1))], ids=["mapping", "channels", "all"]
)
def test_errors_may_differ_from_channel_to_channel(error):
    """Channel x alone counts: |offset + slope t − data| ≤ 0.1 at t = 0 and 4 is a parallelogram of area 0.01."""
    found = identify_set(LINE, measured(LINE, [1.0, 2.0]), error=error)
    assert found.volume[0] < 2 * 0.1 * 2 * 0.1 / 4 < found.volume[1]
    np.testing.assert_allclose(found.outer["offset"].radius, 0.1, atol=0.01)
    np.testing.assert_allclose(found.outer["slope"].radius, 0.05, atol=0.005)


def test_values_that_were_not_measured_have_no_limits():
    whole = measured(LINE, [1.0, 2.0])
    values = whole.values.copy()
    values[1:40, 0] = np.nan
    gaps = Measurements.of(TIMES, {"x": values[:, 0]}, missing="leave-out")
    found = identify_set(LINE, gaps, error=0.1)
    every = identify_set(LINE, Measurements.of(TIMES, {"x": whole.values[:, 0]}), error=0.1)
    np.testing.assert_allclose(found.outer.lower, every.outer.lower, atol=1e-3)
    np.testing.assert_allclose(found.outer.upper, every.outer.upper, atol=1e-3)


def test_angles_that_wrap_count_modulo_a_turn():
    """|x − 0.5| ≤ 0.2 modulo 2π over [−7, 8]: three intervals."""
    model = PythonModel(lambda x: np.array([x]), {"x": (-7.0, 8.0)}, ["angle"], NOWHEN)
    found = identify_set(model, Measurements.of(NOWHEN, {"angle": [0.5]}, wraps=["angle"]), error=0.2)
    middles = 0.5 + 2 * np.pi * np.array([-1, 0, 1])
    assert np.all(found.contains(middles[:, None]) == 1)
    assert np.all(found.contains(middles[:2, None] + np.pi) == 0)
    assert found.volume[0] < 3 * 0.4 < found.volume[1]
    assert found.success


def test_inconsistent_data_have_an_empty_set_and_a_sentence_that_says_where():
    found = identify_set(DISC, Measurements.of(NOWHEN, {"r": [10.0]}), error=0.5)
    assert found.empty
    assert found.outer is None
    assert found.inner is None
    assert found.volume == (0.0, 0.0)
    assert [item.code for item in found.outcome] == ["empty-set", "nearest-run"]
    assert found.status == snapshot(
        "No parameters within the bounds are consistent with the data: everywhere, the surrogate differs from the data by more than their error. The nearest run, at x = 2, y = 2, differs by 4 times the error in channel 'r', time 0 s. Increase the error, widen the bounds, or check the model structure."
    )
    assert (found.verdict, found.tables()) == ("empty", ())
    (finding,) = found.findings
    assert (finding.code, finding.severity) == ("unseen-features", "note")
    assert finding.message.startswith("The set may have a component where the response has a narrow feature.")


def test_a_set_thinner_than_the_resolution_has_no_inner_box_and_it_is_said():
    found = identify_set(DISC, Measurements.of(NOWHEN, {"r": [1.0]}), error=1e-3)
    assert found.inner is None
    assert found.outer is not None
    assert "thin-set" in codes(found)


def test_too_few_boxes_are_said():
    found = identify_set(DISC, AT_ZERO, error=1.0, resolution=1e-3, most_boxes=300)
    assert not found.success
    assert "paving-unfinished" in codes(found)
    assert found.volume[0] < np.pi < found.volume[1]


def test_a_coarse_surrogate_is_said_and_keeps_the_boxes_right():
    bump = PythonModel(lambda x: np.array([1 / (1 + 25 * x**2)]), {"x": (-1.0, 1.0)}, ["y"], NOWHEN)
    found = identify_set(bump, Measurements.of(NOWHEN, {"y": [1.0]}), error=0.2, scheme=Tensor(2))
    assert found.outer["x"].lower <= -0.1 < 0.1 <= found.outer["x"].upper
    assert found.inner is None or (found.inner["x"].lower >= -0.1 and found.inner["x"].upper <= 0.1)


def test_true_runs_that_leave_the_error_are_not_believed():
    """A spike between the surrogate's runs, on a corner of the inner box that a smooth model has."""
    smooth = identify_set(DISC, AT_ZERO, error=1.0, scheme=Tensor(4), seed=0)
    corner = smooth.inner.upper

    def spiked(x, y):
        near = np.exp(-(((x - corner[0]) / 1e-6) ** 2) - ((y - corner[1]) / 1e-6) ** 2)
        return np.array([x**2 + y**2 + near])

    found = identify_set(
        PythonModel(spiked, DISC.parameters, ["r"], NOWHEN), AT_ZERO, error=1.0, scheme=Tensor(4), seed=0
    )
    assert smooth.success
    assert not found.success
    assert "inner-box-contradicted" in codes(found)


def test_failed_runs_are_passed_over_where_the_scheme_can_do_without_and_said():
    def fragile(x, y):
        if x + y > 2.9:
            raise RuntimeError("too far")
        return np.array([x**2 + y**2])

    model = PythonModel(fragile, DISC.parameters, ["r"], NOWHEN)
    found = identify_set(model, AT_ZERO, error=1.0, scheme=dalembert.surrogate.TotalDegree(2, oversampling=4))
    assert found.volume[0] < np.pi < found.volume[1]
    place = f"test_identify_set.py, line {fragile.__code__.co_firstlineno + 2}"
    failed = only(found, "failed-simulations").values["first"]
    assert failed.startswith(f"RuntimeError: too far ({place}) (at x = ")


def test_events_tell_of_runs_boxes_and_the_end():
    events = []
    found = identify_set(DISC, AT_ZERO, error=1.0, on_event=events.append)
    kinds = [event.kind for event in events]
    assert kinds[0] == "sampled"
    assert kinds[-1] == "finished"
    last = [event for event in events if event.kind == "paved"][-1]
    assert (last.inside, last.boundary, last.waiting) == (len(found.inside), len(found.boundary), 0)
    assert as_record(events[-1])["misfit"] is None


def test_the_same_call_gives_the_same_bits():
    one, same = (identify_set(DECAY, measured(DECAY, [2.0, 0.8]), error=0.05, seed=2) for _ in range(2))
    for name in ("inside", "boundary", "surrogate_error"):
        assert getattr(one, name).tobytes() == getattr(same, name).tobytes()
    assert (one.runs, one.status, one.provenance) == (same.runs, same.status, same.provenance)


@pytest.mark.parametrize(
    ("model", "data", "error"),
    [
        (DISC, AT_ZERO, 1.0),
        (DISC, Measurements.of(NOWHEN, {"r": [10.0]}, 0.1), 0.5),
        (LINE, measured(LINE, [1.0, 2.0]), {"x": 0.1, "y": 10.0}),
    ],
    ids=["disc", "empty", "line"],
)
def test_everything_comes_back_from_a_file_bit_for_bit(model, data, error, tmp_path):
    found = identify_set(model, data, error=error)
    found.save(tmp_path / "set.nc")
    back = ParameterSet.load(tmp_path / "set.nc")
    for name in ("error", "inside", "boundary", "surrogate_error"):
        ours, theirs = getattr(found, name), getattr(back, name)
        assert (ours.shape, ours.tobytes()) == (theirs.shape, theirs.tobytes()), name
    for name in ("parameters", "resolution", "runs", "seconds", "success", "status", "provenance", "volume", "empty"):
        assert getattr(back, name) == getattr(found, name), name
    for name in ("outer", "inner"):
        assert str(getattr(back, name)) == str(getattr(found, name))
    assert back.data.fingerprint == found.data.fingerprint
    assert back.summary() == found.summary()


def test_a_file_that_holds_something_else_is_told(tmp_path):
    path = tmp_path / "set.nc"
    with pytest.raises(DataError) as missing:
        ParameterSet.load(path)
    assert str(missing.value) == f"{path}: there is no such file; expected a result written by ParameterSet.save"


@pytest.mark.parametrize(
    ("settings", "message"),
    [
        ({"error": 0.0}, "identify_set: error has the value 0; expected finite positive numbers"),
        (
            {"error": [0.1, 0.2]},
            "an error of shape (2,) was given; expected one number, (channels,) = (1,) or (samples, channels) = (1, 1)",
        ),
        ({"error": {"s": 0.1}}, "error: unknown channel 's'; known: r"),
        ({"error": {}}, "no error given for channel 'r'; give one for each of r"),
        (
            {"error": 1.0, "resolution": 2.0},
            "resolution is 2.0; expected a part of the width, a number between 0 and 1",
        ),
        ({"error": 1.0, "most_boxes": 0}, "identify_set: most_boxes is 0; expected a whole number, at least 1"),
    ],
)
def test_arguments_that_cannot_be_meant_are_told(settings, message):
    with pytest.raises(InputError, match=says(message)):
        identify_set(DISC, AT_ZERO, **settings)


def test_a_nan_in_the_data_is_told():
    with pytest.raises(DataError, match=r"^channel 'r', sample 0 \(time 0 s\): nan; expected a finite number"):
        identify_set(DISC, Measurements.of(NOWHEN, {"r": [np.nan]}), error=1.0)


def test_another_scheme_may_be_given():
    found = identify_set(DISC, AT_ZERO, error=1.0, scheme=Adaptive(1e-8))
    assert found.provenance["method"]["settings"]["tolerance"] == 1e-8
