"""Exact derivatives by every numeric field of every component, against differences of the simulations.

A field or a component that is new fails here until a scene gives it a value.
"""

from collections.abc import Callable
from functools import cache

import numpy as np
import pytest

import dalembert.multibody as mb
from dalembert.multibody.components.fields import arguments
from planar_scenes import SCENES, SHORT, SOLVER, loop, numbers_of, pinned, response, rod, slack
from slopes import errors

#: Arguments that are no numbers.
OTHERS = {
    "name", "a", "b", "at", "against", "anchor", "law", "elements", "coordinate", "follower", "function", "rate",
    "second", "interpolation", "formulation", "integrals",
}  # fmt: skip
#: Times of jumps and of tables, which are fixed numbers.
FIXED = {(mb.Step, "start"), (mb.Step, "end"), (mb.Table, "times"), (mb.BSpline, "start"), (mb.BSpline, "end")}
FIXED |= {(mb.TorsionSpring, "near")}  # it chooses whole turns
#: Fields of a sequence or a mapping, by the values that stand for them in the scene.
INSIDE = {"points": ["tip"], "coefficients": ["c0", "c1", "c2"], "values": ["v0", "v1", "v2", "v3"]}


@cache
def compared(kind: type) -> tuple[dict[str, float], dict[str, float]]:
    return errors(response(*SCENES[kind], SHORT if kind is mb.AncfBeam else SOLVER))


@pytest.mark.parametrize(("kind", "name"), [(kind, name) for kind in SCENES for name in numbers_of(SCENES[kind][1])])
def test_its_derivative_is_the_slope_of_the_motion(kind: type, name: str) -> None:
    error, size = (values[name] for values in compared(kind))
    assert size > 1e-5, "the scene does not depend on it"
    assert error < 1e-6


@pytest.mark.parametrize("damping", [0.0, 0.01], ids=["undamped", "damped"])
@pytest.mark.parametrize(
    ("formulation", "law"),
    [("structural", "plane-strain"), ("structural", "uncoupled"), ("continuum", "plane-stress")],
)
def test_beams_of_every_form_are_differentiated(formulation: str, law: str, damping: float) -> None:
    build, fields = SCENES[mb.AncfBeam]
    fields = fields | {"formulation": formulation, "law": law, "damping": damping}
    if not damping:
        del fields["damping"]
    error, size = errors(response(build, fields, SHORT), relative=3e-3)
    assert min(size.values()) > 1e-5
    assert max(error.values()) < 1e-6


BASES = (mb.Body, mb.Joint, mb.Load, mb.Signal)
KINDS = [
    entry
    for entry in (getattr(mb, name) for name in dir(mb))
    if isinstance(entry, type) and issubclass(entry, (*BASES, mb.GroundPoint)) and entry not in BASES
]


@pytest.mark.parametrize("kind", KINDS)
def test_every_numeric_field_has_a_scene(kind: type) -> None:
    given = SCENES[kind][1]
    for entry in arguments(kind):
        if entry.name not in OTHERS and (kind, entry.name) not in FIXED:
            assert set(INSIDE.get(entry.name, [entry.name])) <= set(given), f"{kind.__name__}.{entry.name} has no test"


@pytest.mark.parametrize(
    ("build", "fields"),
    [
        (rod, {"mass": 2.0, "length": 1.2}),
        (slack, {"x": 0.3, "angle": -0.4}),
        (loop, {"crank": 0.4, "base": 1.1, "turn": 0.7, "rate": 2.0}),
    ],
)
def test_what_follows_from_the_first_placement_is_differentiated(build: Callable, fields: dict) -> None:
    error, size = errors(response(build, fields, SHORT), relative=3e-3)
    assert min(size.values()) > 1e-5
    assert max(error.values()) < 1e-6


@pytest.mark.parametrize(
    "solver",
    [
        mb.GeneralizedAlpha(2e-3, spectral_radius=1.0),
        mb.GeneralizedAlpha(2e-3, spectral_radius=0.0),
        mb.GeneralizedAlpha(2e-3, initial_acceleration="zero"),
        mb.GeneralizedAlpha(3e-3),  # the outputs lie between the steps
    ],
)
def test_every_setting_of_the_solver_is_differentiated(solver: mb.GeneralizedAlpha) -> None:
    model = response(*SCENES[mb.AncfCable])
    error, _ = errors(replace_solver(model, solver), relative=5e-3)
    assert max(error.values()) < 1e-6


def replace_solver(model: mb.TimeResponse, solver: mb.GeneralizedAlpha) -> mb.TimeResponse:
    return mb.TimeResponse(model.builder, model.parameters, model.channel_names, model.times, solver)


def test_friction_that_is_zero_may_be_a_parameter() -> None:
    model = response(pinned, {"viscous": 0.4})
    still, moved = model.evaluate(np.array([[0.0], [0.4]])).only()
    assert np.abs(still - moved).max() > 1e-3
    ahead = model.evaluate(np.array([[1e-6]])).only()[0]
    np.testing.assert_allclose((ahead - still) / 1e-6, model.jacobian(np.array([0.0]))[:, :, 0], rtol=1e-3, atol=1e-2)


@pytest.mark.parametrize("solver", [mb.RadauIIA(), mb.GeneralizedAlpha(1e-3), mb.Variational(1e-3)], ids=str)
def test_the_derivative_by_a_damping_of_zero(solver: mb.Integrator) -> None:
    def build(damping: complex) -> mb.System:
        system = mb.System()
        bob = system.add(mb.PointMass("bob", mass=1.0, position=(0.3, -1.5)))
        ends = system.ground.point(0.0, 0.0), bob.centre
        system.add(mb.Spring("spring", *ends, 100.0, free_length=1.0, damping=damping))
        return system

    model = mb.TimeResponse(build, {"damping": (0.0, 1.0)}, ["bob.centre.y"], np.linspace(0, 1, 11), solver)
    none, little, more = model.evaluate([[0.0], [1e-5], [2e-5]]).values[:, :, 0]
    one_sided = (4 * little - 3 * none - more) / 2e-5
    np.testing.assert_allclose(model.jacobian([0.0])[:, 0, 0], one_sided, atol=1e-6 * np.abs(one_sided).max())
