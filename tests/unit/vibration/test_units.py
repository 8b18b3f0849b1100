"""Rotations are told in rad wherever a response over frequency is told."""

import numpy as np

from dalembert.structure import Dofs, Structure
from dalembert.vibration import (
    CubicSpring,
    FrequencyResponse,
    HarmonicBalance,
    HarmonicForce,
    VibrationSystem,
    backbone,
    frequency_response,
    frequency_responses,
)

METHOD = HarmonicBalance(3)
BAND = np.array([0.1, 0.12]) / (2 * np.pi)


def system(stiffness: float = 0.1) -> VibrationSystem:
    """A point that moves and turns, each against a spring."""
    made = VibrationSystem(Structure(np.eye(2), np.diag([1.0, 3.0]), Dofs(("A.x", "A.rz")), 0.05 * np.eye(2)))
    made.add(HarmonicForce("A.x", 1.0))
    made.add(HarmonicForce("A.rz", 1.0))
    made.add(CubicSpring("hard", "A.rz", stiffness=stiffness))
    return made


def test_a_curve_and_a_family_tell_rotations_in_rad() -> None:
    peaks = frequency_response(system(), BAND, METHOD).tables(["A.x", "A.rz"])[0]
    assert {row[0].text: row[-1].text for row in peaks.rows} == {"A.x": "m", "A.rz": "rad"}
    family = frequency_responses(system, "stiffness", [0.1, 0.2], BAND, METHOD, workers=1)
    moved, turned = family.tables(["A.x", "A.rz"])
    assert (moved.columns[1], turned.columns[1]) == ("peak (m)", "peak (rad)")


def test_a_mode_over_a_rotation_is_told_in_rad() -> None:
    mode = backbone(system(), [0.1, 0.2], 2, METHOD, dof="A.rz")
    assert mode.facts()["amplitude"] == "0.1 to 0.2 rad"
    assert mode.to_xarray()["amplitudes"].attrs["units"] == "rad"


def test_channels_of_a_model_have_the_units_of_their_degrees_of_freedom() -> None:
    model = FrequencyResponse(system, {"stiffness": (0.1, 0.3)}, ["A.x peak", "A.rz rms"], BAND, METHOD)
    assert [channel.unit for channel in model.channels] == ["m", "rad"]
