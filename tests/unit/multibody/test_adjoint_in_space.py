"""Gradients of motions in space by the discrete adjoint, against those by direct sensitivities."""

import numpy as np
import pytest
from inline_snapshot import snapshot

import dalembert.multibody as mb
from adjoint_differences import difference
from dalembert.errors import InputError
from dalembert.forward import prefers_adjoint
from nodal_kinds import top
from refusals import refused
from spatial_scenes import SCENES, fields_of, parameters_of

TIMES = np.array([0.0, 0.02, 0.043, 0.08])
SHORT = mb.GeneralizedAlpha(2.5e-3, newton_tolerance=1e-18)
QUICK = ("rigid body", "beam", "revolute", "prescribed angle", "gear")


def response(scene: str, solver: mb.GeneralizedAlpha = SHORT) -> mb.TimeResponse:
    """A scene as a function of all of its numbers."""
    build, fields = SCENES[scene]
    parameters = parameters_of(fields)
    system = build(**fields)
    names = [
        f"{body.name}.{body.point_names[-1]}.{entry}"
        for body in system.bodies
        for entry in ("x", "vy", "az", *(("wx", "rotation_z", "q1") if body.has_axes else ()))
    ]
    names += [f"{joint.name}.force_x" for joint in system.joints if "force_x" in dict(joint.kind.outputs)]
    return mb.TimeResponse(lambda **numbers: build(**fields_of(fields, numbers)), parameters, names, TIMES, solver)


@pytest.mark.parametrize(
    "scene",
    [
        scene if scene in QUICK else pytest.param(scene, marks=pytest.mark.slow)
        for scene, (_, fields) in SCENES.items()
        if fields
    ],
)
def test_the_gradient_by_the_numbers_of_every_component(scene: str) -> None:
    # index 3 magnifies rounding in forces of joints, as those of a screw of short lead
    assert difference(response(scene)) < 5e-9


@pytest.mark.parametrize(
    "solver",
    [
        mb.GeneralizedAlpha(2e-3, spectral_radius=0.0),
        mb.GeneralizedAlpha(2e-3, initial_acceleration="zero"),
        mb.GeneralizedAlpha(3e-3, adaptive=True, tolerance=1e-5),
    ],
    ids=str,
)
def test_every_setting_of_the_solver(solver: mb.GeneralizedAlpha) -> None:
    assert difference(response("revolute", solver)) < 1e-9


def test_checkpoints_take_the_place_of_the_states_of_all_steps(monkeypatch: pytest.MonkeyPatch) -> None:
    model = response("rigid body")
    vector, cotangent = model.parameters.start, np.ones((len(TIMES), len(model.channels)))
    response_, pull = model.pullback(vector)
    monkeypatch.setattr("dalembert.multibody.adjoint.recorded_motion.ROOM", 1000)
    again, pull_again = model.pullback(vector)
    np.testing.assert_array_equal(again, response_)
    gradient = pull(cotangent)
    np.testing.assert_allclose(pull_again(cotangent), gradient, rtol=0, atol=1e-9 * np.abs(gradient).max())


def test_a_chart_without_balance_is_refused() -> None:
    model = mb.TimeResponse(top, {"mass": (10.0, 20.0)}, ["top.centre.x"], TIMES)
    with refused(
        InputError,
        snapshot(
            "the chart of kind 'directors' has no function 'balance', which the adjoint needs. Add it, or take derivative='direct'"
        ),
    ):
        model.pullback(np.array([15.0]))


def test_many_parameters_prefer_the_adjoint() -> None:
    assert prefers_adjoint(response("beam", mb.GeneralizedAlpha(1e-3)))
    assert not prefers_adjoint(response("gear", mb.GeneralizedAlpha(1e-3)))
