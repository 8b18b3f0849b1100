"""Integrators compared on one motion: the pendulum, whose errors fall with the step as the method's order says."""

from inspect import unwrap

import numpy as np
import pytest

from dalembert.errors import InputError
from dalembert.forward import Checkpoint
from dalembert.multibody import GeneralizedAlpha, RevoluteJoint, RigidBar, System, WorkPrecision, work_precision
from support import says

FINE = (GeneralizedAlpha(step=1e-4), GeneralizedAlpha(step=2e-4))
COARSE = {"generalized-alpha": [GeneralizedAlpha(step=step) for step in (0.02, 0.01)]}


def pendulum() -> System:
    system = System(gravity=(0.0, -9.81))
    bar = system.add(RigidBar("bar", length=1.0, mass=1.0, angle=-0.5))
    system.add(RevoluteJoint("pin", system.ground, bar.start))
    return system


@pytest.fixture(scope="module")
def found() -> WorkPrecision:
    stiff = {"too long": [GeneralizedAlpha(step=1e-3, adaptive=True, tolerance=1e-9, most_steps=3)]}
    return work_precision(pendulum(), 1.0, ["bar.end.x"], COARSE | stiff, reference=FINE, samples=11, repeats=1)


def test_errors_are_of_second_order(found: WorkPrecision) -> None:
    coarse, fine, _ = found.rows
    assert coarse.error / fine.error == pytest.approx(4.0, rel=0.05)
    assert (coarse.steps, fine.steps) == (50, 100)
    assert 0 < found.apart < 0.01 * fine.error


def test_each_run_has_its_diagnostics(found: WorkPrecision) -> None:
    for row in found.rows[:2]:
        assert row.seconds > 0
        assert row.position < 1e-3
        assert row.energy == pytest.approx(0.0, abs=0.01)
        assert row.settings == f"GeneralizedAlpha(step={0.02 if row.steps == 50 else 0.01})"


def test_a_run_that_ends_early_has_its_reason_and_no_numbers(found: WorkPrecision) -> None:
    early = found.rows[2]
    assert early.failure.startswith("the adaptive step reached most_steps = 3 at t = ")
    assert np.isnan([early.error, early.seconds]).all()
    assert "1 of 3 runs ended early; the table has the reasons." in found.status
    assert early.failure in found.summary()


def test_the_fastest_run_for_an_error_is_named(found: WorkPrecision) -> None:
    assert found.fastest(1.0) in found.rows[:2]
    assert found.fastest(0.9 * found.rows[0].error) is found.rows[1]
    assert found.fastest(1e-12) is None


def test_it_is_read_again_as_it_was_written(found: WorkPrecision, tmp_path) -> None:
    found.save(tmp_path / "found.nc")
    again = WorkPrecision.load(tmp_path / "found.nc")
    assert again.rows[:2] == found.rows[:2]
    assert again.summary() == found.summary()


def test_the_figure_has_a_line_an_integrator_and_leaves_out_what_ended_early(found: WorkPrecision) -> None:
    lines = found.figures()["work-precision"].data
    assert [(line.name, len(line.x)) for line in lines] == [("generalized-alpha", 2), ("too long", 0)]


def test_a_comparison_that_was_interrupted_goes_on_with_what_is_missing(tmp_path, monkeypatch) -> None:
    stiff = {"too long": [GeneralizedAlpha(step=1e-3, adaptive=True, tolerance=1e-9, most_steps=3)]}
    ran, told, simulate = [], [], unwrap(work_precision).__globals__["simulate"]

    def compare(stop: bool) -> WorkPrecision:
        def on_row(row) -> None:
            told.append(row)
            if stop and len(told) == 2:
                raise KeyboardInterrupt

        told.clear()
        with Checkpoint(tmp_path / "checkpoint") as checkpoint:
            options = {"reference": FINE, "samples": 11, "repeats": 2, "checkpoint": checkpoint, "on_row": on_row}
            return work_precision(pendulum(), 1.0, ["bar.end.x"], COARSE | stiff, **options)

    def simulated(system, end, solver, times):
        ran.append(str(solver))
        return simulate(system, end, solver, times)

    monkeypatch.setitem(unwrap(work_precision).__globals__, "simulate", simulated)
    with pytest.raises(KeyboardInterrupt):
        compare(stop=True)
    before = tuple(told)
    resumed, again = compare(stop=False), compare(stop=False)
    assert len(ran) == len(set(ran)) == 5  # two references, three rows
    assert resumed.rows[:2] == before  # with the times that were measured
    assert again.to_xarray().identical(resumed.to_xarray())
    assert resumed.rows[2].failure


def test_one_reference_is_not_enough() -> None:
    sentence = (
        "work_precision: 1 reference was given; expected two, the second of which says how well the first is known"
    )
    with pytest.raises(InputError, match=says(sentence)):
        work_precision(pendulum(), 1.0, ["bar.end.x"], COARSE, reference=FINE[:1])


def test_nothing_to_compare() -> None:
    sentence = "work_precision: no integrators were given; expected at least one series of them"
    with pytest.raises(InputError, match=says(sentence)):
        work_precision(pendulum(), 1.0, ["bar.end.x"], {}, reference=FINE)
