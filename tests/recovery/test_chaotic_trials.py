"""Three chaotic trials of a double pendulum without given deviations, recovered by ``shooting = true``."""

import pytest

from chaotic_trials import HEAD, SEEDS, TABLE, recovered
from conclusions import only


@pytest.mark.slow
@pytest.mark.parametrize("even", [True, False], ids=["even", "uneven"])
def test_a_study_without_other_settings_recovers_all_parameters(even, record_evidence):
    found = recovered(0, even=even)
    assert found.fit.success
    assert only(found.fit, "misfit-at-noise").values == {"source": "smoothed"}
    record_evidence(
        f"three chaotic trials with {'even' if even else 'uneven'} time stamps: largest error of 17 parameters, in "
        "standard deviations",
        0.0,
        max(map(abs, found.errors.values())),
        tolerance=3.0,
        topic="Identification of chaotic motion",
        kind="known truth",
        source="the values that the records are made with",
    )


def test_all_seeds_of_the_table_were_recovered():
    head, *rows = TABLE.read_text(encoding="utf-8").splitlines()
    assert head == HEAD
    cells = [row.split(",") for row in rows]
    stamps = [(str(seed), stamps) for seed in range(SEEDS) for stamps in ("even", "uneven")]
    assert [tuple(row[:2]) for row in cells] == stamps
    assert all(float(row[3]) < 3 and 0.9 < float(row[5]) < 1.1 for row in cells)
