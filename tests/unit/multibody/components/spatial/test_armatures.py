"""Armatures and motors whose masses change with the coordinates: orders, energy, derivatives, and a refusal."""

import numpy as np
import pytest

import dalembert as da
from dalembert.errors import ModelError
from dalembert.multibody.integrators.shared.rotors import with_rotors
from dalembert.multibody.spatial import (
    Armature,
    Inertia,
    Motor,
    PrismaticJoint,
    RevoluteJoint,
    RigidBody,
    SpatialSystem,
    SphericalJoint,
)
from dalembert.multibody.start.assemble import assembled
from support import says

END = 1.0
AXIS = (0.2, 1.0, 0.1)
CHANNELS = ["b.low.x", "b.low.y", "b.low.z", "a.low.vx", "elbow.rate"]
METHODS = [da.Variational, da.EnergyMomentum, da.GeneralizedAlpha]


def arm(inertia=2.0, length=0.4, drive="armature"):
    """A body on a ball joint, and a second one on a revolute joint with an armature that outweighs it."""
    system = SpatialSystem(gravity=(0.0, 0.0, -9.81))
    box = Inertia.box(1.0, (0.1, 0.06, 0.3))
    a = system.add(
        RigidBody(
            "a",
            box.moved((0.0, 0.0, -length / 2)),
            points={"low": (0.0, 0.0, -length)},
            angular_velocity=(2.0, 1.0, 3.0),
        )
    )
    b = system.add(
        RigidBody("b", box.moved((0.05, 0.0, -0.15)), position=a.point("low"), points={"low": (0.0, 0.0, -0.3)})
    )
    system.add(SphericalJoint("ball", system.ground, a.point("origin")))
    sides = a.point("low"), b.point("origin")
    if drive == "slide":
        system.add(PrismaticJoint("elbow", *sides, axis=AXIS))
        system.add(Armature("drive", *sides, inertia, axis=AXIS, slides=True))
        return system
    system.add(RevoluteJoint("elbow", *sides, axis=AXIS))
    if drive == "motor":
        numbers = {"torque_constant": 0.05, "resistance": 1.0, "voltage": 2.0, "gear_ratio": 20.0}
        system.add(Motor("drive", *sides, **numbers, armature_inertia=inertia / 400, axis=AXIS))
    else:
        system.add(Armature("drive", *sides, inertia, axis=AXIS))
    return system


def end(drive, solver):
    channels = [name.replace("elbow.rate", "elbow.speed") if drive == "slide" else name for name in CHANNELS]
    return da.simulate(arm(drive=drive), END, solver, [0.0, END]).channels(channels)[-1]


@pytest.fixture(scope="module", params=["armature", "motor", "slide"])
def drive(request):
    """What drives the joint, and the exact end by an explicit method with minimal coordinates."""
    return request.param, end(request.param, da.OdeSolver("DOP853", 1e-12, 1e-12))


def test_radau_keeps_its_order(drive):
    name, exact = drive
    errors = [np.abs(end(name, da.RadauIIA(step=step, stages=3)) - exact).max() for step in (0.04, 0.02, 0.01)]
    assert np.log2(errors[1] / errors[2]) == pytest.approx(5.0, abs=0.2)
    assert np.abs(end(name, da.RadauIIA(tolerance=1e-9)) - exact).max() < 1e-10


@pytest.mark.parametrize("method", METHODS, ids=lambda method: method.__name__)
def test_the_others_keep_the_second_order(drive, method):
    name, exact = drive
    errors = [np.abs(end(name, method(step=step)) - exact).max() for step in (4e-3, 2e-3)]
    assert np.log2(errors[0] / errors[1]) == pytest.approx(2.0, abs=0.02)
    assert errors[1] < 2e-4


@pytest.mark.parametrize("kind", ["armature", "slide"])
def test_the_energy_is_conserved(kind):
    def change(solver):
        trajectory = da.simulate(arm(drive=kind), END, solver, np.linspace(0.0, END, 11))
        return np.ptp(trajectory.channels(["system.total_energy"]))

    assert change(da.EnergyMomentum(step=4e-3)) < 1e-12
    assert change(da.RadauIIA(tolerance=1e-9)) < 1e-10


@pytest.mark.parametrize("solver", [da.RadauIIA(tolerance=1e-11), da.EnergyMomentum(step=4e-3)], ids=["Radau", "EM"])
@pytest.mark.parametrize("kind", ["armature", "motor"])
def test_derivatives_are_exact(kind, solver):
    box = {"inertia": (0.01, 3.0), "length": (0.3, 0.5)}
    times = np.linspace(0.2, END, 5)
    model = da.TimeResponse(lambda inertia, length: arm(inertia, length, kind), box, CHANNELS, times, solver)
    at, step = np.array([0.5, 0.4]), 1e-3
    jacobian = model.jacobian(at)
    for column, unit in enumerate(np.eye(2)):
        runs = [model.evaluate(at + k * step * unit).only()[0] for k in (-2, -1, 1, 2)]
        differences = (runs[0] - 8 * runs[1] + 8 * runs[2] - runs[3]) / (12 * step)
        assert np.abs(jacobian[:, :, column] - differences).max() < 1e-8 * np.abs(differences).max()


def test_rotors_begin_where_the_joints_do():
    lowered = assembled(arm())
    (moved,), kept = with_rotors([lowered])
    assert (moved.structure.n, moved.structure.size) == (lowered.structure.n + 1, lowered.structure.size + 2)
    np.testing.assert_array_equal(moved.x[kept], lowered.x)
    spin = da.simulate(arm(), 0.1, times=[0.0]).channels(["elbow.angle", "elbow.rate"])[0]
    np.testing.assert_allclose([moved.x[lowered.structure.n], moved.v[lowered.structure.n]], spin, atol=1e-14)


def test_masses_without_a_rotor_are_refused(monkeypatch):
    lowered = assembled(arm())
    kind = next(kind for kind in lowered.data if kind.varying_mass)
    monkeypatch.setitem(vars(kind), "rotor", None)
    sentence = (
        "Variational needs masses that do not change with the coordinates, as those of 'turning_armature' do. Use "
        "RadauIIA, GeneralizedAlpha, RungeKutta4 or OdeSolver"
    )
    with pytest.raises(ModelError, match=says(sentence)):
        da.simulate(arm(), 0.1, da.Variational(step=1e-2))


def two_on_a_hinge(count: int) -> SpatialSystem:
    """A pendulum whose hinge on the ground is driven by two motors, or by one of twice the constant."""
    system = SpatialSystem(gravity=(0.0, 0.0, -9.81))
    body = system.add(RigidBody("b", Inertia(2.0, (0.02, 0.03, 0.04), centre=(0.1, 0.0, 0.2))))
    sides = system.ground, body.point("origin")
    system.add(RevoluteJoint("hinge", *sides, axis=AXIS))
    numbers = {"torque_constant": 0.1 / count, "back_emf": 0.1, "resistance": 1.0, "armature_inertia": 0.02 / count}
    for number in range(count):
        system.add(Motor(f"motor {number}", *sides, **numbers, voltage=2.0, axis=AXIS))
    return system


@pytest.mark.parametrize("method", METHODS)
def test_two_motors_on_one_hinge_of_the_ground_are_one_of_twice_the_constant(method):
    ends = [
        da.simulate(two_on_a_hinge(count), 0.2, method(1e-3), [0.2]).channels(["b.centre.x", "hinge.rate"])
        for count in (1, 2)
    ]
    np.testing.assert_allclose(ends[1], ends[0], rtol=1e-11)
