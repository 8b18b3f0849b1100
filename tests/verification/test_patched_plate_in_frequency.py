"""The plate with rubbing patches: resonance with free and stuck feet, and the preload that damps it best."""

import importlib.util
from pathlib import Path

import numpy as np
import pytest
from scipy.linalg import eigh, null_space

from dalembert import HarmonicBalance, frequency_response
from dalembert.vibration.interface.lowering import lower

STUDY = Path(__file__).parents[2] / "studies" / "patched-plate" / "plate.py"
TOPIC = "Friction in frequency"
SOURCE = "Ma, Li, Fan, Wu: Friction damping analysis by an accelerated dynamic Lagrangian method (2019)"
CHOSEN = f"{SOURCE}; with other patches and forces"


@pytest.fixture(scope="module")
def plate():
    spec = importlib.util.spec_from_file_location("plate", STUDY)
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


@pytest.mark.slow
def test_the_preload_that_damps_the_fifth_mode_best(record_evidence, plate) -> None:
    ends, method = (394.0, 407.0), HarmonicBalance(harmonics=5, sampling=1e-3)
    free = frequency_response(plate.build(preload=0.0), np.linspace(399.0, 402.0, 121), HarmonicBalance(harmonics=1))
    curves = {load: frequency_response(plate.build(preload=load), ends, method) for load in (60.0, 75.0, 90.0)}
    assert all(curve.converged.all() for curve in curves.values())
    peaks = {load: curve.peak("left", "harmonic 1").amplitude for load, curve in curves.items()}
    best = min(peaks, key=lambda load: peaks[load])
    record_evidence(
        "plate with four patches, peak with free feet", 400.6, free.peak("left").frequency,
        unit="Hz", tolerance=0.5, topic=TOPIC, kind="published", source=SOURCE,
    )  # fmt: skip
    record_evidence(
        "plate with four patches, best preload of 60, 75 and 90 N at each node of a foot", 80.0, best,
        unit="N", tolerance=10.0, topic=TOPIC, kind="published", source=CHOSEN,
    )  # fmt: skip
    lowered = 1 - peaks[best] / free.peak("left", "harmonic 1").amplitude
    assert 0.6 < lowered < 0.9  # how deep depends on where the forces act, which is not published
    record_evidence(
        "plate with four patches, part by which the best preload lowers the peak of free feet",
        0.754, lowered, tolerance=None, topic=TOPIC, kind="published", source=CHOSEN,
    )  # fmt: skip


@pytest.mark.slow
def test_stuck_feet(record_evidence, plate) -> None:
    """The structure with all relative motions of the contacts held; the fifth mode by its shape, since it is sixth."""
    system = plate.build(preload=1.0)
    structure, rows = system.structure, lower(system).matrix.toarray()
    held = null_space(rows)
    squares, shapes = eigh(held.T @ structure.stiffness @ held, held.T @ structure.mass @ held, subset_by_index=[0, 7])
    left, front = ((held @ shapes)[structure.dofs.index(f"{point}.z")] for point in ("left", "front"))
    antisymmetric = [mode for mode in (4, 5) if left[mode] * front[mode] < 0]
    assert antisymmetric == [5]
    record_evidence(
        "plate with four patches, frequency with stuck feet, reduced", 408.4, np.sqrt(squares[5]) / (2 * np.pi),
        unit="Hz", tolerance=0.5, topic=TOPIC, kind="published", source=CHOSEN,
    )  # fmt: skip
