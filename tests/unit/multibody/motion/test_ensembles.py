"""Batches of simulations: the same bits as one by one, and samples that fail beside others that do not."""

import numpy as np
import pytest

import dalembert.multibody as mb
from dalembert.errors import InputError, ModelError, SolveError
from dalembert.forward import ForwardModel
from support import says

TIMES = np.linspace(0.0, 0.1, 6)
CHANNELS = ("rope.end.x", "rope.end.y", "pin.force_x", "system.total_energy")
SOLVER = mb.GeneralizedAlpha(step=2e-3)


def rope(stiffness: float, rate: float, mass: float = 2.0) -> mb.System:
    """A bar with a soft cable at its end."""
    system = mb.System()
    bar = system.add(mb.RigidBar("bar", 1.0, mass, angle=0.2, angular_velocity=rate))
    soft = system.add(mb.AncfCable("rope", 1.0, 3, stiffness, 1000.0, 0.05, 0.05, start=bar.end))
    system.add(mb.RevoluteJoint("pin", system.ground, bar.start))
    system.add(mb.RevoluteJoint("knot", bar.end, soft.start))
    return system


def response(builder=rope, workers: int = 1, **bounds: tuple[float, float]) -> mb.TimeResponse:
    given = bounds or {"stiffness": (1e5, 1e6), "rate": (-2.0, 2.0)}
    return mb.TimeResponse(builder, given, CHANNELS, TIMES, SOLVER, workers)


@pytest.fixture(scope="module")
def batch() -> np.ndarray:
    random = np.random.default_rng(0)
    return np.stack([random.uniform(1e5, 1e6, 40), random.uniform(-2, 2, 40)], axis=1)


def test_it_is_a_forward_model() -> None:
    model = response()
    assert isinstance(model, ForwardModel)
    assert [(channel.name, channel.unit) for channel in model.channels] == list(
        zip(CHANNELS, ("m", "m", "N", "J"), strict=True)
    )
    assert (model.coordinate.name, model.coordinate.unit) == ("time", "s")
    np.testing.assert_array_equal(model.coordinate.values, TIMES)


def test_a_batch_is_its_single_simulations_bit_for_bit(batch: np.ndarray) -> None:
    values = response().evaluate(batch).only()
    for row in (0, 7, 39):
        np.testing.assert_array_equal(values[row], response().evaluate(batch[row]).only()[0])
        single = mb.simulate(rope(*batch[row]), TIMES[-1], SOLVER, TIMES).channels(CHANNELS)
        np.testing.assert_array_equal(values[row], single)


def test_two_workers_are_one_worker_bit_for_bit(batch: np.ndarray) -> None:
    one, two = (response(workers=workers).evaluate(batch).only() for workers in (1, 2))
    np.testing.assert_array_equal(one, two)
    assert len(np.unique(one[:, -1, 0])) == len(batch)


def test_the_order_of_a_batch_does_not_matter(batch: np.ndarray) -> None:
    model = response()
    np.testing.assert_array_equal(model.evaluate(batch[::-1]).values[::-1], model.evaluate(batch).values)


def test_a_linearisation_has_the_response_of_the_simulation(batch: np.ndarray) -> None:
    model = response()
    values, jacobian = model.linearise(batch[0])
    np.testing.assert_array_equal(values, model.evaluate(batch[0]).only()[0])
    np.testing.assert_array_equal(jacobian, model.jacobian(batch[0]))


def test_its_beginning_is_the_beginning_of_its_response(batch: np.ndarray) -> None:
    model = response()
    short = model.first(3)
    np.testing.assert_array_equal(short.coordinate.values, TIMES[:3])
    np.testing.assert_allclose(
        short.evaluate(batch[0]).only()[0], model.evaluate(batch[0]).only()[0][:3], rtol=1e-9, atol=1e-9
    )


def test_its_fingerprint_holds_all_but_the_values() -> None:
    prints = [
        response().fingerprint,
        response(workers=2).fingerprint,
        response(lambda stiffness, rate: rope(stiffness, rate, mass=2.1)).fingerprint,
        response().first(3).fingerprint,
        mb.TimeResponse(rope, response().parameters, CHANNELS, TIMES, mb.GeneralizedAlpha(1e-3)).fingerprint,
        mb.TimeResponse(rope, response().parameters, CHANNELS[:3], TIMES, SOLVER).fingerprint,
    ]
    assert prints[0] == prints[1]
    assert len(set(prints)) == 5


def awkward(code: float, rate: float) -> mb.System:
    """A rope that cannot be simulated at some codes."""
    system = rope(3e5, rate)
    end = system.bodies[1].point("end")
    if code == 1:
        raise ValueError("the builder refuses this one")
    if code == 2:
        mb.PointMass("heavy", mass=-1.0)
    if code == 3:
        system.add(mb.DistanceJoint("far", system.ground.point(9.0, 0.0), end, length=1.0))
    if code == 4:
        system.add(mb.PointMass("extra", 1.0))
    system.add(mb.Force("blow", end, x=1e13 if code == 5 else 0.0))
    return system


REASONS = {
    1: f"ValueError: the builder refuses this one (test_ensembles.py, line {awkward.__code__.co_firstlineno + 5})",
    2: "PointMass 'heavy': mass is -1 kg; expected a positive number",
    4: "the model's function returned systems of different structure for different parameters; parameters may change "
    "numbers, not the number or the kinds of components",
}


@pytest.mark.parametrize("workers", [1, 2])
def test_samples_that_fail_have_a_reason_and_the_others_return(workers: int) -> None:
    model = response(awkward, workers, code=(-10.0, 10.0), rate=(0.0, 1.0))
    codes = [0, 1, 0, 2, 3, 0, 4, 5, 0]
    given = model.evaluate(np.array([[code, 0.1 * row] for row, code in enumerate(codes)]))
    np.testing.assert_array_equal(given.ok, np.array(codes) == 0)
    for row, code in enumerate(codes):
        if code in REASONS:
            assert given.failures[row] == REASONS[code]
        elif code == 3:
            assert given.failures[row].startswith("the mechanism cannot be assembled: joint 'far' has a gap of ")
        elif code == 5:
            assert given.failures[row].startswith("Newton's iteration did not converge at t = ")
        else:
            np.testing.assert_array_equal(given.values[row], model.evaluate([[0.0, 0.1 * row]]).values[0])
    assert np.all(np.isnan(given.values[~given.ok]))
    with pytest.raises(SolveError, match=says(f"sample 1 of 9: {REASONS[1]}")):
        given.only()


def test_a_linearisation_that_fails_tells_why() -> None:
    model = response(awkward, code=(-10.0, 10.0), rate=(0.0, 1.0))
    with pytest.raises(SolveError, match=r"^Newton's iteration did not converge at t = "):
        model.linearise(np.array([5.0, 0.5]))
    with pytest.raises(InputError, match=says(REASONS[4])):
        model.linearise(np.array([4.0, 0.5]))


def test_redundant_constraints_are_told_before_the_first_sample() -> None:
    def twice(stiffness: float, rate: float) -> mb.System:
        system = rope(stiffness, rate)
        system.add(mb.RevoluteJoint("again", system.ground, system.bodies[0].point("start")))
        return system

    with pytest.raises(ModelError, match=r"^the constraints are redundant: 6 were given, 4 are independent"):
        response(twice).evaluate(np.array([[3e5, 0.0]]))
