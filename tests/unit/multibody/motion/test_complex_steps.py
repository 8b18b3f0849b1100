"""A mechanism whose builder, or whose forces, drop the imaginary part is refused; differences serve instead."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import pytest
from numba import njit

import dalembert as da
from dalembert.kernels.kernel import inner
from dalembert.multibody import Kind, Load
from dalembert.multibody.components.fields import Number, number
from dalembert.multibody.components.planar import pairs
from dalembert.multibody.components.points import Side

TIMES = np.linspace(0.0, 0.5, 11)
BOUNDS = {"length": (0.5, 2.0), "stiffness": (10.0, 20.0)}
VALUES = np.array([1.0, 15.0])


def arm(safe: Callable = lambda x: x, stiff: Callable = lambda x: x, course: Callable = lambda x: x) -> Callable:
    """A builder of a bar on a spring, whose parameters go through functions."""

    def build(length: float, stiffness: float) -> da.System:
        system = da.System()
        bar = system.add(da.RigidBar("bar", safe(length), 1.0, angle=0.3))
        system.add(da.RevoluteJoint("pin", system.ground, bar.start, viscous=0.1))
        system.add(da.Spring("coil", system.ground.point(0.0, 1.0), bar.end, stiff(stiffness)))
        system.add(da.Force("push", bar.end, x=da.signals.Harmonic(course(length), 3.0)))
        return system

    return build


def response(builder: Callable, **settings: str) -> da.TimeResponse:
    return da.TimeResponse(builder, BOUNDS, ["bar.end.x"], TIMES, da.GeneralizedAlpha(step=2e-3), **settings)


LOSING = {"abs": abs, "norm": lambda x: np.linalg.norm([x, 0.0]), "a part": lambda x: 0.5 * (x + abs(x))}


@pytest.mark.parametrize("name", LOSING)
def test_a_builder_that_loses_the_step_is_refused(name: str) -> None:
    with pytest.raises(da.InputError, match=r"of 'bar' by 'length' is .* by the complex step, but .* by differences"):
        response(arm(safe=LOSING[name])).jacobian(VALUES)


def test_the_component_and_its_number_are_named() -> None:
    with pytest.raises(da.InputError, match="derivative of 'stiffness' of 'coil' by 'stiffness' is 0 by the complex"):
        response(arm(stiff=np.abs)).jacobian(VALUES)


def test_a_function_of_time_is_named() -> None:
    with pytest.raises(da.InputError, match="derivative of a function of time by 'length' is 0 by the complex step"):
        response(arm(course=abs)).jacobian(VALUES)


def test_an_identification_does_not_begin_with_wrong_derivatives() -> None:
    data = da.Measurements.of(TIMES, {"bar.end.x": np.zeros_like(TIMES)})
    with pytest.raises(da.InputError, match="by the complex step"):
        da.identify(response(arm(safe=abs)), data, starts=1, seed=0)


NARROW = {"length": (0.9, 1.1), "stiffness": (14.0, 16.0)}
METHODS: dict[str, Callable] = {
    "taylor": lambda model, data, fit: da.propagate(model, NARROW, "taylor"),
    "optimise": lambda model, data, fit: da.propagate(model, NARROW, "optimise"),
    "profile": da.profile,
    "predict": lambda model, data, fit: da.predict(model, fit),
    "design": lambda model, data, fit: da.design(model, VALUES, deviations=1e-3),
}


@pytest.mark.parametrize("method", METHODS)
def test_every_method_that_differentiates_refuses_a_lost_step(method: str) -> None:
    """The fit is that of a builder that carries the step."""
    safe, losing = response(arm()), response(arm(safe=abs))
    data = da.Measurements.of(TIMES, {"bar.end.x": safe.evaluate(VALUES[None]).values[0, :, 0]}, 1e-3)
    fit = da.identify(safe, data, start=VALUES, starts=1)
    with pytest.raises(da.InputError, match="by 'length' is 0 by the complex step"):
        METHODS[method](losing, data, fit)


def test_safe_functions_and_differences_give_the_derivatives() -> None:
    exact = response(arm()).jacobian(VALUES)
    safe = arm(safe=lambda x: da.hypot(x, 0.0), stiff=da.absolute, course=lambda x: da.norm([0.0, x]))
    np.testing.assert_allclose(response(safe).jacobian(VALUES), exact, rtol=1e-12)
    differences = response(arm(safe=abs, stiff=abs, course=abs), derivative="central-differences")
    values, slopes = differences.linearise(VALUES)
    np.testing.assert_allclose(slopes, exact, atol=1e-6 * np.max(np.abs(exact)))
    np.testing.assert_array_equal(values, response(arm()).evaluate(VALUES).only()[0])


def test_a_parameter_on_its_bound_is_compared_inside() -> None:
    response(arm(safe=lambda x: da.hypot(x, 0.0))).jacobian(np.array([0.5, 20.0]))


def test_terms_that_cancel_to_rounding_are_no_loss() -> None:
    """The end of the second bar stays on the axis: its derivative is rounding, and the difference is zero."""

    def build(length: float, stiffness: float) -> da.System:
        system = da.System()
        first = system.add(da.RigidBar("first", length, 1.0, angle=1.1))
        tilt = -np.arcsin(length * np.sin(1.1) / 3.0)
        second = system.add(da.RigidBar("second", 3.0, 1.0, start=first.end, angle=tilt))
        bar = system.add(da.RigidBar("bar", 1.0, 1.0, start=second.end))
        system.add(da.Spring("coil", system.ground.point(0.0, 1.0), bar.end, stiffness))
        return system

    for length in np.linspace(0.8, 1.4, 13):
        assert np.all(np.isfinite(response(build).jacobian(np.array([length, 15.0]))))


def test_a_builder_may_compare_parameters_with_each_other() -> None:
    def build(length: float, stiffness: float) -> da.System:
        return arm(stiff=lambda x: x if length.real > 0.1 else 2 * x)(length, stiffness)

    def compares(length: float, stiffness: float) -> da.System:
        stiff = stiffness * (2 if isinstance(length, float) and length < 0.1 else 1)
        assert not (isinstance(length, complex) and isinstance(stiffness, complex))
        return arm()(length, stiff)

    np.testing.assert_array_equal(response(compares).jacobian(VALUES), response(build).jacobian(VALUES))


def dragged(force: Callable, compiled: bool) -> da.TimeResponse:
    """A bar that a function of its angular velocity brakes."""
    own = njit(force) if compiled else force

    def build(rate: float) -> da.System:
        system = da.System(gravity=(0.0, 0.0))
        bar = system.add(da.RigidBar("bar", 1.0, 1.0, angle=0.3, angular_velocity=rate))
        system.add(da.RevoluteJoint("pin", system.ground, bar.start))
        system.add(da.UserForce("drag", bar.end, own))
        return system

    return da.TimeResponse(build, {"rate": (0.5, 1.5)}, ["bar.end.x"], TIMES, da.GeneralizedAlpha(step=5e-3))


FORCES: dict[str, Callable] = {
    "quadratic": lambda t, at, against: (0.0, 0.0, -0.1 * at[5] * abs(at[5])),
    "Stribeck": lambda t, at, against: (0.0, 0.0, -0.05 * (1 + 2 * np.exp(-abs(at[5]))) * np.sign(at[5].real)),
    "distance": lambda t, at, against: (-np.abs(at[0]) * at[0], 0.0, 0.0),
}


@pytest.mark.parametrize("compiled", [False, True])
@pytest.mark.parametrize("name", FORCES)
def test_a_force_that_loses_the_step_of_the_state_is_refused(name: str, compiled: bool) -> None:
    with pytest.raises(da.InputError, match="a force of 'drag' depends on the state, but its derivative is"):
        dragged(FORCES[name], compiled).jacobian(np.array([1.0]))


def test_a_force_by_safe_functions_is_accepted() -> None:
    model = dragged(lambda t, at, against: (0.0, 0.0, -0.1 * at[5] * da.absolute(at[5])), compiled=False)
    slopes = model.jacobian(np.array([1.0]))
    ahead, behind = model.evaluate(np.array([[1.0 + 1e-5], [1.0 - 1e-5]])).values
    np.testing.assert_allclose(slopes[:, :, 0], (ahead - behind) / 2e-5, atol=1e-7)


def captured(force: Callable = lambda x: x, course: Callable = lambda x: x, compiled: bool = False) -> da.TimeResponse:
    """A bar under a force and a function of time that close over a parameter."""

    def build(size: float) -> da.System:
        own = force(size)

        def push(t, at, against):
            return 0.3 * own, 0.0, -0.1 * own * at[5]

        system = da.System(gravity=(0.0, 0.0))
        bar = system.add(da.RigidBar("bar", 1.0, 1.0, angle=0.3, angular_velocity=1.0))
        system.add(da.RevoluteJoint("pin", system.ground, bar.start))
        system.add(da.UserForce("drag", bar.end, njit(push) if compiled else push))
        system.add(da.Force("push", bar.end, x=da.signals.Custom(lambda t: course(size) * np.sin(3 * t))))
        return system

    return da.TimeResponse(build, {"size": (0.5, 1.5)}, ["bar.end.x"], TIMES, da.GeneralizedAlpha(step=5e-3))


@pytest.mark.parametrize("name", LOSING)
def test_a_force_that_loses_the_step_of_a_captured_parameter_is_refused(name: str) -> None:
    with pytest.raises(
        da.InputError, match=r"derivative of a force of 'drag' at t = \S+ s by 'size' is \S+ by the comp"
    ):
        captured(force=LOSING[name]).jacobian(np.array([1.0]))


def test_a_compiled_force_that_loses_a_captured_parameter_is_refused() -> None:
    with pytest.raises(
        da.InputError, match=r"derivative of a force of 'drag' at .* by 'size' is 0 by the complex step"
    ):
        captured(force=abs, compiled=True).jacobian(np.array([1.0]))


@pytest.mark.parametrize("name", LOSING)
def test_a_signal_that_loses_the_step_of_a_captured_parameter_is_refused(name: str) -> None:
    with pytest.raises(da.InputError, match="derivative of the function of time 'x' of 'push' by 'size' is"):
        captured(course=LOSING[name]).jacobian(np.array([1.0]))


def test_functions_that_carry_captured_parameters_are_accepted() -> None:
    model = captured(force=da.absolute, course=lambda x: da.hypot(x, 0.1))
    slopes = model.jacobian(np.array([1.0]))
    ahead, behind = model.evaluate(np.array([[1.0 + 1e-5], [1.0 - 1e-5]])).values
    np.testing.assert_allclose(slopes[:, :, 0], (ahead - behind) / 2e-5, atol=1e-8)


def test_a_builder_that_rounds_a_parameter_is_refused() -> None:
    with pytest.raises(da.InputError, match="'stiffness' of 'coil' follows 'stiffness' in steps, as after rounding"):
        response(arm(stiff=lambda x: np.round(x, 2))).jacobian(VALUES)


def test_an_identification_compares_at_its_start_without_a_simulation() -> None:
    model = response(arm(stiff=lambda x: x if x.real < 16.0 else abs(x)))
    model.jacobian(VALUES)
    with pytest.raises(da.InputError, match="derivative of 'stiffness' of 'coil' by 'stiffness' is 0 by the complex"):
        model.check_derivatives(np.array([1.0, 18.0]))


@inner
def nothing(x, v, a, p, m, inputs, r):
    r[0] = 0.0 * x[0]


@inner
def stretch(x, v, a, p, m, inputs, out):
    dx, dy = pairs.separation(x, p, m)
    out[0] = abs(p.gain) * (dx * dx + dy * dy)
    out[1] = p.gain * abs(dx)


GAUGE = Kind(
    "gauge",
    coordinates=pairs.COORDINATES,
    numbers=(*pairs.NUMBERS, "gain"),
    integers=pairs.INTEGERS,
    residual=nothing,
    outputs=(("square", "m^2"), ("side", "m")),
    observe=stretch,
)


@dataclass(frozen=True)
class Gauge(Load):
    """A sensor between two points that drops imaginary parts."""

    a: Side
    b: Side
    gain: Number = number("")

    kind = GAUGE

    def lower(self, lowering):
        pair = lowering.pair(self.a, self.b, self.name)
        lowering.add(GAUGE, pair.slots, [*pair.data, self.gain], pair.integers, self.name)


@pytest.mark.parametrize(
    ("channel", "told"),
    [
        ("gauge.square", "derivative of the channel 'gauge.square' by 'gain' is 0 by the complex step"),
        ("gauge.side", "the channel 'gauge.side' depends on the state, but its derivative is 0 by the complex step"),
    ],
)
def test_a_sensor_of_another_package_that_loses_the_step_is_refused(channel: str, told: str) -> None:
    def build(gain: float) -> da.System:
        system = da.System()
        bar = system.add(da.RigidBar("bar", 1.0, 1.0, angle=0.3))
        system.add(da.RevoluteJoint("pin", system.ground, bar.start))
        system.add(Gauge("gauge", system.ground.point(0.0, 1.0), bar.end, gain))
        return system

    model = da.TimeResponse(build, {"gain": (0.5, 1.5)}, [channel], TIMES, da.GeneralizedAlpha(step=5e-3))
    with pytest.raises(da.InputError, match=told):
        model.jacobian(np.array([1.0]))


def sprung(force: Callable) -> da.System:
    """A mass on a spring and on a force of the user's."""
    system = da.System(gravity=(0.0, 0.0))
    bob = system.add(da.PointMass("bob", 1.0, (1.0, 0.0)))
    system.add(da.Spring("rest", system.ground.point(0.0, 0.0), bob.centre, 100.0))
    system.add(da.Spring("across", system.ground.point(1.0, 1.0), bob.centre, 100.0))
    system.add(da.UserForce("own", bob.centre, force))
    return system


PULLS: dict[str, Callable] = {
    "stiffness": lambda t, at, against: (-300.0 * (np.abs(at[0]) - 1.0), 0.0, 0.0),
    "damping": lambda t, at, against: (-3.0 * at[2].real, 0.0, 0.0),
    "no complex numbers": lambda t, at, against: (-300.0 * (float(at[0]) - 1.0), 0.0, 0.0),
}


@pytest.mark.parametrize("name", PULLS)
def test_modes_with_a_force_that_loses_the_step_are_refused(name: str) -> None:
    with pytest.raises(
        da.InputError, match="a force of 'own' depends on the state, but its derivative is 0 by the"
    ) as told:
        da.modes(sprung(PULLS[name]))
    assert str(told.value).endswith(
        " do. Use absolute, norm, hypot and atan2 of dalembert"
    )  # modes have no differences


def test_modes_with_a_force_by_safe_functions_are_right() -> None:
    force = lambda t, at, against: (-300.0 * (da.absolute(at[0]) - 1.0), 0.0, 0.0)  # noqa: E731
    frequencies = da.modes(sprung(force)).frequencies
    np.testing.assert_allclose(frequencies, np.sqrt([100.0, 400.0]) / (2 * np.pi), rtol=1e-9)


def phase(angle: complex) -> complex:
    """An angle by the complex logarithm: its imaginary part is rounding, far above the complex step."""
    return -1j * np.log(np.cos(angle) + 1j * np.sin(angle))


def test_an_angle_by_the_complex_logarithm_is_refused() -> None:
    def build(angle: float) -> da.System:
        system = da.System()
        bar = system.add(da.RigidBar("bar", 1.0, 1.0, angle=phase(angle)))
        system.add(da.RevoluteJoint("pin", system.ground, bar.start))
        return system

    model = da.TimeResponse(build, {"angle": (0.1, 1.5)}, ["bar.end.x"], TIMES)
    assert np.isfinite(model.evaluate([[0.7957]]).only()).all()
    sentence = r"^a coordinate at the start of 'bar' is 0\.34.*j for real parameters; expected a real number\. .* atan2"
    with pytest.raises(da.InputError, match=sentence):
        model.jacobian(np.array([0.7957]))
    data = da.Measurements.of(TIMES, {"bar.end.x": np.cos(TIMES)})
    with pytest.raises(da.InputError, match=sentence):
        da.identify(model, data, starts=1, seed=0)
