"""The best preload of two interfaces, by rigid and by elastic contacts, as the study's page gives it."""

import runpy
from pathlib import Path

import pytest

SCRIPT = Path(__file__).parents[2] / "studies" / "two-interfaces" / "preload.py"


@pytest.mark.slow
@pytest.mark.parametrize(
    ("study", "preload", "amplitude", "at_80"),
    [("rigid.toml", 78.5, 110.1e-6, 111.6e-6), ("elastic.toml", 86.2, 120.9e-6, 138.4e-6)],
)
def test_the_best_preload_and_its_peak(study: str, preload: float, amplitude: float, at_80: float) -> None:
    best = runpy.run_path(str(SCRIPT))["best"](study)
    assert best.preload == pytest.approx(preload, abs=0.2)
    assert best.peak.amplitude == pytest.approx(amplitude, rel=2e-3)
    assert best.at_80.amplitude == pytest.approx(at_80, rel=2e-3)
