import numpy as np
import pytest

from dalembert.quantities import by_quantity, quantity
from dalembert.report.thinning import thin
from dalembert.tables import counted, shown, with_deviation


@pytest.mark.parametrize(
    ("value", "deviation", "text"),
    [
        (0.0, None, "0"),
        (-1.5, None, "−1.5"),
        (float("inf"), None, "∞"),
        (float("nan"), None, "–"),
        (None, None, "–"),
        (999999.7, None, "1 × 10⁶"),
        (123456.0, None, "123456"),
        (1.0, 0.5, "1.00"),
        (0.1, 2.0, "0.10"),
        (1.23456789e-7, 1e-9, "1.235 × 10⁻⁷"),
        (0.5, 0.0, "0.5"),
    ],
)
def test_a_number_shows_no_more_digits_than_are_known(value, deviation, text):
    assert shown(value, deviation) == text


@pytest.mark.parametrize(
    ("value", "deviation", "text"),
    [
        (0.785312, 2.1e-4, "0.78531 ± 0.00021"),
        (2.0e7, 1.23e5, "(2.000 ± 0.012) × 10⁷"),
        (-4.0, 0.25, "−4.00 ± 0.25"),
        (3.0, float("inf"), "3"),
        (3.0, 0.0, "3"),
    ],
)
def test_value_and_deviation_end_at_the_same_decimal(value, deviation, text):
    assert with_deviation(value, deviation) == text


def test_whole_numbers_stand_in_groups():
    assert counted(1234567) == "1 234 567"


def test_channels_of_one_quantity_share_an_axis():
    channels = ("a.x", "a.angle", "b.y", "c.x", "d.x", "e.x", "strain")
    assert by_quantity(channels, most=4) == [["a.x", "b.y", "c.x", "d.x"], ["e.x"], ["a.angle"], ["strain"]]
    assert quantity("system.kinetic_energy") == "energy (J)"


def test_a_short_series_is_left_alone():
    assert thin(np.sin(np.arange(100))).tolist() == list(range(100))


def test_a_long_series_keeps_its_extremes_and_its_ends():
    values = np.random.default_rng(0).standard_normal(50_000)
    values[123] = np.nan
    kept = thin(values, most=1000)
    assert len(kept) <= 1000
    assert np.all(np.diff(kept) > 0)
    assert {0, 49_999, int(np.nanargmax(values)), int(np.nanargmin(values))} <= set(kept.tolist())
