"""Findings on records that the model explains: the table of ``python tests/false_alarms.py``."""

import pytest

from false_alarms import FAMILIES, TRUE, alarms, table

TOPIC = "Statistics of estimates"
SOURCE = "synthetic records drawn by seed, tests/false_alarms.py"
MOST = 0.02


@pytest.mark.parametrize("family", FAMILIES)
def test_each_finding_has_few_false_alarms(record_evidence, family):
    rows = {code: row for (name, code), row in table().items() if name == family}
    (number,) = {of for _, of in rows.values()}
    assert number >= 100
    false = [count for code, (count, _) in rows.items() if code and (family, code) not in TRUE]
    record_evidence(
        f"false alarms of the finding that has most of them, {family}, {number} records that the model explains",
        0.0,
        max(false, default=0) / number,
        tolerance=MOST,
        topic=TOPIC,
        kind="known truth",
        source=SOURCE,
    )


@pytest.mark.parametrize("seed", [29, 42, 56])
def test_unequal_noise_of_two_channels_raises_no_alarm(seed):
    """Without allowance for the noise of each channel these seeds have a periodic part, correlation and drift."""
    assert alarms("two channels", seed) == []
