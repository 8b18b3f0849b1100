"""A lap joint by receptances with some modes, against its matrices with all degrees of freedom."""

from dataclasses import replace

import numpy as np

from dalembert.vibration import HarmonicBalance, deformation, frequency_response
from lap_joint import bars, lap_joint, tip

TOPIC = "Interfaces of many contacts"
SOURCE = "dynamic stiffness of all degrees of freedom, factorised at each frequency"


def test_a_lap_joint_by_some_modes_is_that_of_all_its_degrees_of_freedom(record_evidence):
    mesh, between = bars(6, 4)
    posed, end = lap_joint(mesh, mesh, between, force=4.0, bolt=10_000.0), f"{tip(mesh)}.z"
    assert mesh.size > 1500  # so that not all modes are computed
    method = HarmonicBalance(1, samples=64, events=False, tolerance=1e-12)
    curve, other = (
        frequency_response(posed, np.array([70.0, 71.0]), replace(method, solver=solver), observe=[end], check=False)
        for solver in ("receptance", "stiffness")
    )
    for place, frequency in enumerate(curve.frequencies):
        record_evidence(
            f"lap joint of {len(between)} pairs at {frequency:g} Hz: amplitude of the tip",
            other.amplitude(end)[place], curve.amplitude(end)[place],
            tolerance=1e-4, relative=True, topic=TOPIC, unit="m", kind="other method", source=SOURCE,
        )  # fmt: skip
    shape = deformation(posed, curve, 1)
    assert mesh.nodes is not None
    there = mesh.nodes.places[mesh.nodes.rows([tip(mesh)])[0]]
    place = np.argmin(np.linalg.norm(shape.places - there, axis=1))
    size = np.hypot(*shape.coefficients[place, 2, 1:3])
    np.testing.assert_allclose(size, curve.amplitude(end, "harmonic 1")[1], rtol=1e-8)
