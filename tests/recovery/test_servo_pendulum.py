"""Motor, gear and friction of a servo's pendulum from encoder records at three gains, and the motion at a fourth."""

import csv

import numpy as np
import pytest

from servo_pendulum import NAMES_IN_TABLE, SHARE, TABLE, TRUE, identified


def table() -> dict[int, dict[str, float]]:
    with TABLE.open(encoding="utf-8", newline="") as file:
        _, *rows = csv.reader(file)
    return {int(row[0]): dict(zip(NAMES_IN_TABLE, map(float, row[1:]), strict=True)) for row in rows}


def errors_of(row: dict[str, float]) -> np.ndarray:
    return np.array([row[f"{name} error"] for name in TRUE])


def test_the_table_has_all_numbers_within_three_deviations_in_95_of_100_seeds() -> None:
    rows = table()
    assert sorted(rows) == list(range(100))
    errors = np.array([errors_of(row) for row in rows.values()])
    assert np.sum(np.all(np.abs(errors) < SHARE, axis=1)) >= 95
    # The deviations are no larger than the errors are.
    assert np.all((errors.std(axis=0) > 0.8) & (errors.std(axis=0) < 1.2)), errors.std(axis=0)


def test_the_table_has_the_unseen_motion_within_its_band() -> None:
    rows = table().values()
    assert sum(row["read"] >= 0.95 for row in rows) >= 95
    assert 0.9 <= np.mean([row["moved"] for row in rows]) <= 0.99


@pytest.mark.parametrize("seed", [0, 1])
def test_a_set_of_records_tells_what_the_table_has(seed: int) -> None:
    fit, errors, read, moved = identified(seed)
    row = table()[seed]
    assert fit.success
    assert read == pytest.approx(row["read"], abs=0.02)
    assert moved == pytest.approx(row["moved"], abs=0.1)
    assert np.abs(errors).max() < 3.5
    for name in TRUE:
        assert fit.estimates[name] == pytest.approx(row[name], rel=1e-4), name
