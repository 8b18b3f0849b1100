"""Warnings on unit, delay and model in cases drawn by seed, and bands of predictions on unseen records."""

from dataclasses import replace

import numpy as np
import pytest

from unseen_records import CASES, MOTIONS, row, table

TOPIC = "Statistics of estimates"
SOURCE = "synthetic records drawn by seed, tests/unseen_records.py"
FEW = (
    [("right", seed) for seed in range(4)]
    + [(case, seed) for case in ("unit", "delay", "model") for seed in (2, 9)]
    + [("delay", 6)]
)


def judged(record_evidence, rows):
    """Compare counts of warnings, and coverage, with what they must be."""
    of = {case: [item for item in rows if item.case == case] for case in CASES}
    for warning in ("unit", "delay", "model"):
        false = sum(getattr(item, warning) for item in of["right"])
        words = f"false alarms on the {warning}, {len(of['right'])} records that the model explains"
        record_evidence(
            words, 0.0, false / len(of["right"]), tolerance=0.01, topic=TOPIC, kind="known truth", source=SOURCE
        )
        right = sum(getattr(item, warning) for item in of[warning])
        words = f"warnings on the {warning}, {len(of[warning])} records for which it is wrong"
        record_evidence(
            words, 1.0, right / len(of[warning]), tolerance=1e-9, topic=TOPIC, kind="known truth", source=SOURCE
        )
    for motion in MOTIONS:
        for noise in ("white", "AR(1)"):
            shares = [item.covered for item in of["right"] if (item.motion, item.noise) == (motion, noise)]
            words = f"coverage of unseen records by 95 % bands, {motion} oscillator, {noise} noise"
            record_evidence(
                words, 0.945, float(np.mean(shares)), tolerance=0.045, topic=TOPIC, kind="known truth", source=SOURCE
            )


def test_warnings_and_bands_of_all_cases(record_evidence):
    rows = table()
    assert {case: sum(item.case == case for item in rows) for case in CASES} == CASES
    judged(record_evidence, rows)


@pytest.mark.parametrize(("case", "seed"), FEW)
def test_the_table_is_that_of_these_cases(case, seed):
    (known,) = [item for item in table() if (item.case, item.seed) == (case, seed)]
    found = row(case, seed)
    np.testing.assert_allclose([found.at, found.covered], [known.at, known.covered], atol=0.02)
    assert replace(found, at=0.0, covered=0.0) == replace(known, at=0.0, covered=0.0)


@pytest.mark.slow
def test_warnings_and_bands_of_all_cases_anew(record_evidence):
    judged(record_evidence, [row(case, seed) for case, count in CASES.items() for seed in range(count)])
