"""Collocation as a minimisation: its steps, outputs, derivatives, minimisers, and how it fails."""

import numpy as np
import pytest

import dalembert as da
from dalembert.errors import InputError, ModelError, SolveError
from dalembert.multibody.integrators.collocation.collocation_descent import descend, descent
from dalembert.multibody.integrators.collocation.collocation_rule import make_rule
from dalembert.multibody.integrators.collocation.collocation_search import CollocationSearch
from dalembert.multibody.integrators.collocation.collocation_step import begin, finish, prepare, step_of
from dalembert.multibody.integrators.collocation.collocation_swarm import squares
from dalembert.multibody.integrators.shared.batch import cut
from dalembert.multibody.integrators.shared.problem import DONE, SampleModels
from dalembert.multibody.integrators.shared.run import make_problem
from dalembert.multibody.kernels.block_table import addresses
from dalembert.multibody.kernels.states import resting
from dalembert.multibody.start.assemble import assembled
from dalembert.study.schema import study_file
from support import says

ANGLES = ["upper.centre.angle", "lower.centre.angle"]
PRECISE = da.GaussNewton(iterations=12)


def arm(length=3.0, damping=0.0, kick=0.0):
    """Two links with a damped elbow and a torque that jumps."""
    system = da.System()
    upper = system.add(da.RigidBar("upper", 1.0, 1.0, angle=np.pi / 3))
    lower = system.add(da.RigidBar("lower", length, 2.0, angle=-np.pi / 6, start=upper.end))
    system.add(da.RevoluteJoint("O", system.ground, upper.start))
    system.add(da.RevoluteJoint("A", upper.end, lower.start, viscous=damping))
    system.add(da.Torque("motor", upper.centre, da.signals.Step(kick, 0.2)))
    return system


def slider_crank(friction=0.0):
    """A closed loop with a slide, whose friction depends on the multipliers."""
    system = da.System()
    crank = system.add(da.RigidBar("crank", 0.3, 1.0, angle=0.6, angular_velocity=5.0))
    rod = system.add(da.RigidBar("rod", 0.9, 1.5, angle=-0.2, start=crank.end))
    slider = system.add(da.RigidBody("slider", 1.0, 0.1, position=rod.end))
    system.add(da.RevoluteJoint("O", system.ground, crank.start))
    system.add(da.RevoluteJoint("A", crank.end, rod.start))
    system.add(da.RevoluteJoint("B", rod.end, slider.centre))
    system.add(
        da.PrismaticJoint("guide", system.ground, slider.centre, friction_coefficient=friction, slip_velocity=1.0)
    )
    return system


def beam(modulus=2e6):
    """A soft beam on a pin."""
    system = da.System()
    section = {"density": 1000.0, "height": 0.05, "width": 0.05, "poisson_ratio": 0.3}
    own = system.add(da.AncfBeam("beam", 1.0, 2, modulus, **section))
    system.add(da.RevoluteJoint("O", system.ground, own.start))
    return system


def end(system, solver, channels, time=0.4):
    return da.simulate(system, time, solver=solver, times=np.array([0.0, time])).channels(channels)[-1]


@pytest.mark.parametrize(
    ("system", "channels", "step"),
    [
        (arm(damping=0.5, kick=20.0), ANGLES, 0.01),
        (slider_crank(0.3), ["slider.centre.x", "crank.centre.angle"], 0.005),
        (beam(), ["beam.end.x", "beam.end.y"], 0.001),
    ],
    ids=["arm", "slider-crank with friction", "beam"],
)
def test_it_agrees_with_generalized_alpha_and_holds_the_constraints(system, channels, step):
    solver = da.Collocation(step=step, degree=4, gauss_points=3, minimiser=PRECISE)
    trajectory = da.simulate(system, 0.4, solver=solver)
    fine = end(system, da.GeneralizedAlpha(step=2e-5, spectral_radius=0.9), channels)
    np.testing.assert_allclose(trajectory.channels(channels)[-1], fine, atol=2e-7)
    worst = [np.max(level) for level in trajectory.violations.values()]
    assert worst[0] < 1e-13
    assert worst[1] < 1e-13
    assert worst[2] < 1e-10


def test_outputs_between_steps_satisfy_the_constraints_too_and_change_no_step():
    times = np.sort(np.random.default_rng(0).uniform(0.0, 0.4, 40))
    system, solver = arm(kick=20.0), da.Collocation(step=0.02, degree=4, gauss_points=3)
    trajectory = da.simulate(system, 0.4, solver=solver, times=times)
    assert max(np.max(level) for level in trajectory.violations.values()) < 1e-11
    fine = da.simulate(system, 0.4, solver=da.Collocation(step=0.001, degree=4, gauss_points=3), times=times)
    np.testing.assert_allclose(trajectory.channels(ANGLES), fine.channels(ANGLES), atol=2e-6)
    steps = da.simulate(system, 0.4, solver=solver)
    np.testing.assert_array_equal(end(system, solver, ANGLES), steps.channels(ANGLES)[-1])


def test_the_rule_integrates_accelerations_twice():
    """With u = 1 at the one node of degree 2: q = s^2 / 2, v = s and a = 1 at the Gauss points s."""
    rule, points = make_rule(2, 2), 0.5 + np.array([-0.5, 0.5]) / np.sqrt(3)
    for shapes, point in zip(rule.shapes, points, strict=True):
        np.testing.assert_allclose(shapes.ravel(), [point**2 / 2, point, 1.0], rtol=1e-14)


@pytest.mark.parametrize(("degree", "points"), [(2, 2), (3, 2), (3, 4)])
@pytest.mark.parametrize(
    ("minimiser", "tolerance"),
    # SciPy's ends where the sum of squares gains 1e-15 no more: 3e-8 from the minimum, which is 3e-4 of the push.
    [(PRECISE, 1e-9), (da.LeastSquares(tolerance=1e-15, gain=1e-15), 3e-4)],
    ids=["own", "SciPy's"],
)
def test_derivatives_are_those_of_the_discrete_motion(degree, points, minimiser, tolerance):
    """Against central differences of the same steps; the torque's jump and the length move with the parameters."""
    model = da.TimeResponse(
        arm,
        {"length": (2.0, 4.0), "damping": (0.0, 1.0), "kick": (0.0, 40.0)},
        ANGLES,
        np.array([0.0, 0.13, 0.4]),
        solver=da.Collocation(step=0.02, degree=degree, gauss_points=points, minimiser=minimiser),
    )
    vector = np.array([3.0, 0.5, 20.0])
    response, jacobian = model.linearise(vector)
    np.testing.assert_array_equal(response, model.evaluate(vector).values[0])
    for column, push in enumerate((1e-4, 1e-4, 1e-3)):
        sides = [model.evaluate(vector + side * push * np.eye(3)[column]).values[0] for side in (2, 1, -1, -2)]
        differences = (-sides[0] + 8 * sides[1] - 8 * sides[2] + sides[3]) / (12 * push)
        np.testing.assert_allclose(jacobian[..., column], differences, atol=tolerance * np.abs(differences).max())


def test_swarms_find_the_minimum_of_gauss_and_newton():
    steps = {"step": 0.02, "degree": 2, "gauss_points": 2}
    expected = end(arm(), da.Collocation(**steps), ANGLES, 0.2)
    for minimiser, tolerance in (
        (da.LeastSquares(), 1e-8),
        (da.Firefly(), 1e-5),
        (da.Minimiser("Nelder-Mead", {"xatol": 1e-9, "fatol": 1e-14}), 1e-6),
        (da.ParticleSwarm(particles=30, iterations=60), 1e-4),
    ):
        found = end(arm(), da.Collocation(minimiser=minimiser, **steps), ANGLES, 0.2)
        np.testing.assert_allclose(found, expected, atol=tolerance)


def test_gauss_and_newton_leave_no_more_than_fireflies():
    """From the same states, step after step: the sums of squares of both, by the same compiled function."""
    lowered = assembled(arm(damping=0.5))
    slots, layout = lowered.structure.full.dense
    problem = make_problem(lowered, np.zeros(0))._replace(exact_slots=slots, exact_layout=layout)
    problem, solver = cut([lowered], problem, 0.3), da.Collocation(step=0.01)
    schedule, rule = solver.schedule(problem.edges[0], problem.times), make_rule(2, 2)
    real, complex_one = lowered.real.need("rates"), lowered.complex_model.need("rates")
    calls = real.call(), complex_one.call()
    walk = prepare(problem, rule, *calls, 0, linear=True)
    scratch = descent(problem, walk)
    walk.old.x[:], walk.old.v[:] = lowered.x, lowered.v
    models = SampleModels(real.address, lowered.tangents.address, addresses([]))
    moving = models._replace(directions=addresses([complex_one, complex_one]))
    out, dout = resting(0, len(lowered.x)), resting(0, 0, len(lowered.x))
    search = CollocationSearch(da.Firefly(), 0, problem, rule, moving, schedule, walk)
    for number in range(len(schedule.begins)):
        step = step_of(schedule, number)
        assert begin(problem, rule, models, step, walk) == DONE
        middle = walk.c.copy()
        kept = search.kept(step)
        search(number)
        fireflies = walk.c.copy()
        walk.c[:] = middle
        status, _, _ = descend(problem, rule, 3, moving, step, walk, scratch)
        assert status == DONE
        left = np.zeros(3)
        squares(problem, rule, models.real, step, walk, kept, np.array([middle, fireflies, walk.c]), left)
        assert left[2] <= left[1] * (1 + 1e-9)  # to the rounding of large accelerations
        assert left[1] <= left[0]
        assert finish(problem, rule, models, step, walk, out, dout) == DONE


def test_a_seed_fixes_every_bit_and_another_seed_changes_them():
    minimiser = da.Firefly(fireflies=12)
    one, same, other = (
        end(arm(), da.Collocation(step=0.02, minimiser=minimiser, seed=seed), ANGLES, 0.2) for seed in (1, 1, 2)
    )
    assert one.tobytes() == same.tobytes()
    assert one.tobytes() != other.tobytes()


def test_independent_coordinates_are_chosen_anew_on_the_way():
    """A crank that turns whole turns: no coordinate of it is independent everywhere but its angle is."""
    system = da.System(gravity=(0.0, 0.0))
    mass = system.add(da.PointMass("mass", 1.0, position=(1.0, 0.0), velocity=(0.0, 3.0)))
    system.add(da.DistanceJoint("rod", system.ground.point(0.0, 0.0), mass.centre))
    trajectory = da.simulate(system, 5.0, solver=da.Collocation(step=0.02, degree=4, gauss_points=3))
    angle = 3.0 * trajectory.times
    np.testing.assert_allclose(
        trajectory.channels(["mass.centre.x", "mass.centre.y"]), np.stack([np.cos(angle), np.sin(angle)], 1), atol=1e-7
    )


def test_a_motion_that_is_prescribed_altogether_has_nothing_to_minimise():
    system = da.System()
    mass = system.add(da.PointMass("mass", 1.0))
    for axis in ("x", "y"):
        system.add(
            da.PrescribedMotion(
                axis, system.ground, mass.centre, coordinate=axis, motion=da.signals.Polynomial([0.0, 0.0, 2.0])
            )
        )
    for minimiser in (da.GaussNewton(), da.Firefly()):
        trajectory = da.simulate(system, 1.0, solver=da.Collocation(step=0.1, minimiser=minimiser))
        np.testing.assert_allclose(trajectory.channels(["mass.centre.x"])[:, 0], 2 * trajectory.times**2, atol=1e-14)
        np.testing.assert_allclose(trajectory.reactions("y")[:, 1], 4.0 + 9.81, rtol=1e-12)


def test_a_study_file_names_the_minimiser_by_its_name_or_with_settings():
    body = [{"kind": "PointMass", "name": "mass", "mass": 1.0}]
    for given, expected in (
        ("gauss-newton", da.GaussNewton()),
        ({"kind": "firefly", "fireflies": 9}, da.Firefly(fireflies=9)),
    ):
        solver = {"kind": "Collocation", "step": "1 ms", "degree": 3, "minimiser": given}
        file = study_file().model_validate({"model": {"body": body}, "solver": solver, "simulate": {"end": 1.0}})
        assert file.solver.settings() == da.Collocation(step=1e-3, degree=3, minimiser=expected)


def test_a_step_that_is_too_long_is_a_reason_with_time_and_component():
    with pytest.raises(
        SolveError, match=r"^Newton's iteration did not converge at t = .* s, worst at component '.*', "
    ):
        da.simulate(beam(2e9), 1.0, solver=da.Collocation(step=0.2))


def test_a_search_without_an_exact_end_has_no_derivatives():
    model = da.TimeResponse(
        arm, {"length": (2.0, 4.0)}, ANGLES, np.array([0.0, 0.1]), da.Collocation(step=0.01, minimiser=da.Firefly())
    )
    sentence = (
        "Collocation: a step by Firefly has no exact derivatives, because the search ends near the minimum, not at it; "
        "take GaussNewton() or LeastSquares()"
    )
    with pytest.raises(InputError, match=says(sentence)):
        model.jacobian(np.array([3.0]))


@pytest.mark.parametrize(
    ("wrong", "sentence"),
    [
        (lambda: da.GaussNewton(iterations=0), "GaussNewton: iterations is 0; expected a whole number of at least 1"),
        (lambda: da.Collocation(step=0.0), "Collocation: step is 0 s; expected a positive number"),
        (lambda: da.Collocation(step=0.1, degree=1), "Collocation: degree is 1; expected a whole number of at least 2"),
        (
            lambda: da.Collocation(step=0.1, degree=4),
            "Collocation: gauss_points is 2; expected at least degree - 1 = 3",
        ),
        (
            lambda: da.Collocation(step=0.1, minimiser="firefly"),  # type: ignore[arg-type]
            "Collocation: minimiser is 'firefly'; expected GaussNewton(), Firefly(), LeastSquares() or another "
            "minimiser of dalembert.optimize",
        ),
    ],
)
def test_wrong_settings_are_answered_in_a_sentence(wrong, sentence):
    with pytest.raises(InputError, match=says(sentence)):
        wrong()


def test_redundant_constraints_are_refused():
    system = da.System()
    bar = system.add(da.RigidBar("bar", 1.0, 1.0))
    system.add(da.RevoluteJoint("O", system.ground, bar.start))
    system.add(da.RevoluteJoint("again", system.ground, bar.start))
    with pytest.raises(
        ModelError, match=r"^the constraints are redundant: 4 were given, 2 are independent at the start"
    ):
        da.simulate(system, 1.0, solver=da.Collocation(step=0.01))
