"""Tracks of a resonance: how they are kept, what they refuse; against whole curves in tests/verification."""

from pathlib import Path

import numpy as np
import pytest

from dalembert.errors import InputError
from dalembert.forward import Checkpoint
from dalembert.structure import lumped
from dalembert.vibration import (
    CubicSpring,
    ElasticSlider,
    FrictionContact,
    HarmonicBalance,
    HarmonicForce,
    ResonanceTrack,
    VibrationSystem,
    frequency_response,
    track_resonance,
)
from dalembert.vibration.balance.equations import Equations
from support import says

METHOD = HarmonicBalance(3)
WINDOW = (0.12, 0.25)


def oscillator(force: float) -> VibrationSystem:
    system = VibrationSystem(lumped({"m": 1.0}, [("m", None, 1.0, 0.05)]))
    system.add(HarmonicForce("m", force))
    system.add(CubicSpring("cubic", "m", stiffness=0.1))
    return system


def test_a_track_is_kept_to_the_bit(tmp_path: Path) -> None:
    track = track_resonance(oscillator, "force", [0.05, 0.1], WINDOW, METHOD, dof="m", unit="N")
    track.save(tmp_path / "track.nc")
    again = ResonanceTrack.load(tmp_path / "track.nc")
    assert (again.parameter, again.unit, again.dof, again.kind) == ("force", "N", "m.x", "peak")
    np.testing.assert_array_equal(again.amplitudes, track.amplitudes)
    np.testing.assert_array_equal(again.solves, track.solves)
    assert again.provenance == track.provenance
    assert again.summary() == track.summary()
    assert track.best() == 0.05


def rubbing(preload: float) -> VibrationSystem:
    system = VibrationSystem(lumped({"m": 1.0}, [("m", None, 1.0, 0.04)]))
    system.add(HarmonicForce("m", 1.0))
    system.add(
        FrictionContact("slider", "m", friction=0.5, preload=preload, law=ElasticSlider(tangential_stiffness=0.8))
    )
    return system


@pytest.mark.parametrize(("samples", "solver"), [(128, "stiffness"), (1024, "stiffness"), (128, "receptance")])
def test_a_motion_alike_to_both_sides_has_its_peak_at_either(samples: int, solver: str) -> None:
    """Rounding tells which of two opposite extremes is the larger; the track must climb all the same."""
    method, loads = HarmonicBalance(3, samples=samples, solver=solver), [2.0, 4.0, 8.0]
    track = track_resonance(rubbing, "preload", loads, (0.1, 0.3), method, dof="m")
    peaks = [frequency_response(rubbing(load), np.linspace(0.1, 0.3, 401), method).peak("m") for load in loads]
    np.testing.assert_allclose(track.amplitudes, [peak.amplitude for peak in peaks], rtol=1e-3)


def test_a_track_begins_from_a_curve() -> None:
    curve = frequency_response(oscillator(0.05), WINDOW, METHOD)
    track = track_resonance(oscillator, "force", [0.05, 0.1], curve, METHOD, dof="m", kind="harmonic 1")
    own = track_resonance(oscillator, "force", [0.05, 0.1], WINDOW, METHOD, dof="m", kind="harmonic 1")
    np.testing.assert_allclose(track.frequencies, own.frequencies, rtol=1e-7)
    assert track.solves[0] < own.solves[0]


def test_a_peak_that_is_not_found_is_marked_and_the_track_goes_on() -> None:
    """A window that ends below the resonance of the first system, and one value that the method cannot reach."""
    hard = HarmonicBalance(3, iterations=4, halvings=1)
    track = track_resonance(oscillator, "force", [0.02, 5.0, 0.03], WINDOW, hard, dof="m")
    np.testing.assert_array_equal(track.converged, [True, False, True])
    assert np.isnan(track.frequencies[1])
    assert [row[-1].text for row in track.tables()[0].rows] == ["", "not found", ""]


def test_a_track_that_was_interrupted_goes_on_where_it_was(tmp_path: Path, monkeypatch) -> None:
    asked = rubbing, "preload", [2.0, 4.0, 8.0], (0.1, 0.3), METHOD
    solve, calls, left = Equations.newton, [], []

    def limited(own: Equations, *given, **more):
        calls.append(own)
        if len(calls) == left[0]:
            raise KeyboardInterrupt
        return solve(own, *given, **more)

    monkeypatch.setattr(Equations, "newton", limited)
    left.append(0)
    undisturbed, once = track_resonance(*asked, dof="m").to_xarray(), len(calls)
    calls.clear()
    left[0] = once - 10
    with pytest.raises(KeyboardInterrupt), Checkpoint(tmp_path / "checkpoint") as checkpoint:
        track_resonance(*asked, dof="m", checkpoint=checkpoint)
    left[0] = 0
    for _ in range(2):
        with Checkpoint(tmp_path / "checkpoint") as checkpoint:
            resumed = track_resonance(*asked, dof="m", checkpoint=checkpoint)
        assert resumed.to_xarray().identical(undisturbed)
        assert checkpoint.spared > 0
    assert len(calls) == once + 1  # the one that the interruption hit


@pytest.mark.parametrize(
    ("options", "sentence"),
    [
        ({"values": [np.nan]}, "track_resonance: the values of 'force' are [nan]; expected one or more numbers"),
        ({"dof": "n"}, "unknown degree of freedom 'n'; known: m.x"),
        (
            {"kind": "mean"},
            "the kind of amplitude is 'mean'; expected 'peak', 'rms', or 'harmonic K' with K among the harmonics kept: "
            "0, 1, 2, 3",
        ),
    ],
)
def test_what_cannot_be_meant_is_told(options: dict, sentence: str) -> None:
    given = {"values": [0.05], "dof": "m"} | options
    with pytest.raises(InputError, match=says(sentence)):
        track_resonance(oscillator, "force", start=WINDOW, method=METHOD, **given)
