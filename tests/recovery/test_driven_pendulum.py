"""Torque constant, delay and friction of a pendulum that is driven by a recorded current."""

import csv

import numpy as np
import pytest

from driven_pendulum import SHARE, TABLE, TRUE, identified


def table() -> dict[int, dict[str, float]]:
    with TABLE.open(encoding="utf-8", newline="") as file:
        rows = list(csv.reader(file))[1:]
    return {
        int(row[0]): dict(zip(TRUE, map(float, row[1:7:2]), strict=True))
        | {f"{name} error": float(error) for name, error in zip(TRUE, row[2:8:2], strict=True)}
        for row in rows
    }


def within(errors: np.ndarray) -> np.ndarray:
    """How many of the seeds have each number within the share of deviations, (3,)."""
    return np.sum(np.abs(errors) < SHARE, axis=0)


def test_the_table_has_each_number_within_two_deviations_in_90_to_99_of_100_seeds() -> None:
    rows = table()
    assert sorted(rows) == list(range(100))
    counts = within(np.array([[row[f"{name} error"] for name in TRUE] for row in rows.values()]))
    assert np.all((counts >= 90) & (counts <= 99)), counts


@pytest.mark.parametrize("seed", [0, 1, 2, 3])
def test_a_record_tells_what_the_table_has(seed: int) -> None:
    fit, errors = identified(seed)
    assert fit.success
    assert not fit.findings
    assert np.abs(errors).max() < 3.5
    row = table()[seed]
    for name in TRUE:
        assert fit.estimates[name] == pytest.approx(row[name], rel=1e-4), name


@pytest.mark.slow
def test_each_number_is_within_two_deviations_in_90_to_99_of_100_seeds() -> None:
    counts = within(np.array([identified(seed)[1] for seed in range(100)]))
    assert np.all((counts >= 90) & (counts <= 99)), counts
