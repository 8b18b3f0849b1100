"""Findings on beams that stretch so much that Green's strain matters: closed forms of a pulled bar."""

import numpy as np
import pytest

import dalembert as da

MODULUS, DENSITY = 1e6, 1000.0


def pulled(strain: float = 0.03, kind: type = da.AncfBeam, height: float = 0.01, **other) -> da.System:
    """A bar at rest under a force that stretches it by a strain, by Hooke's law."""
    system = da.System(gravity=(0.0, 0.0), start="equilibrium")
    law = {"poisson_ratio": 0.3, **other} if kind is da.AncfBeam else other
    bar = system.add(kind("bar", 1.0, 2, MODULUS, density=DENSITY, height=height, width=0.01, **law))
    system.add(da.FixedJoint("wall", system.ground, bar.start))
    system.add(da.Force("pull", bar.end, x=strain * MODULUS * height * 0.01))
    return system


def findings(system: da.System) -> tuple:
    return da.simulate(system, 1e-3).findings


@pytest.mark.parametrize("other", [{}, {"law": "uncoupled"}])
def test_the_strain_and_the_error_of_the_force_are_those_of_the_cubic(other: dict) -> None:
    (found,) = (item for item in findings(pulled(**other)) if item.code == "beam-strain")
    strain = found.values["strain"]
    assert (found.severity, found.values["body"], found.values["time"]) == ("note", "bar", 0.0)
    assert strain + 1.5 * strain**2 + 0.5 * strain**3 == pytest.approx(0.03, rel=1e-9)
    assert found.values["force_error"] == pytest.approx(0.03 / strain - 1, rel=1e-6)


def test_the_structural_and_the_continuum_formulation_are_named_alike() -> None:
    both = (findings(pulled(formulation=own)) for own in ("structural", "continuum"))
    first, second = ([item.values["strain"] for item in own if item.code == "beam-strain"] for own in both)
    assert first == pytest.approx(second, rel=1e-9)


@pytest.mark.parametrize(("strain", "severity"), [(0.006, None), (0.01, "note"), (0.05, "warning"), (-0.03, "note")])
def test_severity_follows_the_error_of_the_force(strain: float, severity: str | None) -> None:
    found = [item.severity for item in findings(pulled(strain, height=0.5)) if item.code == "beam-strain"]
    assert found == ([severity] if severity else [])


def test_a_cable_has_the_law_of_hooke() -> None:
    system = pulled(kind=da.AncfCable)
    assert da.simulate(system, 1e-3).channels(["bar.end.x"])[0, 0] == pytest.approx(1.03, rel=1e-9)
    assert findings(system) == ()


def test_a_beam_that_only_bends_is_not_named() -> None:
    system = da.System(gravity=(0.0, 0.0), start="equilibrium")
    bar = system.add(da.AncfBeam("bar", 1.0, 4, 1e7, poisson_ratio=0.3, density=DENSITY, height=0.01, width=0.01))
    system.add(da.FixedJoint("wall", system.ground, bar.start))
    system.add(da.Torque("moment", bar.end, 1e7 * 0.01**4 / 12 * np.pi / 2))  # bends it by a quarter turn
    assert findings(system) == ()


def test_a_model_of_measurements_has_the_finding() -> None:
    model = da.TimeResponse(pulled, {"strain": (0.001, 0.1)}, ["bar.end.x"], np.array([0.0, 1e-3]))
    assert [item.code for item in model.findings(np.array([0.05]))] == ["beam-strain"]
    assert model.findings(np.array([0.002])) == ()
