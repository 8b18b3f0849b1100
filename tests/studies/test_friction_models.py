"""Dry friction in a joint is found necessary by its predictions, not by its smaller misfit alone."""

from pathlib import Path

import pytest

from dalembert.study import load, run_study
from dalembert.study.run.compare_runs import compare_runs

STUDIES = Path(__file__).parents[2] / "studies" / "friction-pendulum"


@pytest.mark.slow
def test_the_model_with_dry_friction_predicts_best(tmp_path):
    runs = [run_study(load(STUDIES / f"{name}.toml"), tmp_path / name)[0] for name in ("viscous", "identify")]
    found = compare_runs(runs)
    assert found.models == ("identify", "viscous")
    assert found.findings[0].code == "best-model"
    assert found.elpd == pytest.approx([1996.7, 1520.3], abs=0.5)
    assert found.aicc == pytest.approx([-3999.7, -3195.3], abs=0.5)
    assert -found.difference[1] > 3 * found.difference_deviation[1]
