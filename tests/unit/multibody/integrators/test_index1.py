"""The methods for the equations of index 1: constraints, outputs, derivatives, redundancy, and what they refuse."""

import numpy as np
import pytest

import dalembert.multibody as mb
from conclusions import only
from dalembert.errors import InputError, SolveError
from support import says

STABILISATIONS = (mb.Augmented(), mb.Baumgarte(40.0, 50.0), mb.Projection(), mb.Partitioning())
TIMES = np.array([0.0, 0.0512, 0.3, 0.4371])


def arm(length: complex = 1.0, damping: complex = 0.2) -> mb.System:
    """Two rods on pins with friction that depends on the pin's force, a motor and a load that jumps."""
    system = mb.System()
    upper = system.add(mb.RigidBar("upper", length, 1.0, angle=np.pi / 3))
    lower = system.add(mb.RigidBar("lower", 3.0, 2.0, angle=-np.pi / 6, start=upper.end))
    system.add(mb.RevoluteJoint("O", system.ground, upper.start))
    system.add(
        mb.RevoluteJoint(
            "A", upper.end, lower.start, viscous=damping, friction_coefficient=0.2, pin_radius=0.1, slip_rate=2.0
        )
    )
    system.add(mb.Torque("motor", upper.centre, mb.Step(20.0, 0.1, 0.3)))
    return system


def driven(ratio: complex = 0.4) -> mb.System:
    """A slider-crank whose crank is turned by a prescribed motion."""
    system = mb.System(driving=("crank.angle",))
    crank = system.add(mb.RigidBar("crank", ratio, 1.0, angle=0.3, angular_velocity=2.0))
    rod = system.add(mb.RigidBar("rod", 1.0, 2.0, start=crank.end))
    slider = system.add(mb.RigidBody("slider", 0.5, 0.1, position=rod.end))
    system.add(mb.RevoluteJoint("O", system.ground, crank.start))
    system.add(mb.RevoluteJoint("A", crank.end, rod.start))
    system.add(mb.RevoluteJoint("B", rod.end, slider.centre))
    system.add(mb.PrismaticJoint("guide", system.ground, slider.centre))
    course = mb.Polynomial([0.3, 2.0, 3.0 * ratio])
    system.add(mb.PrescribedMotion("turn", system.ground, crank.centre, coordinate="angle", motion=course))
    return system


def solvers() -> list[mb.RungeKutta4 | mb.OdeSolver]:
    fixed = [mb.RungeKutta4(0.004, stabilisation) for stabilisation in (*STABILISATIONS, mb.Baumgarte())]
    return [
        *fixed,
        *(mb.OdeSolver("DOP853", 1e-9, 1e-11, stabilisation) for stabilisation in STABILISATIONS),
        mb.OdeSolver("RK45", 1e-9, 1e-11),
        *(mb.OdeSolver(method, 1e-9, 1e-11, mb.Partitioning()) for method in ("Radau", "BDF", "LSODA")),
        mb.OdeSolver("BDF", 1e-9, 1e-11),
    ]


def named(solver: mb.RungeKutta4 | mb.OdeSolver) -> str:
    return f"{getattr(solver, 'method', 'RK4')}-{type(solver.stabilisation).__name__}"


@pytest.fixture(scope="module")
def reference() -> dict[str, np.ndarray]:
    fine = mb.GeneralizedAlpha(step=1e-4, spectral_radius=0.9)
    return {
        make.__name__: mb.simulate(make(), TIMES[-1], fine, TIMES).channels(names)
        for make, names in ((arm, NAMES), (driven, DRIVEN))
    }


NAMES = ["lower.end.x", "lower.end.vy", "lower.centre.acceleration", "A.force_x"]
DRIVEN = ["slider.centre.x", "slider.centre.vx", "slider.centre.ax", "turn.torque"]


@pytest.mark.parametrize("solver", solvers(), ids=named)
def test_motion_is_that_of_generalized_alpha(reference, solver) -> None:
    """In between the steps, too, beyond jumps of the load, with friction, and with a prescribed motion."""
    given = solver.stabilisation != mb.Baumgarte()  # the gains by the step cost accuracy
    for make, names in ((arm, NAMES), (driven, DRIVEN)):
        trajectory = mb.simulate(make(), TIMES[-1], solver, TIMES)
        ours = trajectory.channels(names)
        rough = max(abs(reference[make.__name__][:, 2:].ravel()))
        assert ours[:, :2] == pytest.approx(reference[make.__name__][:, :2], abs=1e-5 if given else 2e-3)
        assert ours[:, 2:] == pytest.approx(reference[make.__name__][:, 2:], abs=(1e-4 if given else 3e-2) * rough)
        if isinstance(solver.stabilisation, (mb.Projection, mb.Partitioning)):
            assert all(np.max(level) < 1e-12 for level in trajectory.violations.values())


@pytest.mark.parametrize("solver", solvers(), ids=named)
def test_derivatives_are_those_of_the_discrete_solution(solver) -> None:
    explicit = isinstance(solver, mb.RungeKutta4) or solver.method in ("DOP853", "RK45")
    for make, ranges, names in (
        (arm, {"length": (0.5, 2.0), "damping": (0.1, 0.4)}, NAMES),
        (driven, {"ratio": (0.2, 0.6)}, DRIVEN),
    ):
        model = mb.TimeResponse(make, ranges, names, TIMES, solver)
        at = np.array([1.0, 0.2]) if make is arm else np.array([0.4])
        response, ours = model.linearise(at)
        assert response == pytest.approx(model.evaluate(at[None]).only()[0], rel=1e-9 if explicit else 1e-5, abs=1e-9)
        for column in range(len(at)):
            step = 1e-4 * np.eye(len(at))[column]
            after, before = model.evaluate(np.array([at + step, at - step])).only()
            slope = (after - before) / 2e-4
            allowed = (1e-6 if isinstance(solver, mb.RungeKutta4) else 1e-4) * (1 + np.max(np.abs(slope), axis=0))
            assert np.all(np.abs(ours[:, :, column] - slope) <= allowed)


def test_adaptive_explicit_methods_take_the_same_steps_with_derivatives() -> None:
    model = mb.TimeResponse(arm, {"length": (0.5, 2.0)}, NAMES, TIMES, mb.OdeSolver("RK45", 1e-6))
    response, _ = model.linearise(np.array([1.0]))
    assert response == pytest.approx(model.evaluate(np.array([[1.0]])).only()[0], rel=1e-11, abs=1e-11)


def test_a_step_too_long_for_the_stiffness_is_told() -> None:
    system = mb.System()
    mass = system.add(mb.PointMass("mass", 1.0, (1.0, 0.0)))
    system.add(mb.Spring("spring", system.ground.point(0.0, 0.0), mass.centre, 1e6, free_length=0.9))
    with pytest.raises(
        SolveError, match=r"^the motion grew without bound before t = .* s: the step is 0.01 s, too long"
    ):
        mb.simulate(system, 10.0, mb.RungeKutta4(0.01))


@pytest.mark.parametrize("method", ["LSODA", "BDF"])
def test_partitioning_without_constraints_takes_the_steps_of_augmented(method: str) -> None:
    """Nothing depends on the constraints, so the solver does not start again after each step."""
    system = mb.System()
    mass = system.add(mb.PointMass("mass", 1.0, (1.0, 0.0)))
    system.add(mb.Spring("spring", system.ground.point(0.0, 0.0), mass.centre, 400.0, free_length=0.5))
    parted, whole = (
        mb.simulate(system, 0.1, mb.OdeSolver(method, stabilisation=stabilisation, most_steps=1000))
        for stabilisation in (mb.Partitioning(), mb.Augmented())
    )
    assert np.array_equal(parted.run.ends, whole.run.ends)
    assert np.array_equal(parted.states.x, whole.states.x)


@pytest.mark.parametrize(
    ("make", "sentence"),
    [
        (lambda: mb.RungeKutta4(0.0), "RungeKutta4: step is 0 s; expected a positive number"),
        (
            lambda: mb.Baumgarte(alpha=1.0),
            "Baumgarte: alpha is 1.0 and beta is None; expected two positive numbers (1/s), or none of them, which "
            "takes 1/h and sqrt(2)/h of a fixed step h",
        ),
        (
            lambda: mb.OdeSolver(stabilisation=mb.Baumgarte()),
            "Baumgarte: neither alpha nor beta was given, and the integrator chooses its step by the error; give both "
            "(1/s), such as Baumgarte(alpha=10.0, beta=10.0), or use Projection() or Partitioning()",
        ),
        (lambda: mb.Partitioning(1.0), "Partitioning: limit is 1; expected a number above 1"),
        (
            lambda: mb.OdeSolver("dop853"),
            "OdeSolver: unknown method 'dop853'; known: BDF, DOP853, LSODA, RK45, Radau",
        ),
        (
            lambda: mb.OdeSolver(relative_tolerance=1e-14),
            "OdeSolver: relative_tolerance is 1e-14; expected a number of at least 1e-12 and below 1",
        ),
        (
            lambda: mb.OdeSolver(absolute_tolerance=0.0),
            "OdeSolver: absolute_tolerance is 0; expected a positive number",
        ),
        (
            lambda: mb.OdeSolver("LSODA"),
            "OdeSolver: LSODA keeps a memory of past steps that a projection cannot move; give "
            "stabilisation=Partitioning(), or take BDF",
        ),
    ],
)
def test_settings_that_cannot_be_meant(make, sentence: str) -> None:
    with pytest.raises(InputError, match=says(sentence)):
        make()


def parallelogram(bars: int, stiffness: complex = 0.0) -> mb.System:
    """A plate that hangs on parallel bars; from the third on, one constraint a bar follows from the others."""
    system = mb.System()
    feet = [(k - (bars - 1) / 2) * (2.0 / (bars - 1)) for k in range(bars)]
    uprights = [
        system.add(mb.RigidBar(f"bar{k}", 1.0, 2.0 / bars, angle=-1.2, start=system.ground.point(x, 0.0)))
        for k, x in enumerate(feet)
    ]
    points = {f"hole{k}": (x, 0.0) for k, x in enumerate(feet)}
    plate = system.add(mb.RigidBody("plate", 2.0, 0.7, uprights[0].end, anchor="hole0", points=points))
    for k, upright in enumerate(uprights):
        system.add(mb.RevoluteJoint(f"foot{k}", system.ground, upright.start))
        system.add(mb.RevoluteJoint(f"head{k}", upright.end, plate.point(f"hole{k}")))
    if stiffness:
        system.add(mb.Spring("spring", system.ground.point(2.0, 0.5), plate.centre, stiffness, free_length=1.0))
    return system


@pytest.mark.parametrize(
    "solver",
    [
        mb.RungeKutta4(0.01),
        mb.RungeKutta4(0.01, mb.Partitioning()),
        mb.OdeSolver("DOP853"),
        mb.OdeSolver("Radau", stabilisation=mb.Partitioning()),
    ],
    ids=named,
)
def test_redundant_constraints_give_the_motion_of_the_twin_without(solver) -> None:
    """Three thin bars in place of two thick ones: the same mass, so the same motion; and the forces balance."""
    times = np.linspace(0.0, 2.0, 21)
    twin, ours = (mb.simulate(parallelogram(bars), 2.0, solver, times) for bars in (2, 3))
    names = ["plate.centre.x", "plate.centre.y", "plate.centre.vx", "plate.centre.ay"]
    assert ours.channels(names) == pytest.approx(twin.channels(names), abs=1e-6)
    assert all(np.max(level) < 1e-12 for level in ours.violations.values())
    forces = sum(ours.channels([f"head{k}.force_x", f"head{k}.force_y"]) for k in range(3))
    demanded = 2.0 * (ours.channels(["plate.centre.ax", "plate.centre.ay"]) + np.array([0.0, 9.81]))
    assert forces == pytest.approx(demanded, abs=1e-9)
    assert twin.findings == ()
    found = only(ours, "redundant-constraints")
    assert (found.severity, found.values["constraints"], found.values["independent"]) == ("note", 12, 11)
    assert str(found) in ours.summary()


def test_derivatives_of_least_multipliers() -> None:
    names = ["plate.centre.x", "head0.force_x", "head1.force_y", "foot2.force_x"]
    times = np.linspace(0.0, 0.8, 9)
    model = mb.TimeResponse(
        lambda stiffness: parallelogram(3, stiffness), {"stiffness": (5.0, 20.0)}, names, times, mb.RungeKutta4(0.01)
    )
    _, ours = model.linearise(np.array([10.0]))
    after, before = model.evaluate(np.array([[10.0 + 1e-4], [10.0 - 1e-4]])).only()
    assert ours[:, :, 0] == pytest.approx((after - before) / 2e-4, abs=1e-7)
