"""Records of different rates in one: each channel is filtered, differentiated and resampled at its own samples."""

import numpy as np
import pytest

from dalembert.data import Measurements, derivative, merged
from dalembert.errors import DataError

FAST = np.arange(200) * 0.01
SLOW = 0.003 + np.arange(40) * 0.05
NEW = np.linspace(0.1, 1.9, 37)


def record(name, along, deviations=1e-3):
    noise = 1e-3 * np.random.default_rng(len(along)).standard_normal(len(along))
    return Measurements.of(along, {name: np.sin(3 * along) + noise}, deviations, missing="leave-out")


def one(data, name):
    column = data.channels.index(name)
    return data.values[data.taken[:, column], column]


PARTS = (record("angle", FAST), record("force", SLOW))
BOTH = merged(PARTS)


def test_a_channel_has_its_own_samples():
    assert BOTH.taken.sum(axis=0).tolist() == [200, 40]
    assert len(BOTH.values) == 240
    for part in PARTS:
        assert part.taken.all()
        np.testing.assert_array_equal(one(BOTH, part.channels[0]), part.values[:, 0])


@pytest.mark.parametrize(
    "change",
    [
        lambda data: data.filtered(4.0),
        lambda data: data.decimated(2, 4.0),
        lambda data: data.resampled(NEW),
        lambda data: data.resampled(NEW, gap=0.07),
        lambda data: data.between(0.2, 1.5),
        lambda data: data.between(0.2, 1.5).filtered(4.0),
    ],
)
def test_a_merged_record_changes_as_its_parts_do(change):
    changed = change(BOTH)
    for column, part in enumerate(PARTS):
        alone = change(part)
        np.testing.assert_allclose(one(changed, part.channels[0]), alone.values[:, 0], atol=1e-12)
        assert changed.deviations[column] == pytest.approx(alone.deviations[0], rel=1e-12)


def test_derivatives_of_merged_records_are_those_of_the_parts():
    for part in PARTS:
        (name,) = part.channels
        both, alone = derivative(BOTH, name), derivative(part, name)
        there = BOTH.taken[:, BOTH.channels.index(name)]
        np.testing.assert_allclose(both.values[there], alone.values, atol=1e-12)
        assert np.isnan(both.values[~there]).all()
        assert (both.window, both.error) == (alone.window, pytest.approx(alone.error))
        further = BOTH.with_derivative(name, "rate")
        np.testing.assert_array_equal(further.taken[:, -1], there)


def test_lost_samples_of_a_merged_record_are_gaps():
    values = PARTS[0].values.copy()
    values[80:90] = np.nan
    lost = merged([Measurements(PARTS[0].coordinate, ("angle",), values, np.array([1e-3]), "leave-out"), PARTS[1]])
    assert lost.resampled([0.5, 0.85, 1.5]).present.tolist() == [[True, True], [False, True], [True, True]]


def test_a_merged_record_is_merged_again_and_cut():
    third = record("way", 0.001 + np.arange(100) * 0.02)
    three = merged([BOTH, third])
    assert three.taken.sum(axis=0).tolist() == [200, 40, 100]
    np.testing.assert_array_equal(three.first(10).taken, three.taken[:10])


def test_plain_thinning_of_merged_records_is_refused():
    with pytest.raises(DataError, match="decimate them, or thin each record before they are merged"):
        BOTH.every(5)


def test_a_mask_of_another_shape_is_refused():
    with pytest.raises(DataError, match=r"sampled of shape \(3,\) was given; expected \(200, 1\)"):
        Measurements(PARTS[0].coordinate, ("x",), PARTS[0].values, sampled=np.ones(3, dtype=bool))
