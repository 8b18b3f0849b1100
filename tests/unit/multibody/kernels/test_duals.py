"""Dual numbers in kernels: against complex steps along each of eight directions."""

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

import dalembert as da
import dalembert.multibody as mb
import planar_scenes
import spatial_scenes
from dalembert.kernels.duals import DIRECTIONS, Dual, as_duals
from dalembert.multibody.integrators.shared.convergence import has_settled
from dalembert.multibody.integrators.shared.integrator import Integrator
from dalembert.multibody.kernels.block_table import BlockModel
from dalembert.multibody.kernels.elementary import STEP
from dalembert.multibody.kernels.kind import Kind
from dalembert.multibody.kernels.slopes import share_of
from dalembert.multibody.model import directions
from dalembert.multibody.model.directions import dual_models
from dalembert.multibody.model.lowered import Lowered
from kind_scenes import HOMES
from spatial_scenes import SCENES

TIME = 0.3


#: Kinds whose kernels other tests need, too; the others are compiled for this test alone.
COMMON = ("structural_beam", "ancf_cable", "rigid_body_in_space", "revolute", "revolute_in_space", "friction_in_space")
ROLES = [
    pytest.param(kind, role, marks=() if kind.name in COMMON else pytest.mark.slow)
    for kind in HOMES
    for role in ("residual", "rates")
    if kind.has(role) and not HOMES[kind]().callbacks
]


def perturbed(lowered: Lowered, seed: int) -> Lowered:
    """Numbers with a random imaginary step."""
    chance = np.random.default_rng(seed)

    def moved(array: np.ndarray) -> np.ndarray:
        return array + 1j * STEP * chance.normal(size=array.shape)

    data = {kind: moved(array) for kind, array in lowered.data.items()}
    signals = moved(lowered.signal_data)
    signals[0] = signals[0].real  # the time at which the motion starts
    return replace(lowered, data=data, signal_data=signals)


def answers(model: BlockModel, kind: Kind, role: str, state: np.ndarray) -> np.ndarray:
    """What the kernel of a role writes, for a state (3, N + 1)."""
    model.need(role)
    row = list(model.blocks.index).index(kind)
    length = max(model.size + 1, len(model.blocks.index[kind]) * max(len(kind.outputs), 1))
    out = np.zeros((4, length, *state.shape[2:]), state.dtype)
    fields = dict(zip(("r", "rate", "second", "totals"), out, strict=True))
    call = model.call().set(**dict(zip("xva", map(np.ascontiguousarray, state), strict=True)), **fields)
    model.evaluate(call, TIME, TIME)
    kind.kernel(role, model.dtype)(call.address, model.block(row))
    return out


@pytest.mark.parametrize(("kind", "role"), ROLES, ids=lambda entry: getattr(entry, "name", entry))
def test_eight_slopes_are_those_of_complex_steps(kind: Kind, role: str) -> None:
    lowered = HOMES[kind]()
    chance = np.random.default_rng(1)
    moved = [perturbed(lowered, seed) for seed in range(DIRECTIONS)]
    value = chance.normal(size=(3, lowered.structure.size + 1))
    slopes = chance.normal(size=(DIRECTIONS, *value.shape))
    value[:, -1], slopes[..., -1] = 0.0, 0.0
    (model,) = dual_models(lowered, moved)
    assert model.dtype is Dual
    result = answers(model, kind, role, as_duals(value, slopes))
    real = answers(lowered.real, kind, role, value)
    size = np.abs(real).max()
    np.testing.assert_allclose(result[..., 0], real, rtol=1e-13, atol=1e-13 * size)
    for direction, (other, slope) in enumerate(zip(moved, slopes, strict=True), start=1):
        exact = answers(other.complex_model, kind, role, value + 1j * STEP * slope).imag / STEP
        np.testing.assert_allclose(result[..., direction], exact, rtol=1e-10, atol=1e-12 * np.abs(exact).max())


Maker = Callable[[Integrator], da.TimeResponse]
TIMES = np.array([0.0, 0.021, 0.04, 0.0613])
"""Some are between the ends of steps."""


def in_space(scene: str) -> Maker:
    """A scene as a function of all of its numbers."""
    build, fields = SCENES[scene]
    parameters = spatial_scenes.parameters_of(fields)
    names = [f"{body.name}.{body.point_names[-1]}.{axis}" for body in build(**fields).bodies for axis in "xyz"]

    def response(solver: Integrator) -> da.TimeResponse:
        return da.TimeResponse(
            lambda **numbers: build(**spatial_scenes.fields_of(fields, numbers)), parameters, names, TIMES, solver
        )

    return response


def in_plane(kind: type) -> Maker:
    """The scene of a component in the plane, as a function of its numbers."""
    return lambda solver: planar_scenes.response(*planar_scenes.SCENES[kind], solver)


METHODS = {
    "generalized-alpha": mb.GeneralizedAlpha(2e-3),
    "undamped": mb.GeneralizedAlpha(2e-3, spectral_radius=1.0),
    "variational": mb.Variational(2e-3),
    "energy-momentum": mb.EnergyMomentum(2e-3),
    "Radau": mb.RadauIIA(1e-6),
    "Runge-Kutta": mb.RungeKutta4(2e-3),
}
MODELS = {
    "planar beam": (in_plane(mb.AncfBeam), 2),
    "rubbing pin": (in_plane(mb.RevoluteJoint), 1),
    "rigid body": (in_space("rigid body"), 3),
    "beam": (in_space("beam"), 5),
    "prismatic joint with friction": (in_space("prismatic, rubbing"), 1),
    "prescribed motion": (in_space("prescribed angle"), 1),
}
QUICK = {("generalized-alpha", "rigid body"), ("variational", "rigid body"), ("Radau", "rigid body")}


@pytest.mark.parametrize(
    ("method", "scene"),
    [
        pytest.param(method, scene, marks=() if (method, scene) in QUICK else pytest.mark.slow)
        for method in METHODS
        for scene in MODELS
        if method != "Runge-Kutta" or "beam" not in scene  # which is too stiff for it
    ],
)
def test_sensitivities_are_those_of_complex_steps_one_by_one(
    method: str, scene: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    """In more than one group of eight; nodes have internal constraints, velocities are moved onto them."""
    make, groups = MODELS[scene]
    own = make(METHODS[method])
    start = own.parameters.start
    monkeypatch.setattr(directions, "FEWEST", 1)
    assert len(start) > DIRECTIONS * (groups - 1)
    values, together = own.linearise(start)
    monkeypatch.setattr(directions, "FEWEST", len(start) + 1)
    plain, one_by_one = own.linearise(start)
    np.testing.assert_array_equal(values, plain)
    np.testing.assert_allclose(together, one_by_one, rtol=0, atol=1e-10 * np.abs(one_by_one).max())


def test_a_direction_at_rest_does_not_end_the_iteration_of_the_others() -> None:
    assert not has_settled(share_of(1e-20, 0.0), 0.0, 1e-15)
