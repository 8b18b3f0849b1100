"""Findings on elements that do not suit a bar: what they state against what the elements compute."""

import numpy as np
import pytest

import dalembert as da

BEND = np.deg2rad(10.0)


def beam(length: float, elements: int, height: float, formulation: str = "continuum", **other) -> da.AncfBeam:
    section = {"poisson_ratio": 0.3, "density": 1.0, "height": height, "width": 1.0, "formulation": formulation}
    return da.AncfBeam("bar", length, elements, 12 / height**3, **section | other)


def tip(bar: da.AncfBeam) -> float:
    """Deflection under a small weight."""
    system = da.System(gravity=(0.0, -1e-6))
    system.add(bar)
    system.add(da.FixedJoint("clamp", system.ground, bar.start))
    return -np.ravel(da.equilibrium(system).channels(["bar.end.y"]))[0]


def turned(bar: da.AncfBeam, moment: float) -> float:
    """Angle of the end under a moment."""
    system = da.System(gravity=(0.0, 0.0))
    system.add(bar)
    system.add(da.FixedJoint("clamp", system.ground, bar.start))
    system.add(da.Torque("moment", bar.end, moment))
    return np.ravel(da.equilibrium(system).channels(["bar.end.angle"]))[0]


@pytest.mark.parametrize("law", ["plane-stress", "plane-strain", "uncoupled"])
@pytest.mark.parametrize("elements", [1, 4])
def test_the_stated_error_of_a_straight_beam_is_that_of_its_deflection(law: str, elements: int) -> None:
    bars = (beam(1.0, elements, 0.01, form, law=law) for form in ("structural", "continuum"))
    right, published = map(tip, bars)
    (finding,) = beam(1.0, elements, 0.01, law=law).findings
    assert right / published - 1 == pytest.approx(finding.values["straight"], rel=2e-3)


@pytest.mark.parametrize(("elements", "height"), [(2, 0.05), (4, 0.01), (8, 3e-3)])
def test_the_stated_locking_is_that_of_a_bent_beam(elements: int, height: float) -> None:
    bar = beam(1.0, elements, height, poisson_ratio=0.0)
    (finding,) = bar.findings
    low, high = (turned(bar, BEND * part) for part in (0.99, 1.01))
    stiffness = 0.02 * BEND / (high - low)  # E I / L is 1
    assert finding.values["locking"] > 0.03
    assert stiffness - 1 == pytest.approx(finding.values["locking"], rel=0.2)


@pytest.mark.parametrize("slenderness", [5.0, 10.0])
def test_the_stated_error_of_a_thick_cable_is_that_of_its_frequency(slenderness: float) -> None:
    section = {"density": 1.0, "height": 1 / slenderness, "width": 1.0}
    bars = da.AncfCable("bar", 1.0, 8, 1e3, **section), da.AncfBeam("bar", 1.0, 8, 1e3, poisson_ratio=0.3, **section)
    found = []
    for bar in bars:
        system = da.System(gravity=(0.0, 0.0))
        system.add(bar)
        system.add(da.RevoluteJoint("left", system.ground, bar.start))
        system.add(da.RevoluteJoint("right", system.ground, bar.end))
        found.append(da.modes(system).frequencies[0])
    (finding,) = bars[0].findings
    assert found[0] / found[1] - 1 == pytest.approx(finding.values["frequency_error"], rel=0.1)


def test_messages_and_severities() -> None:
    (strip,) = beam(0.52, 8, 1e-3).findings
    assert (strip.code, strip.severity) == ("beam-locking", "warning")
    assert str(strip) == (
        "Beam 'bar' has the continuum formulation. Its bending stiffness is about 10 % too high while it is straight. "
        "Its thin elements lock: after a bend of 10 degrees the stiffness is 30 % too high. "
        'Use formulation "structural", unless you repeat published results.'
    )
    (thick,) = beam(2.0, 4, 0.4).findings
    assert thick.severity == "note"
    assert "lock" not in thick.message
    (rope,) = da.AncfCable("rope", 1.0, 4, 1e7, density=1.0, height=0.2, width=0.2).findings
    assert (rope.code, rope.severity) == ("cable-shear", "warning")
    assert str(rope) == (
        "Cable 'rope' is thick: its length is 5 times its height. It has no shear, and its first bending frequency "
        "between pins is about 6.5 % too high. Use AncfBeam."
    )


def test_elements_that_suit_have_no_findings() -> None:
    assert beam(1.0, 1, 0.5, "structural").findings == beam(1.0, 1, 1e-3, "structural").findings == ()
    assert da.AncfCable("rope", 1.0, 4, 1e7, density=1.0, height=0.05, width=0.2).findings == ()


def thick_rope(density: float) -> da.System:
    system = da.System()
    rope = system.add(da.AncfCable("rope", 1.0, 2, 1e6, density=density, height=0.2, width=0.2))
    system.add(da.RevoluteJoint("pin", system.ground, rope.start))
    return system


def test_results_have_the_findings_of_their_mechanism() -> None:
    trajectory = da.simulate(thick_rope(900.0), 0.1)
    (finding,) = trajectory.findings
    assert str(finding) in trajectory.summary()
    times = np.linspace(0.0, 0.1, 5)
    model = da.TimeResponse(thick_rope, {"density": (500.0, 1500.0)}, ["rope.end.y"], times)
    data = da.Measurements.of(times, {"rope.end.y": model.evaluate(np.array([[900.0]])).only()[0][:, 0]})
    fit = da.identify(model, data, starts=1, seed=0)
    assert finding in fit.findings
    assert finding in fit.doubts
    bands = da.propagate(model, {"density": (800.0, 1000.0)}, "vertex")
    assert finding in bands.findings
