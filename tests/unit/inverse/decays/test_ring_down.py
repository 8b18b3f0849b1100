"""Ring-downs of modes whose frequency and damping are known in closed form, and of records that have defects."""

from dataclasses import replace

import numpy as np
import pytest

import dalembert as da
from dalembert.errors import DataError, InputError
from support import says

RATE = 1000.0
FREQUENCY, DAMPING = 20.0, 0.008


def decaying(*modes, duration=3.0, before=0.0, order=0):
    """Sum of decays (frequency, damping ratio, amplitude) that begin after some time."""
    times = np.arange(0, duration, 1 / RATE)
    total = np.zeros(len(times))
    for frequency, damping, amplitude in modes:
        omega = 2 * np.pi * frequency
        rate = omega * (-damping + 1j * np.sqrt(1 - damping**2))
        wave = amplitude * rate**order * np.exp(rate * np.maximum(times - before, 0))
        total += np.where(times >= before, wave.real, 0.0)
    return times, total


def record(*modes, noise=0.0, seed=0, name="tip", **how):
    times, values = decaying(*(modes or ((FREQUENCY, DAMPING, 1.0),)), **how)
    return da.Measurements.of(times, {name: values + noise * np.random.default_rng(seed).standard_normal(len(times))})


def within(result, frequency=FREQUENCY, damping=DAMPING, most=4.0):
    """Whether all estimates lie within some standard deviations of the truth."""
    first = np.abs(result.frequencies - frequency) / result.frequency_deviations
    second = np.abs(result.damping - damping) / result.damping_deviations
    return max(first.max(), second.max()) < most


@pytest.mark.parametrize(("quantity", "order"), [("displacement", 0), ("velocity", 1), ("acceleration", 2)])
def test_a_linear_mode_is_exact_at_every_kind_of_sensor(quantity, order):
    result = da.ring_down(record(order=order), quantity=quantity)
    assert result.frequencies == pytest.approx(np.full(len(result), FREQUENCY), rel=1e-7)
    assert result.damping == pytest.approx(np.full(len(result), DAMPING), rel=1e-5)
    sigma = DAMPING * 2 * np.pi * FREQUENCY
    assert result.amplitudes == pytest.approx(np.exp(-sigma * result.times), rel=1e-6)
    assert result.success
    known = np.isfinite(result.band_damping)
    assert np.array_equal(known, np.isfinite(result.band_frequencies))
    assert 0 < known.sum() < len(result)
    assert result.band_damping[known] == pytest.approx(np.full(known.sum(), DAMPING), rel=1e-2)


def test_noise_is_found_and_stated_by_the_deviations():
    result = da.ring_down(record(noise=2e-3), quantity="displacement")
    assert result.noise == pytest.approx([2e-3], rel=0.2)
    assert within(result)
    assert result.measurements().deviations[0] < 1e-3 * FREQUENCY


def test_the_covariance_of_windows_that_overlap_is_positive_definite():
    result = da.ring_down(record(noise=2e-3), quantity="displacement")
    matrix = result.covariance.reshape(2 * len(result), -1)
    spread = np.sqrt(np.diag(matrix))
    correlation = matrix / np.outer(spread, spread)
    assert np.linalg.eigvalsh(correlation).min() > -1e-9
    near = correlation.reshape(len(result), 2, len(result), 2)[-1, 0, -2, 0]
    assert 0.1 < near < 1


def test_other_modes_are_fitted_too():
    modes = ((FREQUENCY, DAMPING, 1.0), (67.0, 0.006, 0.3))
    result = da.ring_down(record(*modes, noise=1e-3), FREQUENCY, quantity="displacement")
    assert result.other_modes == pytest.approx([67.0], rel=3e-3)
    assert [finding.code for finding in result.findings] == ["other-modes"]
    assert within(result)


def test_a_weaker_mode_near_a_strong_one_is_the_first_on_request():
    modes = ((FREQUENCY, 0.004, 1.0), (33.0, 0.004, 0.05))
    result = da.ring_down(record(*modes, noise=1e-4), 33.0, quantity="displacement")
    assert result.other_modes == pytest.approx([FREQUENCY], rel=1e-2)
    assert within(result, 33.0, 0.004)
    with pytest.raises(DataError, match="no mode is near 26 Hz; the decay is that of"):
        da.ring_down(record(noise=1e-3), 26.0, quantity="displacement")


def test_a_mode_that_ends_early_is_named_and_left_out_then():
    modes = ((FREQUENCY, 0.004, 1.0), (47.0, 0.015, 0.3), (71.0, 0.0003, 0.1))
    result = da.ring_down(record(*modes, noise=1e-3), FREQUENCY, quantity="displacement")
    assert result.other_modes == pytest.approx([47.0, 71.0], rel=3e-3)
    assert within(result, damping=0.004)


def test_the_reference_is_no_channel_of_noise():
    times, values = decaying((FREQUENCY, DAMPING, 1.0))
    noise = np.random.default_rng(5).standard_normal((2, len(times)))
    data = da.Measurements.of(times, {"tip": values + 2e-3 * noise[0], "idle": 30 * noise[1]})
    result = da.ring_down(data, quantity="displacement")
    assert result.reference == "tip"
    assert within(result)


def test_a_strain_has_no_unit_and_an_offset_changes_nothing():
    plain = da.ring_down(record(noise=2e-3), quantity="strain")
    times, values = decaying((FREQUENCY, DAMPING, 1.0))
    moved = values + 100.0 + 2e-3 * np.random.default_rng(0).standard_normal(len(times))
    offset = da.ring_down(da.Measurements.of(times, {"tip": moved}), quantity="strain")
    assert plain.unit == offset.unit == ""
    assert offset.frequencies == pytest.approx(plain.frequencies, rel=1e-9)


def test_the_deviation_of_amplitudes_is_about_that_of_their_errors():
    ratios = []
    for seed in range(12):
        result = da.ring_down(record(noise=1e-2, seed=seed), quantity="displacement")
        truth = np.exp(-DAMPING * 2 * np.pi * FREQUENCY * result.times)
        ratios += ((result.amplitudes - truth) / result.amplitude_deviations).tolist()
    assert 0.7 < np.sqrt(np.mean(np.square(ratios))) < 1.3


def test_a_smooth_extreme_with_equal_digits_is_not_clipped():
    times = np.arange(0, 4, 2e-4)
    values = np.exp(-1.0 * times) * np.cos(2 * np.pi * 5 * times)
    rounded = np.round(values * 2048) / 2048
    result = da.ring_down(da.Measurements.of(times, {"tip": rounded}), quantity="displacement", start=0.0)
    assert result.frequencies == pytest.approx(np.full(len(result), 5.0), rel=1e-2)


def test_close_modes_are_separated():
    modes = ((FREQUENCY, 0.003, 1.0), (1.05 * FREQUENCY, 0.003, 0.3))
    result = da.ring_down(record(*modes, noise=1e-3, duration=12.0), FREQUENCY, quantity="displacement")
    assert result.other_modes == pytest.approx([1.05 * FREQUENCY], rel=1e-3)
    assert within(result, damping=0.003)


def test_the_decay_begins_where_the_contact_of_the_hammer_ends():
    times, values = decaying((FREQUENCY, DAMPING, 1.0), before=0.2, order=2)
    push = np.where(np.abs(times - 0.2) < 0.003, np.cos(np.pi * (times - 0.2) / 0.006), 0.0)
    values = values + 2e5 * push + 10 * np.random.default_rng(1).standard_normal(len(times))
    data = da.Measurements.of(times, {"tip": values, "hammer": push})
    named = da.ring_down(data, quantity="acceleration", force="hammer")
    assert 0.2 < named.times[0] < 0.4
    assert within(named)
    alone = da.ring_down(data, channels=["tip"], quantity="acceleration")
    assert 0.2 < alone.times[0] < 0.5
    assert within(alone)


def test_several_sensors_give_the_shape_of_the_mode():
    times, values = decaying((FREQUENCY, DAMPING, 1.0))
    data = da.Measurements.of(times, {"tip": values, "middle": -0.4 * values})
    data = replace(data, source_units={"tip": "mm", "middle": "mm"})
    result = da.ring_down(data)
    assert (result.reference, result.unit) == ("tip", "m")
    assert result.shapes[:, 1, 0] == pytest.approx(np.full(len(result), -0.4), rel=1e-6)
    assert "Shape of the mode" in result.summary()


def test_repetitions_are_joined():
    records = [record(noise=2e-3, seed=seed) for seed in (1, 2)]
    result = da.ring_down(records, quantity="displacement")
    assert set(result.record.tolist()) == {1, 2}
    assert within(result)
    rows = np.flatnonzero(result.record == 2)
    assert not result.covariance[0, :, rows[0]].any()


def test_a_result_is_read_again_from_its_file(tmp_path):
    result = da.ring_down(record(noise=2e-3), quantity="displacement")
    result.save(tmp_path / "mode.nc")
    again = da.RingDown.load(tmp_path / "mode.nc")
    assert again.summary() == result.summary()
    assert np.array_equal(again.covariance, result.covariance)


def test_figures_have_the_points_of_both_methods():
    result = da.ring_down([record(noise=2e-3, seed=seed) for seed in (1, 2)], quantity="displacement")
    figures = result.figures()
    assert set(figures) == {"ring-down", "decay"}
    assert len(figures["ring-down"].data) == 4
    assert figures["decay"].data[2].name == "band-pass filter"


def test_a_beat_that_does_not_separate_is_refused():
    modes = ((FREQUENCY, 0.02, 1.0), (1.03 * FREQUENCY, 0.02, 0.8))
    with pytest.raises(DataError, match="do not separate in a record of"):
        da.ring_down(record(*modes, noise=1e-4, duration=2.0), FREQUENCY, quantity="displacement")


@pytest.mark.parametrize(
    ("data", "how", "kind", "sentence"),
    [
        (
            record(), {}, InputError,
            "ring_down: channel 'tip' may measure a displacement, a velocity, an acceleration or a strain. Say which, "
            "for example quantity={'tip': 'acceleration'}",
        ),
        (
            record(), {"quantity": "speed"}, InputError,
            "ring_down: unknown quantity 'speed'; known: acceleration, displacement, strain, velocity",
        ),
        (
            record(), {"quantity": "displacement", "channels": ["top"]}, InputError,
            "ring_down: unknown channel 'top'; did you mean 'tip'?",
        ),
        (
            record(duration=0.3), {"quantity": "displacement"}, DataError,
            "ring_down: the free decay lasts 0.299 s, 6 periods of 20 Hz; expected at least 12. Record for longer, or "
            "look whether the frequency is that of the mode",
        ),
        (
            record((200.0, DAMPING, 1.0)), {"quantity": "displacement"}, DataError,
            "ring_down: 5 samples in a period of 200 Hz; expected at least 16. Sample faster",
        ),
        (
            record(), {"quantity": "displacement", "frequency": 700.0}, InputError,
            "ring_down: the frequency is 700 Hz; expected a positive one below 500 Hz, half of the sampling rate",
        ),
        (
            [record(), record(name="top")], {"quantity": "displacement"}, InputError,
            "ring_down: record 2 has the channels top; expected tip, as in the first",
        ),
        (
            record((FREQUENCY, -0.004, 0.1)), {"quantity": "displacement", "start": 0.0}, DataError,
            "ring_down: the amplitude grows. Give the part of the record in which the mode decays, start=..., or look "
            "whether something excites it",
        ),
        (
            record(), {"quantity": {"Tip": "velocity"}}, InputError,
            "ring_down: unknown channel 'Tip'; did you mean 'tip'?",
        ),
        (
            record(), {"quantity": "displacement", "channels": ["tip", "tip"]}, InputError,
            "ring_down: channels names 'tip' more than once. Name each once",
        ),
        (
            record(), {"quantity": "displacement", "reference": "top"}, InputError,
            "ring_down: reference: unknown channel 'top'; did you mean 'tip'?",
        ),
        (
            record(), {"quantity": "displacement", "start": 50.0}, InputError,
            "ring_down: start is 50 s; expected a time of the record, 0 to 2.999 s",
        ),
        (
            da.Measurements.of(np.arange(3000) / 1000, {"tip": np.ones(3000)}), {"quantity": "strain"}, DataError,
            "ring_down: 'tip' is 1 at all times. Leave it out, by channels=[...]",
        ),
        (
            da.Measurements.of(np.delete(np.arange(3000), 700) / 1000, {"tip": np.delete(record().values[:, 0], 700)}),
            {"quantity": "displacement"}, DataError,
            "ring_down: the samples behind 0.699 s are not evenly spaced. Give a part without gaps, by "
            "Measurements.between, or resample the record, by Measurements.resampled",
        ),
        (
            da.Measurements.of(record().coordinate, {"tip": record().values[:, 0], "hammer": np.zeros(3000)}),
            {"quantity": "displacement", "force": "hammer"}, DataError,
            "ring_down: the force 'hammer' has no pulse. Name the hammer's channel, or leave it out",
        ),
        (
            [], {}, InputError,
            "ring_down: data must be Measurements, or a list of them. Read a file by dalembert.read",
        ),
    ],
)  # fmt: skip
def test_a_record_that_cannot_be_used_is_refused(data, how, kind, sentence):
    with pytest.raises(kind, match=says(sentence)):
        da.ring_down(data, **how)


def test_clipped_and_missing_samples_are_refused():
    times, values = decaying((FREQUENCY, DAMPING, 1.0))
    clipped = da.Measurements.of(times, {"tip": np.clip(values, -0.8, 0.8)})
    with pytest.raises(DataError, match=r"of 'tip' are clipped at 0\.8, the first at 0 s"):
        da.ring_down(clipped, quantity="displacement")
    values[100] = np.nan
    missing = da.Measurements.of(times, {"tip": values}, missing="leave-out")
    with pytest.raises(DataError, match=r"the decay has 1 missing sample, the first at 0\.1 s"):
        da.ring_down(missing, quantity="displacement")


def test_a_decay_in_noise_says_that_it_is_too_short_for_its_damping():
    with pytest.raises(DataError, match="too short, or too noisy, for the damping"):
        da.ring_down(record((FREQUENCY, 1e-5, 1.0), noise=0.3, duration=1.0), quantity="displacement", start=0.0)
