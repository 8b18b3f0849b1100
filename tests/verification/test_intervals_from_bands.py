"""Intervals from the published bands of the flexible double pendulum, beside the published ones."""

import numpy as np
import pytest

import dalembert as da
from conclusions import only
from dalembert.surrogate import Adaptive, TotalDegree, fit
from flexible_pendulum import CHANNELS, table, tip

SOURCE = 'Guo & Jin, "Inverse dynamical problem of flexible multibody systems with interval uncertainty" (2025)'
TOPIC = "Intervals from bands"
ANGLES = {"theta1": (0.6, 1.0), "theta2": (0.4, 0.65)}


def ends(found: da.BandFit) -> np.ndarray:
    return np.stack([found.box.lower, found.box.upper], axis=1)


def test_table_a2(record_evidence) -> None:
    found = da.identify_bands(tip(ANGLES), table("a2"))
    record_evidence(
        "Table A2: intervals of theta1 and theta2",
        [[0.7461, 0.8247], [0.4974, 0.5498]],
        ends(found),
        tolerance=5e-5,
        topic=TOPIC,
        kind="published",
        source=f"{SOURCE}, table 4",
        unit="rad",
    )
    record_evidence(
        "Table A2: misfit by true runs (published by the improved swarm: 2.1717e-6)",
        0.0,
        found.checked_misfit,
        tolerance=1e-6,
        topic=TOPIC,
        kind="published",
        source=f"{SOURCE}, table 4",
        unit="m2",
    )
    record_evidence(
        "Table A2: simulations (published: 48 000)",
        100,
        found.simulations,
        tolerance=20,
        topic=TOPIC,
        kind="target",
        source="at most 120",
    )


@pytest.mark.slow
def test_table_a3(record_evidence) -> None:
    """The table holds the errors of the polynomials that it was made by, which no bounds of the pendulum have."""
    found = da.identify_bands(tip({"theta1": (1.4, 1.75), "theta2": (0.9, 1.2)}), table("a3"))
    record_evidence(
        "Table A3: intervals of theta1 and theta2 (the table is off by 7e-4 m at rms)",
        [[1.4923, 1.6493], [0.9948, 1.0996]],
        ends(found),
        tolerance=5e-4,
        topic=TOPIC,
        kind="published",
        source=f"{SOURCE}, table 5",
        unit="rad",
    )
    assert "inconsistent-bands" in {finding.code for finding in found.conclusions}
    assert "upper bound of channel 'AB.end.y', time 1.65 s" in found.status


@pytest.mark.slow
def test_table_a3_by_the_polynomials_that_it_was_made_by(record_evidence) -> None:
    """Nested surrogates of total degree 3 from the 4 x 4 root grid, on a surrogate of the pendulum for speed."""
    searched = {"theta1": (1.4, 1.75), "theta2": (0.9, 1.2)}
    model = tip(searched)
    exact = fit(
        lambda points: model.evaluate(points).only().reshape(len(points), -1),
        model.parameters.lower,
        model.parameters.upper,
        Adaptive(1e-5, most_runs=900),
    )
    quick = da.PythonModel(
        lambda theta1, theta2: exact([[theta1, theta2]]).reshape(-1, 2), searched, CHANNELS, model.coordinate.values
    )
    method = da.Nested(da.ParticleSwarm(), TotalDegree(3, oversampling=1.6))
    found = da.identify_bands(quick, table("a3"), method=method)
    record_evidence(
        "Table A3, nested with total degree 3: intervals of theta1 and theta2",
        [[1.4923, 1.6493], [0.9948, 1.0996]],
        ends(found),
        tolerance=2e-4,
        topic=TOPIC,
        kind="published",
        source=f"{SOURCE}, table 5",
        unit="rad",
    )
    record_evidence(
        "Table A3, nested with total degree 3: misfit (published by the improved swarm: 3.0576e-5)",
        0.0,
        found.misfit,
        tolerance=1e-6,
        topic=TOPIC,
        kind="published",
        source=f"{SOURCE}, table 5",
        unit="m2",
    )


@pytest.mark.slow
def test_table_a4(record_evidence) -> None:
    """Said to have theta1 within 5 %, too; its first row has it fixed, and so it comes out."""
    found = da.identify_bands(tip({**ANGLES, "youngs_ab": (1.7e7, 2.3e7)}), table("a4"))
    record_evidence(
        "Table A4: intervals of theta2 / (pi/6) and E_AB / 20 MPa",
        [[0.95, 1.05], [0.95, 1.05]],
        ends(found)[1:] / [[np.pi / 6], [2e7]],
        tolerance=3e-4,
        topic=TOPIC,
        kind="published",
        source=f"{SOURCE}, table 6",
    )
    record_evidence(
        "Table A4: radius of theta1, which its first row has fixed",
        0.0,
        found.radius[0],
        tolerance=1e-4,
        topic=TOPIC,
        kind="published",
        source=f"{SOURCE}, table A4",
        unit="rad",
    )
    record_evidence(
        "Table A4: misfit by true runs (published: 2.6023e-5 and 6.0421e-5)",
        0.0,
        found.checked_misfit,
        tolerance=3e-6,
        topic=TOPIC,
        kind="published",
        source=f"{SOURCE}, table 6",
        unit="m2",
    )
    assert only(found.identifiability(), "zero-radius").values["parameter"] == "theta1"
