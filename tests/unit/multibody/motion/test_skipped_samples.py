"""Inputs whose samples are closer together than the steps."""

import numpy as np
import pytest

import dalembert.multibody as mb
from dalembert.data import Measurements
from dalembert.inverse import identify
from dalembert.multibody.motion.skipped_samples import late_samples, skipped_samples

TIMES = np.arange(2001) * 1e-3
SMOOTH = np.sin(9.0 * TIMES)
ROUGH = SMOOTH + 0.3 * np.random.default_rng(0).standard_normal(len(TIMES))


def driven(values: np.ndarray, kind: str = "linear", **more) -> mb.System:
    system = mb.System()
    bar = system.add(mb.RigidBar("bar", 0.5, 0.4))
    system.add(mb.RevoluteJoint("pin", system.ground, bar.start, **more))
    system.add(mb.Torque("motor", bar.start, mb.Table(TIMES, values, kind, delay=0.01)))
    return system


def codes(findings) -> list[str]:
    return [one.code for one in findings]


@pytest.mark.parametrize("more", [{}, {"coulomb": 0.01, "slip_rate": 1.0}], ids=["free", "rubbing"])
def test_steps_that_miss_a_part_of_an_input_are_a_warning(more: dict) -> None:
    solver = mb.GeneralizedAlpha(step=4e-3)
    (found,) = mb.simulate(driven(ROUGH, **more), 1.5, solver).findings
    assert (found.code, found.severity) == ("skipped-samples", "warning")
    assert found.values["lost"] == pytest.approx(0.45, abs=0.1)  # most of the noise, of 0.3 beside a sine of 0.7
    assert str(found).startswith("Steps of 0.004 s miss 4")
    assert "of the variation of the input 'torque' of 'motor', whose samples are 0.001 s apart." in found.message
    assert found.advice == "Use steps of 0.001 s, or a low-pass filter for the input."
    model = mb.TimeResponse(lambda x: driven(ROUGH, **more), {"x": (0, 1)}, ["bar.end.x"], [1.5], solver)
    assert model.findings(np.zeros(1)) == (found,)


@pytest.mark.parametrize(
    ("system", "solver"),
    [
        (driven(ROUGH), mb.GeneralizedAlpha(step=1e-3)),
        (driven(SMOOTH), mb.GeneralizedAlpha(step=4e-3)),
        (driven(ROUGH, "held"), mb.GeneralizedAlpha(step=4e-3)),
        (driven(np.ones(2001)), mb.GeneralizedAlpha(step=4e-3)),
    ],
    ids=["fine steps", "smooth", "held", "constant"],
)
def test_other_inputs_are_none(system: mb.System, solver: mb.Integrator) -> None:
    assert mb.simulate(system, 0.5, solver).findings == ()


def test_a_solver_that_chooses_its_steps_skips_none() -> None:
    assert skipped_samples(driven(ROUGH), mb.RadauIIA().fixed_step, 0.0, 1.0) == ()


def test_the_part_of_the_input_counts_that_the_motion_reads() -> None:
    late = np.where(TIMES < 1.0, SMOOTH, ROUGH)
    assert codes(skipped_samples(driven(late), 4e-3, 0.0, 0.9)) == []
    assert codes(skipped_samples(driven(late), 4e-3, 1.1, 0.8)) == ["skipped-samples"]


@pytest.mark.parametrize(("begin", "late"), [(0.0, False), (0.2, False), (0.3, True), (48.0, True)])
def test_samples_that_begin_long_after_the_motion_are_a_note(begin, late):
    found = late_samples(begin + np.linspace(0.0, 1.0, 11))
    assert codes(found) == (["late-samples"] if late else [])
    assert all(item.severity == "note" for item in found)


def test_a_fit_of_a_late_record_says_so():
    def pendulum(length):
        system = mb.System()
        bar = system.add(mb.RigidBar("bar", length=length, mass=1.0, angle=-1.0))
        system.add(mb.RevoluteJoint("pin", system.ground, bar.start))
        return system

    times = 5.0 + np.linspace(0.0, 0.5, 11)
    model = mb.TimeResponse(pendulum, {"length": (0.5, 1.5)}, ["bar.end.x"], times, mb.RungeKutta4(step=5e-3))
    fit = identify(model, Measurements.of(times, {"bar.end.x": model.evaluate([[1.0]]).values[0, :, 0]}), starts=1)
    assert "late-samples" in codes(fit.findings)
