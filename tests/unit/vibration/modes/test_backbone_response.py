"""Frequency and damping of a nonlinear mode as a forward model: values, derivatives, identification, refusals."""

import numpy as np
import pytest

import dalembert as da
from dalembert.errors import InputError
from dalembert.structure import lumped
from dalembert.vibration import (
    BackboneResponse,
    CubicSpring,
    ElasticSlider,
    FrictionContact,
    HarmonicBalance,
    HarmonicForce,
    Rigid,
    StaticForce,
    VibrationSystem,
    backbone,
)
from support import says

AMPLITUDES = np.array([0.5, 2.0, 5.0])
BOX = {
    "stiffness": (0.1, 1.0),
    "friction": (0.1, 1.0),
    "spring": (0.5, 2.0),
    "damping": (0.005, 0.1),
    "mass": (0.5, 2.0),
}
METHOD = HarmonicBalance(5, solver="stiffness", tolerance=1e-13)
POINT = np.array([0.3, 0.4, 1.0, 0.03, 1.0])


def jointed(stiffness, friction, spring, damping, mass):
    """Two masses with a slider on the second and a cubic spring."""
    chain = lumped({"a": mass, "b": 1.5}, [("a", None, spring, damping), ("a", "b", 2.0, 0.01)])
    system = VibrationSystem(chain)
    law_of_slider = ElasticSlider(tangential_stiffness=stiffness)
    system.add(FrictionContact("joint", "b", friction=friction, preload=2.0, law=law_of_slider))
    system.add(CubicSpring("spring", "a", stiffness=0.01 * spring))
    system.add(HarmonicForce("a", 5.0))
    return system


def pressed(stiffness, friction, spring, damping, mass):
    """A mass that a static force presses on the ground, with a rigid contact at another one."""
    chain = lumped({"a": mass, "b": 1.5}, [("a", None, spring, damping), ("a", "b", 2.0, 0.01)])
    system = VibrationSystem(chain)
    system.add(StaticForce("a", 0.2 * mass))
    system.add(FrictionContact("joint", "b", friction=friction, preload=stiffness, law=Rigid()))
    return system


def differences(model, point):
    """Central differences of fourth order."""
    columns = []
    for column, value in enumerate(point):
        step = np.zeros(len(point))
        step[column] = 5e-4 * value
        near, far = (
            np.subtract(*model.evaluate(np.array([point + part * step, point - part * step])).values) for part in (1, 2)
        )
        columns.append((8 * near - far) / (12 * step[column]))
    return np.stack(columns, axis=2)


@pytest.mark.parametrize("solver", ["stiffness", "receptance"])
def test_values_are_those_of_the_mode_and_derivatives_those_of_differences(solver):
    method = HarmonicBalance(5, solver=solver, tolerance=1e-13)
    model = BackboneResponse(jointed, BOX, AMPLITUDES, "b", method=method)
    values, jacobian = model.linearise(POINT)
    mode = backbone(jointed(*POINT), AMPLITUDES, method=method, dof="b")
    assert values == pytest.approx(np.stack([mode.frequencies, mode.damping], axis=1), rel=1e-12)
    assert jacobian == pytest.approx(differences(model, POINT), rel=1e-8 if solver == "stiffness" else 2e-7, abs=1e-9)


def test_derivatives_with_a_static_force_and_a_rigid_contact():
    model = BackboneResponse(pressed, BOX, np.array([2.0, 5.0]), "a", method=METHOD)
    jacobian = model.jacobian(POINT)
    assert jacobian == pytest.approx(differences(model, POINT), rel=1e-7, abs=1e-8)


def test_frequency_and_damping_of_a_mode_identify_a_joint():
    names = ("stiffness", "friction")
    box = {name: BOX[name] for name in names}

    def build(stiffness, friction):
        return jointed(stiffness, friction, *POINT[2:])

    model = BackboneResponse(build, box, np.geomspace(0.5, 8.0, 8), "b", method=HarmonicBalance(5))
    values = model.evaluate(POINT[None, :2]).values[0]
    data = da.Measurements.of(
        model.coordinate, dict(zip(("frequency", "damping"), values.T, strict=True)),
        deviations={"frequency": 1e-5, "damping": 1e-5},
    )  # fmt: skip
    fit = da.identify(model, data, starts=2, seed=1)
    assert fit.values == pytest.approx(POINT[:2], rel=1e-6)


def test_a_sample_without_a_mode_is_marked():
    model = BackboneResponse(jointed, BOX, AMPLITUDES, "b", mode=3, method=HarmonicBalance(3))
    responses = model.evaluate(POINT[None])
    assert not responses.ok[0]
    assert "mode 3 is asked for; expected 1 to 2" in responses.failures[0]


def test_parts_and_refinements_are_the_same_model():
    model = BackboneResponse(jointed, BOX, AMPLITUDES, "b", channels=["damping"], method=HarmonicBalance(3))
    assert model.first(2).evaluate(POINT[None]).values.shape == (1, 2, 1)
    assert model.part(0.5)[0].shape == (2, 1)
    refined = model.refined()
    assert refined is not None
    assert refined.model.balance.harmonics == 7
    assert [channel.unit for channel in model.channels] == [""]
    assert model.coordinate.name == "amplitude"


def test_harmonics_are_chosen_once():
    model = BackboneResponse(jointed, BOX, AMPLITUDES, "b")
    assert isinstance(model.balance.harmonics, int)


def test_a_builder_that_loses_the_derivative_is_refused():
    def build(stiffness):
        system = VibrationSystem(lumped({"a": 1.0}, [("a", None, float(np.real(stiffness)), 0.01)]))
        system.add(CubicSpring("spring", "a", stiffness=0.1))
        return system

    model = BackboneResponse(build, {"stiffness": (0.5, 2.0)}, AMPLITUDES, "a", method=HarmonicBalance(3))
    with pytest.raises(InputError, match="stiffness"):
        model.jacobian(np.array([1.0]))


@pytest.mark.parametrize(
    ("change", "sentence"),
    [
        ({"channels": []}, "BackboneResponse: no channels were given; name 'frequency', 'damping' or both"),
        (
            {"channels": ["force"]},
            "BackboneResponse: unknown channel 'force'; known: damping, frequency",
        ),
        (
            {"derivative": "duals"},
            "BackboneResponse: unknown derivative 'duals'; known: central-differences, complex-step",
        ),
    ],
)
def test_wrong_arguments_are_refused(change, sentence):
    with pytest.raises(InputError, match=says(sentence)):
        BackboneResponse(jointed, BOX, AMPLITUDES, "b", **change)
