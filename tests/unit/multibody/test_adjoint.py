"""Gradients of motions by the discrete adjoint, against those by direct sensitivities."""

from collections.abc import Callable

import numpy as np
import pytest
from inline_snapshot import snapshot

import dalembert.multibody as mb
from adjoint_differences import difference, points_alone
from dalembert.errors import InputError
from dalembert.forward import prefers_adjoint, pullback
from dalembert.multibody.adjoint.checkpoints import Checkpoints
from dalembert.multibody.adjoint.recorded_motion import stored_motion
from mechanisms import compiled_wind
from planar_scenes import SCENES, SHORT, SOLVER, loop, pinned, response, slack
from refusals import refused
from unknown_loads import BETWEEN, pushed, pushed_model


@pytest.mark.parametrize("kind", [kind for kind, (_, fields) in SCENES.items() if fields])
def test_the_gradient_by_the_numbers_of_every_component(kind: type) -> None:
    # The rod of the distance joint amplifies rounding: at lengths 3 % around, the difference is 3e-11 to 7e-10.
    limit = 2e-9 if kind is mb.DistanceJoint else 1e-10
    assert difference(points_alone(response(*SCENES[kind], SHORT if kind is mb.AncfBeam else SOLVER))) < limit


@pytest.mark.parametrize(
    ("build", "fields"),
    [(slack, {"x": 0.3, "angle": -0.4}), (loop, {"crank": 0.4, "base": 1.1, "turn": 0.7, "rate": 2.0})],
)
def test_the_gradient_by_what_the_initial_state_follows_from(build: Callable, fields: dict) -> None:
    assert difference(points_alone(response(build, fields, SHORT), times=BETWEEN)) < 1e-10


@pytest.mark.parametrize(
    "solver",
    [
        mb.GeneralizedAlpha(2e-3, spectral_radius=0.0),
        mb.GeneralizedAlpha(2e-3, initial_acceleration="zero"),
        mb.GeneralizedAlpha(3e-3),
        mb.GeneralizedAlpha(1e-3, adaptive=True, tolerance=1e-5),
    ],
    ids=str,
)
@pytest.mark.parametrize("kind", [mb.AncfCable, mb.Step])
def test_every_setting_of_the_solver(kind: type, solver: mb.GeneralizedAlpha) -> None:
    assert difference(points_alone(response(*SCENES[kind]), times=BETWEEN, solver=solver)) < 1e-10


@pytest.mark.parametrize("kind", ["spline", "linear", "cubic", "held"])
def test_the_gradient_by_the_values_of_a_history(kind: str) -> None:
    assert difference(pushed_model(kind, 20)) < 1e-10


def test_the_price_does_not_grow_with_the_coefficients_of_a_spline() -> None:
    builds = []

    def build(**values: complex) -> mb.System:
        builds.append(1)
        return pushed(kind="spline", **values)

    for count in (40, 160):
        box = {f"c{k}": (-9.0, 9.0) for k in range(count)}
        model = mb.TimeResponse(build, box, ["rope.end.y"], BETWEEN, mb.GeneralizedAlpha(2e-3))
        model.pullback(model.parameters.start)[1](np.ones((4, 1)))
        builds.clear()
        model.pullback(model.parameters.start + 0.1)[1](np.ones((4, 1)))
        assert len(builds) == 6  # the motion, four groups of coefficients, and their confirmation


@pytest.mark.parametrize("solver", [mb.GeneralizedAlpha(1e-3), mb.GeneralizedAlpha(1e-3, adaptive=True)], ids=str)
@pytest.mark.parametrize("kind", ["held", "step"])
def test_checkpoints_take_the_place_of_the_states_of_all_steps(
    kind: str, solver: mb.GeneralizedAlpha, monkeypatch: pytest.MonkeyPatch
) -> None:
    model = pushed_model("held", 20, solver=solver)
    if kind == "step":
        model = points_alone(response(*SCENES[mb.Step]), times=BETWEEN, solver=solver)
    vector, cotangent = model.parameters.start, np.ones((4, len(model.channels)))
    response_, pull = model.pullback(vector)
    monkeypatch.setattr("dalembert.multibody.adjoint.recorded_motion.ROOM", 1000)
    again, pull_again = model.pullback(vector)
    np.testing.assert_array_equal(again, response_)
    gradient = pull(cotangent)
    # states that are computed again differ by rounding, which index 3 magnifies in forces of joints
    np.testing.assert_allclose(pull_again(cotangent), gradient, rtol=0, atol=1e-9 * np.abs(gradient).max())


def test_checkpoints_are_as_many_as_the_root_of_the_steps(monkeypatch: pytest.MonkeyPatch) -> None:
    model = pushed_model("spline", 20)
    monkeypatch.setattr("dalembert.multibody.adjoint.recorded_motion.ROOM", 1000)
    lowered = model.lowered_at(model.parameters.start, 0.0, closed=True)
    kept = stored_motion(lowered, mb.GeneralizedAlpha(1e-3), model.problem, model.times)
    assert isinstance(kept.keeper, Checkpoints)
    assert len(kept.keeper.states) == 9  # of 80 steps
    (stretch,) = kept.stretches
    assert max(len(path.x) for _, path in kept.keeper.backwards(stretch)) == 9


def test_halved_steps_have_an_adjoint() -> None:
    model = points_alone(response(*SCENES[mb.AncfBeam], mb.GeneralizedAlpha(0.02, newton_tolerance=1e-18)))
    assert difference(model) < 1e-10
    lowered = model.lowered_at(model.parameters.start, 0.0, closed=True)
    assert isinstance(model.solver, mb.GeneralizedAlpha)
    steps = stored_motion(lowered, model.solver, model.problem, model.times).steps
    assert len(steps.ends) > 4, "no step was halved"


def test_a_gradient_may_be_asked_for_several_times() -> None:
    model = points_alone(response(*SCENES[mb.Spring]))
    response_, pull = model.pullback(model.parameters.start)
    np.testing.assert_array_equal(pull(response_), pull(response_))
    np.testing.assert_allclose(pull(3.0 * response_), 3.0 * pull(response_), rtol=1e-12)


def test_a_motion_that_starts_later() -> None:
    assert difference(pushed_model("linear", 20).later(0.02, [0.01, 0.04])) < 1e-10


def test_many_parameters_prefer_the_adjoint() -> None:
    model = pushed_model("spline", 20)
    assert prefers_adjoint(model)
    assert not prefers_adjoint(pushed_model("spline", 5))
    vector = model.parameters.start
    cotangent = np.ones((4, 3))
    by_default, direct = (pullback(model, vector, way)[1](cotangent) for way in ("auto", "direct"))
    np.testing.assert_array_equal(by_default, model.pullback(vector)[1](cotangent))
    assert not np.array_equal(by_default, direct)


def test_what_has_no_adjoint_is_differentiated_directly() -> None:
    model = pushed_model("spline", 20, solver=mb.RadauIIA())
    assert not prefers_adjoint(model)
    with refused(InputError, snapshot("RadauIIA has no adjoint. Use GeneralizedAlpha, or take derivative='direct'")):
        model.pullback(model.parameters.start)


def test_what_has_no_adjoint_is_refused() -> None:
    model = response(*SCENES[mb.Spring])
    with refused(
        InputError,
        snapshot(
            "the adjoint has no derivative of the channel 'system.total_energy', an energy of the whole system. Read channels of points and components, or take derivative='direct'"
        ),
    ):
        model.pullback(model.parameters.start)
    with refused(
        InputError,
        snapshot(
            "GeneralizedAlpha with spectral_radius = 1 projects velocities after each step, which has no adjoint. Take a radius below 1, or take derivative='direct'"
        ),
    ):
        projected = points_alone(
            response(pinned, {"viscous": 0.4}), solver=mb.GeneralizedAlpha(1e-3, spectral_radius=1.0)
        )
        projected.pullback(np.array([0.4]))
    by_differences = mb.TimeResponse(
        model.builder, model.parameters, ["arm.end.x"], BETWEEN, derivative="central-differences"
    )
    with refused(
        InputError,
        snapshot(
            "the adjoint needs a builder that runs in complex numbers, but derivative is 'central-differences'. Take derivative='complex-step' for the model"
        ),
    ):
        by_differences.pullback(model.parameters.start)


def test_functions_that_hold_parameters_are_refused() -> None:
    def build(mass: complex) -> mb.System:
        system = mb.System()
        bob = system.add(mb.PointMass("bob", mass, (0.0, 1.0)))
        system.add(mb.UserForce("wind", bob.centre, compiled_wind))
        return system

    model = mb.TimeResponse(build, {"mass": (1.0, 2.0)}, ["bob.centre.x"], BETWEEN)
    with refused(
        InputError,
        snapshot(
            "the adjoint has no derivative by parameters that a UserForce or a Custom function of time holds. Use a BSpline, a Table or another function of time, or take derivative='direct'"
        ),
    ):
        model.pullback(np.array([1.5]))


def test_a_builder_that_drops_imaginary_parts_is_refused() -> None:
    def build(**values: complex) -> mb.System:
        return pushed(kind="spline", **{name: np.real(value) + 0j for name, value in values.items()})

    model = mb.TimeResponse(build, {f"c{k}": (-9.0, 9.0) for k in range(20)}, ["rope.end.y"], BETWEEN)
    with pytest.raises(InputError, match="the derivative of a function of time by 'c0' is 0 by the complex step"):
        model.pullback(model.parameters.start)
