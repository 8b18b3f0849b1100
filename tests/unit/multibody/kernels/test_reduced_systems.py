"""Coordinates with internal constraints: the reduced system of generalized-alpha against the full one."""

from dataclasses import replace

import numpy as np
import pytest

import dalembert.multibody as mb
from dalembert.errors import ModelError
from dalembert.multibody.model.evaluate import residual
from dalembert.multibody.model.lowering import lower
from nodal_kinds import BOB, CIRCLE, TIE, Bob, Rod, Tie, top
from slopes import errors

LENGTH = 1.3


def swing(stiffness: float = 30.0, drag: float = 0.2, full: bool = False, joint: bool = False) -> mb.System:
    """A bob on a circle, and a mass that hangs on it by a spring or by a rod."""
    system = mb.System()
    bob = system.add(Bob("bob", 2.0, (LENGTH * np.cos(0.4), -LENGTH * np.sin(0.4)), LENGTH, drag, full))
    mass = system.add(mb.PointMass("mass", 1.0, (2.0, -0.5), (0.0, 0.0) if joint else (0.3, 0.0)))
    hanger = (
        Rod("hanger", bob.centre, mass.centre, full)
        if joint
        else Tie("hanger", bob.centre, mass.centre, stiffness, full)
    )
    system.add(hanger)
    return system


def planar(joint: bool) -> mb.System:
    """The same of components of the package."""
    system = mb.System()
    bob = system.add(mb.PointMass("bob", 2.0, (LENGTH * np.cos(0.4), -LENGTH * np.sin(0.4))))
    mass = system.add(mb.PointMass("mass", 1.0, (2.0, -0.5), (0.0, 0.0) if joint else (0.3, 0.0)))
    system.add(mb.DistanceJoint("rod", system.ground.point(0.0, 0.0), bob.centre))
    if joint:
        system.add(mb.DistanceJoint("hanger", bob.centre, mass.centre))
    else:
        system.add(mb.Spring("hanger", bob.centre, mass.centre, 30.0, free_length=0.0))
    return system


def run(system: mb.System, end: float = 1.0, **settings) -> mb.Trajectory:
    return mb.simulate(system, end, mb.GeneralizedAlpha(**{"step": 1e-3, **settings}))


EXACT = {"newton_tolerance": 1e-17}  # rounding


@pytest.mark.parametrize("spectral_radius", [0.3, 0.8, 1.0])
@pytest.mark.parametrize("joint", [False, True])
def test_it_gives_the_motion_of_the_full_system(joint: bool, spectral_radius: float) -> None:
    settings = {"spectral_radius": spectral_radius, **EXACT}
    reduced, full = (run(swing(drag=0.0, full=full, joint=joint), **settings) for full in (False, True))
    usual = run(planar(joint), **settings)
    for other in (full, usual):
        np.testing.assert_allclose(reduced.states.x[:, :4], other.states.x[:, :4], rtol=0, atol=3e-12)
        np.testing.assert_allclose(reduced.states.v[:, :4], other.states.v[:, :4], rtol=0, atol=1e-10)
    if joint:  # the force of the rod
        np.testing.assert_allclose(reduced.states.x[:, 5], full.states.x[:, 5], rtol=1e-7)
    assert np.ptp(reduced.states.x[:, :4], axis=0).min() > 0.2


def test_rows_are_increments_then_multipliers_of_joints() -> None:
    structure = lower(swing(joint=True)).structure
    own = structure.reduction
    assert (structure.n, structure.size, own.increments, own.size) == (4, 6, 3, 4)
    np.testing.assert_array_equal(own.rows, [4, 4, 0, 1, 4, 3, 4])
    assert CIRCLE not in own.index
    assert structure.reduced.kept[1].size == 4


def test_a_planar_model_has_one_system() -> None:
    lowered = lower(planar(True))
    assert lowered.structure.reduced is lowered.structure.full
    head, full, reduced, _ = lowered.real.reduced()._words
    assert reduced is full
    assert head["reduced"] == head["blocks"]
    np.testing.assert_array_equal(full["index"], full["rows"])
    assert lowered.structure.reduced_kernels(True) == []


def test_internal_constraints_hold_to_rounding() -> None:
    trajectory = run(swing(), end=5.0, step=5e-3)
    radius = np.hypot(*trajectory.states.x[:, :2].T)
    assert len(radius) == 1001
    assert np.abs(radius / LENGTH - 1.0).max() < 1e-15


@pytest.mark.parametrize("step", [0.05, 1e-3])
@pytest.mark.parametrize("joint", [False, True])
def test_it_takes_no_more_iterations_and_matrices_than_the_full_system(joint: bool, step: float) -> None:
    reduced, full = (run(swing(full=full, joint=joint), step=step).run.counts for full in (False, True))
    assert reduced[1] <= 1.02 * full[1]
    assert reduced[2] <= full[2] + 1
    assert reduced[3] == 0


def test_the_reduced_tangent_is_the_slope_of_the_projected_residual() -> None:
    """Along finite increments, so with the change of the projection; by differences of both kernels."""
    lowered = lower(swing(joint=True))
    model, own = lowered.tangents.reduced(), lowered.structure.reduction
    chance = np.random.default_rng(3)
    x, v, a = chance.normal(size=(3, len(lowered.x)))
    x[-1] = v[-1] = a[-1] = 0.0
    x[:2] *= LENGTH / np.hypot(*x[:2])
    slots, rows, columns = lowered.structure.reduced.separate
    by, matrix = (0.7, 1.3, 0.4), np.zeros(len(rows))
    call = model.call().set(x=x, v=v, a=a, matrix=matrix, entries=len(matrix), motion=1.0, constraint=2.0)
    call.set(by_x=by[0], by_v=by[1], by_a=by[2], increments=own.increments, last_row=own.size)
    for k, kind in enumerate(own.index):
        call.set(slots=slots[k])
        kind.kernel("tangent", model.dtype)(call.address, model._words[2][k : k + 1].ctypes.data)
    dense = np.zeros((own.size + 1, own.size + 1))
    np.add.at(dense, (rows, columns), matrix)

    def projected(column: int, h: float) -> np.ndarray:
        dx, dv, da = np.zeros((3, len(x)))
        if column == 2:
            angle = h * by[0]
            dx[:2] = (np.cos(angle) - 1) * x[:2] + np.sin(angle) * np.array([-x[1], x[0]])
            dv[:2], da[:2] = by[1] / by[0] * dx[:2], by[2] / by[0] * dx[:2]
        elif column < 2:
            dx[2 + column], dv[2 + column], da[2 + column] = h * np.array(by)
        else:
            dx[5] = h
        moved = x + dx
        unloaded = moved.copy()
        unloaded[4] = 0.0  # of the circle
        r = residual(lowered, lowered.real, unloaded, v + dv, a + da)
        return np.array([r[2], r[3], -moved[1] * r[0] + moved[0] * r[1], 2.0 * r[5]])

    h = 1e-3
    for column in range(own.size):
        near, far = ((projected(column, k * h) - projected(column, -k * h)) / (2 * k * h) for k in (1, 2))
        np.testing.assert_allclose(dense[:-1, column], (4 * near - far) / 3, rtol=0, atol=1e-8)


@pytest.mark.parametrize("spectral_radius", [0.8, 1.0])
@pytest.mark.parametrize("joint", [False, True])
def test_its_sensitivities_are_exact(joint: bool, spectral_radius: float) -> None:
    def model(full: bool) -> mb.TimeResponse:
        solver = mb.GeneralizedAlpha(step=2e-3, spectral_radius=spectral_radius)
        return mb.TimeResponse(
            lambda stiffness, drag: swing(stiffness, drag, full, joint),
            {"stiffness": (20.0, 40.0), "drag": (0.1, 0.3)}, ["bob.centre.x", "bob.centre.vy", "mass.centre.x"],
            np.linspace(0.0, 0.5, 11), solver,
        )  # fmt: skip

    values, jacobian = model(False).linearise(model(False).parameters.start)
    expected, slopes = model(True).linearise(model(True).parameters.start)
    np.testing.assert_allclose(values, expected, rtol=0, atol=1e-9)
    np.testing.assert_allclose(jacobian, slopes, rtol=0, atol=1e-9)
    error, _ = errors(model(False))
    assert max(error.values()) < 1e-7


def test_the_circle_may_depend_on_a_parameter() -> None:
    def built(radius: float) -> mb.System:
        system = mb.System()
        system.add(Bob("bob", 2.0, (radius * 0.6, -radius * 0.8), radius))
        return system

    times = np.linspace(0.0, 0.5, 11)
    channels = ["bob.centre.x", "bob.centre.y"]
    model = mb.TimeResponse(built, {"radius": (1.0, 2.0)}, channels, times, mb.GeneralizedAlpha(step=2e-3))
    error, _ = errors(model)
    assert max(error.values()) < 1e-8


def test_its_kernels_do_what_their_python_does() -> None:
    compiled = run(swing(joint=True), 0.01)
    with mb.in_python(Rod, BOB, CIRCLE):
        plain = run(swing(joint=True), 0.01)
    np.testing.assert_allclose(plain.states.x, compiled.states.x, rtol=1e-12, atol=1e-14)


@pytest.mark.parametrize(
    "solver", [mb.RadauIIA(step=1e-2), mb.Variational(step=2e-3)], ids=lambda own: type(own).__name__
)
def test_other_integrators_solve_the_full_system(solver: mb.Integrator) -> None:
    reduced, full = (mb.simulate(swing(full=full), 1.0, solver) for full in (False, True))
    np.testing.assert_array_equal(reduced.states.x, full.states.x)


def test_a_kind_must_declare_the_charts_of_its_coordinates() -> None:
    system = mb.System()
    bob = system.add(Bob("bob", 2.0, (LENGTH, 0.0), LENGTH))
    system.add(mb.Spring("spring", system.ground, bob.centre, 10.0))
    with pytest.raises(ModelError, match=r"does not declare their charts\. Add them to its 'charts'") as caught:
        lower(system).structure.reduction  # noqa: B018
    assert "'spring'" in str(caught.value)


def test_charts_must_cover_the_coordinates_of_a_kind() -> None:
    with pytest.raises(ModelError, match=r"its charts have 2 \+ 2 coordinates, the kind has 5"):
        replace(TIE, coordinates=5)


REFERENCE = np.array([0.60555056, 0.59895768, -0.52398303])


def test_the_heavy_top_is_at_its_reference() -> None:
    """Of second order, and the motion of the full system; six unknowns and three multipliers instead of 21."""
    runs = {step: run(top(), 0.2, step=step, spectral_radius=0.9, **EXACT) for step in (2e-4, 1e-4)}
    full = run(top(full=True), 0.2, step=2e-4, spectral_radius=0.9, **EXACT)
    np.testing.assert_allclose(runs[2e-4].states.x[:, :12], full.states.x[:, :12], rtol=0, atol=1e-11)
    assert runs[2e-4].run.counts[1] < full.run.counts[1]
    for trajectory in runs.values():
        directors = trajectory.states.x[:, 3:12].reshape(-1, 3, 3)
        products = directors @ directors.transpose(0, 2, 1)
        np.testing.assert_allclose(products, np.broadcast_to(np.eye(3), products.shape), rtol=0, atol=1e-15)
    coarse, fine = (trajectory.states.x[-1, :3] for trajectory in runs.values())
    assert 3.9 < np.linalg.norm(coarse - REFERENCE) / np.linalg.norm(fine - REFERENCE) < 4.1
    np.testing.assert_allclose((4 * fine - coarse) / 3, REFERENCE, rtol=0, atol=2e-8)
    structure = lower(top()).structure
    assert (structure.size, structure.reduction.size) == (21, 9)


def test_sensitivities_of_the_heavy_top_are_those_of_the_full_system() -> None:
    def model(full: bool) -> mb.TimeResponse:
        return mb.TimeResponse(
            lambda mass, spin: top(mass, spin, full), {"mass": (14.0, 16.0), "spin": (140.0, 160.0)},
            ["top.centre.x", "top.centre.y"], np.linspace(0.0, 0.1, 6), mb.GeneralizedAlpha(step=5e-4),
        )  # fmt: skip

    at = np.array([15.0, 150.0])
    own, other = model(False).jacobian(at), model(True).jacobian(at)
    np.testing.assert_allclose(own, other, rtol=0, atol=1e-8 * np.abs(other).max())
    h = np.array([[1e-3, 0.0], [-1e-3, 0.0], [0.0, 1e-3], [0.0, -1e-3]])
    moved = model(False).evaluate(at + h).only()
    slopes = np.stack([(moved[0] - moved[1]) / 2e-3, (moved[2] - moved[3]) / 2e-3], axis=-1)
    np.testing.assert_allclose(own, slopes, rtol=0, atol=1e-5 * np.abs(slopes).max())
