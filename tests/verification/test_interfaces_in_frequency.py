"""A lap joint by receptances with some modes, against its matrices with all degrees of freedom."""

from dataclasses import replace

import numpy as np

from dalembert.vibration import (
    HarmonicBalance,
    VibrationSystem,
    backbone,
    deformation,
    floquet_multipliers,
    frequency_response,
    track_resonance,
)
from lap_joint import bars, lap_joint, tip
from vibrating_systems import pressed_blocks

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


def test_the_nonlinear_mode_of_a_lap_joint_is_its_phase_resonance(record_evidence):
    """A force a quarter of a period ahead of the tip does the work of the mode's negative damping."""
    mesh, between = bars(4, 2)
    end, method = f"{tip(mesh)}.z", HarmonicBalance(3, samples=256, solver="receptance")
    mode = backbone(lap_joint(mesh, mesh, between, 4.0, 10_000.0), (1e-4, 2e-2), 1, method, dof=end)
    assert mode.converged.all()
    assert mode.damping.max() > 1.2 * mode.damping[0]  # some pairs slip

    def joint(force: float) -> VibrationSystem:
        return lap_joint(mesh, mesh, between, force, 10_000.0)

    options = {"dof": end, "kind": "harmonic 1", "phase": -np.pi / 2}
    track = track_resonance(joint, "force", [4.0], (70.8, 72.4), method, unit="N", **options)
    amplitude = float(track.amplitudes[0])
    for what, unit, expected, values, tolerance in (
        ("frequency", "Hz", track.frequencies[0], mode.frequencies, 1e-4),
        ("force", "N", 4.0, mode.forces, 1e-2),
    ):
        record_evidence(
            f"lap joint of {len(between)} pairs at {amplitude * 1e3:.3g} mm: {what} of the phase resonance",
            float(expected), float(np.interp(amplitude, mode.amplitudes, values)),
            tolerance=tolerance, relative=True, topic=TOPIC, unit=unit, kind="other method",
            source="forced motion a quarter of a period behind",
        )  # fmt: skip


def test_the_multipliers_of_a_block_on_pressed_contacts_are_those_of_all_its_coordinates(record_evidence):
    system = pressed_blocks()
    frequencies = np.array([0.13, 0.2, 0.3])
    sizes = [
        [
            abs(floquet_multipliers(system, curve, point)[0])
            for curve in [frequency_response(system, frequencies, HarmonicBalance(5, samples=512, solver=solver))]
            for point in range(3)
        ]
        for solver in ("receptance", "stiffness")
    ]
    assert max(sizes[1]) > 1.3
    for frequency, ours, other in zip(frequencies, *sizes, strict=True):
        record_evidence(
            f"three masses on two pressed contacts, {frequency:g} Hz: largest multiplier",
            other, ours, tolerance=1e-8, relative=True, topic=TOPIC, kind="other method",
            source="map over a period of all coordinates",
        )  # fmt: skip
