"""A vibrating system whose builder, or whose laws, drop the imaginary part is refused; differences serve instead."""

from collections.abc import Callable
from itertools import pairwise

import numpy as np
import pytest
from scipy.sparse import csc_array

import dalembert as da
from dalembert.structure import Modal, Structure, craig_bampton, lumped
from dalembert.vibration import (
    CubicSpring,
    ElasticSlider,
    FrequencyResponse,
    FrictionContact,
    Gap,
    HarmonicBalance,
    HarmonicForce,
    StaticForce,
    UserElement,
    VibrationSystem,
    frequency_response,
)

FREQUENCIES = np.array([0.08, 0.1])
BOUNDS = {"size": (0.5, 1.5), "mass": (0.8, 1.2)}
VALUES = np.array([1.0, 1.0])


def same(x: complex) -> complex:
    return x


NUMBERS = {
    "stiff": "the stiffness of the structure between 'a.x' and 'a.x'",
    "damper": "the damping of the structure between 'b.x' and 'b.x'",
    "force": "'amplitude' of the force on 'a'",
    "static": "'value' of the force on 'b'",
    "phase": "'phase' of the force on 'a'",
    "friction": "'friction' of 'foot'",
    "tangential": "'tangential stiffness' of 'foot'",
    "cubic": "'stiffness' of 'cubic'",
    "gap": "'gap' of 'stop'",
}


def builder(sparse: bool = False, **through: Callable) -> Callable[..., VibrationSystem]:
    """A chain of two masses with contacts and springs, whose numbers go through functions."""

    def build(size: float, mass: float) -> VibrationSystem:
        own = {name: through.get(name, same)(size) for name in NUMBERS}
        springs = [("a", None, own["stiff"], 0.02), ("a", "b", 1.0, 0.01), ("b", None, 0.5, 0.02 * own["damper"])]
        structure = lumped({"a": mass, "b": 1.0}, springs)
        if sparse:
            matrices = (csc_array(matrix) for matrix in (structure.mass, structure.stiffness, structure.damping))
            weight, stiffness, damping = matrices
            structure = Structure(weight, stiffness, structure.dofs, damping)
        system = VibrationSystem(structure)
        system.add(HarmonicForce("a", own["force"], 0.3 * own["phase"]))
        system.add(StaticForce("b", 0.1 * own["static"]))
        law = ElasticSlider(tangential_stiffness=own["tangential"])
        system.add(FrictionContact("foot", "b", friction=0.3 * own["friction"], preload=0.5, law=law))
        system.add(CubicSpring("cubic", "a", stiffness=0.1 * own["cubic"]))
        system.add(Gap("stop", "b", stiffness=1.0, gap=0.3 * own["gap"]))
        return system

    return build


def model(build: Callable[..., VibrationSystem], **settings: str) -> FrequencyResponse:
    method = HarmonicBalance(harmonics=3, samples=128)
    return FrequencyResponse(build, BOUNDS, ["b harmonic 1"], FREQUENCIES, method, **settings)  # type: ignore[arg-type]


@pytest.mark.parametrize("name", NUMBERS)
def test_the_component_and_its_number_are_named(name: str) -> None:
    with pytest.raises(da.InputError) as told:
        model(builder(**{name: abs})).jacobian(VALUES)
    assert f"the derivative of {NUMBERS[name]} by 'size' is 0 by the complex step, but " in str(told.value)
    assert "derivative='central-differences'" in str(told.value)


def test_of_a_sparse_matrix_the_degree_of_freedom_is_named() -> None:
    with pytest.raises(da.InputError, match=r"the stiffness of the structure at 'a.x' by 'size' is 0 by the complex"):
        model(builder(sparse=True, stiff=abs)).check_derivatives(VALUES)
    model(builder(sparse=True)).check_derivatives(VALUES)


def test_rounding_is_refused() -> None:
    with pytest.raises(da.InputError, match="'stiffness' of 'cubic' follows 'size' in steps, as after rounding"):
        model(builder(cubic=lambda x: np.round(x, 2))).check_derivatives(VALUES)


def test_an_identification_does_not_begin_with_wrong_derivatives() -> None:
    own = model(builder(stiff=abs))
    data = da.Measurements(own.coordinate, ("b harmonic 1",), own.evaluate(VALUES[None]).values[0])
    with pytest.raises(da.InputError, match="by the complex step"):
        da.identify(own, data, starts=1)


def test_safe_functions_and_differences_give_the_derivatives() -> None:
    exact = model(builder()).jacobian(VALUES)
    safe = builder(stiff=lambda x: da.hypot(x, 0.0), cubic=da.absolute, gap=lambda x: da.norm([0.0, x]))
    np.testing.assert_allclose(model(safe).jacobian(VALUES), exact, rtol=1e-12)
    differences = model(builder(stiff=abs, cubic=abs), derivative="central-differences")
    np.testing.assert_allclose(differences.jacobian(VALUES), exact, atol=1e-6 * np.max(np.abs(exact)))
    assert differences.fingerprint != model(builder(stiff=abs, cubic=abs)).fingerprint


def test_an_unknown_derivative_is_refused() -> None:
    with pytest.raises(da.InputError, match=r"FrequencyResponse: .*'central-difference'"):
        model(builder(), derivative="central-difference")


def reduced(stiff: Callable = same, modal: bool = False) -> Callable[..., VibrationSystem]:
    """A chain whose reduction's basis depends on the parameter."""

    def build(size: float, mass: float) -> VibrationSystem:
        names = [f"m{number}" for number in range(6)]
        springs = [("m0", None, 1.0, 0.0), ("m4", "m5", stiff(size), 0.0)]
        chain = lumped(dict.fromkeys(names, mass), springs + [(a, b, 1.0, 0.02) for a, b in pairwise(names[:-1])])
        system = VibrationSystem(craig_bampton(chain.with_damping(Modal(0.01)) if modal else chain, ["m5"], 2))
        system.add(HarmonicForce("m5", 1.0))
        return system

    return build


@pytest.mark.parametrize("modal", [False, True])
def test_the_basis_of_a_reduced_structure_is_held(modal: bool) -> None:
    method = HarmonicBalance(harmonics=1)
    own = FrequencyResponse(reduced(modal=modal), BOUNDS, ["m5 harmonic 1"], FREQUENCIES, method)
    assert np.all(np.isfinite(own.jacobian(VALUES)))
    own = FrequencyResponse(reduced(np.abs, modal), BOUNDS, ["m5 harmonic 1"], FREQUENCIES, method)
    with pytest.raises(da.InputError, match=r"of the structure between '.*' by 'size' is .* by the complex step"):
        own.jacobian(VALUES)


def with_law(law: Callable[[complex], Callable]) -> Callable[..., VibrationSystem]:
    def build(size: float, mass: float) -> VibrationSystem:
        system = VibrationSystem(lumped({"b": mass}, [("b", None, 1.0, 0.04)]))
        system.add(HarmonicForce("b", 1.0))
        system.add(UserElement("user", ["b.x"], law(size)))
        return system

    return build


LAWS: dict[str, Callable] = {
    "absolute": lambda u: 0.1 * u * np.abs(u),
    "real": lambda u: 0.1 * u.real**3 + 0 * u,
    "a part": lambda u: 0.1 * u + 0.1 * np.abs(u) * u,
}


@pytest.mark.parametrize("name", LAWS)
def test_a_law_that_loses_the_step_of_displacements_is_refused(name: str) -> None:
    """In all that uses its derivative: the curve and its stability do not need parameters."""
    told = r"element 'user': the derivative of its force by the displacements is \S+ N/m by the complex step, but"
    with pytest.raises(da.InputError, match=told):
        frequency_response(with_law(lambda size: LAWS[name])(1.0, 1.0), FREQUENCIES, HarmonicBalance(3))
    (failure,) = model(with_law(lambda size: LAWS[name])).evaluate(VALUES).failures
    assert failure is not None
    assert failure.startswith("element 'user': the derivative of its force")


def test_a_law_by_safe_functions_is_accepted() -> None:
    own = model(with_law(lambda size: lambda u: 0.1 * size * u * da.absolute(u)))
    slopes = own.jacobian(VALUES)
    ahead, behind = own.evaluate(np.array([[1.0 + 1e-5, 1.0], [1.0 - 1e-5, 1.0]])).values
    np.testing.assert_allclose(slopes[:, :, 0], (ahead - behind) / 2e-5, atol=1e-7)


@pytest.mark.parametrize("function", [abs, lambda x: 0.5 * (x + abs(x)), lambda x: np.linalg.norm([x, 0.0])])
def test_a_law_that_loses_the_step_of_a_captured_parameter_is_refused(function: Callable) -> None:
    own = model(with_law(lambda size: lambda u: 0.1 * function(size) * u**3))
    with pytest.raises(
        da.InputError, match=r"derivative of a force of 'user' by 'size' is .* by the complex step, but"
    ):
        own.jacobian(VALUES)
