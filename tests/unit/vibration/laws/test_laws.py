"""Laws as compiled functions: derivatives, memory, fast ways, and what is refused."""

from collections.abc import Callable

import numpy as np
import pytest
from inline_snapshot import snapshot

from dalembert.errors import InputError
from dalembert.structure import lumped
from dalembert.vibration import (
    BilinearStop,
    BoucWen,
    CubicSpring,
    ElasticSlider,
    FourParameterIwan,
    FrequencyResponse,
    FrictionContact,
    Gap,
    HarmonicBalance,
    HarmonicForce,
    LawElement,
    StaticForce,
    UserLaw,
    VibrationSystem,
    backbone,
    floquet_multipliers,
    frequency_response,
    law,
)
from dalembert.vibration.balance.equations import equations
from dalembert.vibration.fourier import Fourier
from dalembert.vibration.interface.lowering import lower
from dalembert.vibration.laws.contact_sums import Shape, contact_sums
from dalembert.vibration.laws.friction_law import update
from dalembert.vibration.laws.law_block import LawBlock
from dalembert.vibration.laws.marched_sums import MarchedSums
from refusals import refused

TURN = 2 * np.pi


def drag(u, v, z, numbers, force):
    force[0] = numbers[0] * v[0] * (v[0] if v[0].real > 0 else -v[0])


def relaxing(u, v, z, numbers, force):
    """A spring in series with a slider that creeps after the displacement, a part of the way at each sample."""
    z[0] += numbers[1] * (u[0] - z[0])
    force[0] = numbers[0] * (u[0] - z[0]) + numbers[0] * (u[0] - z[0]) ** 3


def lossy(u, v, z, numbers, force):
    force[0] = numbers[0] * abs(u[0]) * u[0]


@law
def slide(u, v, z, numbers, force):
    """The elastic slider in one direction, under a constant load."""
    update(u, z, force, numbers, 1, False, True)


ELEMENTS: dict[str, Callable[[], LawElement]] = {
    "cubic": lambda: CubicSpring("law", "a.x", "b.x", stiffness=0.8),
    "gap": lambda: Gap("law", "a.x", "b.x", stiffness=3.0, gap=0.1),
    "stop": lambda: BilinearStop("law", "b.x", stiffness=3.0, gap=0.2),
    "bouc-wen": lambda: BoucWen("law", "a.x", stiffness=2.0, ratio=0.1, yield_displacement=0.2),
    "bouc-wen, sharp": lambda: BoucWen(
        "law", "a.x", "b.x", stiffness=2.0, ratio=0.1, yield_displacement=0.2, beta=0.9, gamma=-0.1, exponent=2.5
    ),
    "iwan": lambda: FourParameterIwan("law", "a.x", "b.x", force_limit=0.4, stiffness=2.0, exponent=-0.4, ratio=0.8),
    "drag": lambda: UserLaw("law", "a.x", function=drag, values=[0.4]),
    "relaxing": lambda: UserLaw("law", "a.x", function=relaxing, values=[0.7, 0.05], internal=1),
}


def system(*elements: LawElement | FrictionContact) -> VibrationSystem:
    made = VibrationSystem(lumped({"a.x": 1.0, "b.x": 0.7}, [("a.x", None, 1.0, 0.05), ("a.x", "b.x", 0.8, 0.03)]))
    made.add(HarmonicForce("a.x", 0.3))
    made.add(StaticForce("b.x", 0.05))
    for element in elements:
        made.add(element)
    return made


@pytest.mark.parametrize("name", ELEMENTS)
def test_the_jacobian_is_that_of_differences(name: str) -> None:
    problem = equations(system(ELEMENTS[name]()), HarmonicBalance(harmonics=3, samples=64))
    balance, omega = problem.balance(64), 1.1
    point = problem.condensation.at(omega)
    unknowns = np.random.default_rng(4).normal(size=balance.shape) * 0.2
    evaluation, tangent = balance.linearised(point, unknowns)
    scale = np.abs(tangent.matrix).max()
    np.testing.assert_allclose(balance.at(point, unknowns).residual, evaluation.residual, atol=1e-13 * scale)

    def residual(omega: float, moved: np.ndarray) -> np.ndarray:
        return balance.at(problem.condensation.at(omega), moved).residual.ravel()

    steps = 1e-6 * np.eye(unknowns.size).reshape(-1, *unknowns.shape)
    differences = np.array([(residual(omega, unknowns + h) - residual(omega, unknowns - h)) / 2e-6 for h in steps]).T
    np.testing.assert_allclose(tangent.matrix, differences, atol=2e-6 * scale)
    slope = (residual(omega + 1e-6, unknowns) - residual(omega - 1e-6, unknowns)) / 2e-6
    np.testing.assert_allclose(tangent.slope.ravel(), slope, atol=1e-7 * scale)


def test_all_elements_together_lead_to_a_jacobian_by_structure_as_to_a_dense_one(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    from dalembert.vibration.balance import balance as module

    parts = ELEMENTS["drag"](), FourParameterIwan("other", "b.x", force_limit=0.4, stiffness=2, exponent=-0.4, ratio=1)
    problem = equations(system(*parts), HarmonicBalance(harmonics=3, samples=64))
    point, unknowns = problem.condensation.at(1.1), np.random.default_rng(1).normal(size=(2, 7)) * 0.2
    right = np.random.default_rng(2).normal(size=(2, 7, 2))
    _, dense = problem.balance(64).linearised(point, unknowns)
    monkeypatch.setattr(module, "LARGE", 0)
    _, blocks = problem.balance(64).linearised(point, unknowns)
    assert type(blocks) is not type(dense)
    np.testing.assert_allclose(blocks.solve(right), dense.solve(right), rtol=1e-9)
    np.testing.assert_allclose(blocks.slope, dense.slope, rtol=1e-12)


@pytest.mark.parametrize("name", ["gap", "stop"])
def test_stops_by_samples_come_to_their_sums_with_events(name: str) -> None:
    (block,) = lower(system(ELEMENTS[name]())).real.laws
    displacements = np.array([[[0.1, 0.4, 0.1, 0.02, 0.05]]])
    exact, jacobian, _ = block.sums(Fourier((0, 1, 2), 4096)).with_slopes(displacements, 1.0)
    plain, slopes, _ = block.sums(Fourier((0, 1, 2), 4096), events=False).with_slopes(displacements, 1.0)
    np.testing.assert_allclose(plain, exact, atol=1e-6)
    np.testing.assert_allclose(slopes, jacobian, atol=2e-3)
    assert np.abs(slopes - jacobian).max() > 1e-6  # two ways


def test_a_slider_as_a_general_law_is_the_built_in_one() -> None:
    series = Fourier((0, 1, 3), 128)
    contact = FrictionContact("slider", "a", friction=0.5, preload=0.6, law=ElasticSlider(2.0))
    (own,) = lower(system(contact)).real.blocks
    sums = MarchedSums(
        LawBlock(UserLaw("slider", "a.x", function=slide, internal=1), ("slider",), own.rows, own.numbers),
        series,
        events=False,
    )
    problem = equations(system(contact), HarmonicBalance(harmonics=1, events=False))
    unknowns = np.array([[0.1, 0.5, 0.2, 0.1, -0.1]])
    built_in = problem.balance(128)
    force, _, jacobian = contact_sums(own.numbers, Shape(1, False, True), series, False).with_slopes(unknowns[None])
    general, slopes, _ = sums.with_slopes(unknowns[None], 1.0)
    np.testing.assert_allclose(general, force, atol=1e-14)
    np.testing.assert_allclose(slopes, jacobian, atol=1e-12)
    assert built_in.series.samples == 128


def sliding(u, v, z, numbers, force):
    """A spring in series with a slider."""
    force[0] = numbers[0] * (u[0] - z[0])
    if force[0].real > numbers[1].real:
        force[0] = numbers[1]
    elif force[0].real < -numbers[1].real:
        force[0] = -numbers[1]
    z[0] = u[0] - force[0] / numbers[0]


def slip_or_turn(u, v, z, numbers, values):
    values[0] = v[0]
    values[1] = numbers[0] * (u[0] - z[0]) - numbers[1]
    values[2] = numbers[0] * (u[0] - z[0]) + numbers[1]


def touching(u, v, z, numbers, force):
    over = u[0] - numbers[1]
    force[0] = numbers[0] * over if over.real > 0.0 else 0.0 * over


def touch(u, v, z, numbers, values):
    values[0] = u[0] - numbers[1]


SLIDER = UserLaw("slider", "a.x", function=sliding, values=[2.0, 0.3], internal=1, events=slip_or_turn, event_count=3)
STOP = UserLaw("stop", "a.x", function=touching, values=[3.0, 0.1], events=touch, event_count=1)


@pytest.mark.parametrize(
    ("own", "built_in", "exact"),
    [
        (SLIDER, FrictionContact("slider", "a", friction=0.5, preload=0.6, law=ElasticSlider(2.0)), 1e-7),
        (STOP, Gap("stop", "a.x", stiffness=3.0, gap=0.1), 1e-7),
    ],
)
def test_a_law_with_events_has_the_sums_of_the_built_in_one(own: UserLaw, built_in: object, exact: float) -> None:
    """Those of the built-in one with 4096 samples, with 64."""
    unknowns = np.array([[0.1, 0.5, 0.2, 0.1, -0.1]])
    few, many = Fourier((0, 1, 3), 64), Fourier((0, 1, 3), 4096)
    (block,) = lower(system(own)).real.laws
    force, jacobian, _ = block.sums(few).with_slopes(unknowns[None], 1.0)
    lowered = lower(system(built_in)).real  # type: ignore[arg-type]
    if lowered.laws:
        expected, slopes, _ = lowered.laws[0].sums(many).with_slopes(unknowns[None], 1.0)
    else:
        expected, _, slopes = contact_sums(lowered.blocks[0].numbers, Shape(1, False, True), many, True).with_slopes(
            unknowns[None]
        )
    plain = block.sums(few, events=False).forces(unknowns[None], 1.0)
    error = np.abs(force - expected).max()
    assert error < exact
    assert error < 0.01 * np.abs(plain - expected).max()
    np.testing.assert_allclose(jacobian, slopes, atol=1e-4)


@pytest.mark.parametrize("own", [SLIDER, STOP])
def test_the_jacobian_with_events_is_that_of_differences(own: UserLaw) -> None:
    (block,) = lower(system(own)).real.laws
    sums, unknowns = block.sums(Fourier((0, 1, 3), 64)), np.array([0.1, 0.5, 0.2, 0.1, -0.1])
    _, jacobian, _ = sums.with_slopes(unknowns[None, None], 1.0)
    step = 1e-6 * np.eye(5)
    differences = [(sums.forces((unknowns + h)[None, None], 1.0) - sums.forces((unknowns - h)[None, None], 1.0)) / 2e-6
                   for h in step]  # fmt: skip
    np.testing.assert_allclose(jacobian[0], np.array(differences)[:, 0, 0].T, atol=1e-8)


def iwan_force(path: list[float], element: FourParameterIwan) -> float:
    """Force after a path of displacements from rest, sampled finely."""
    fine = np.concatenate([np.linspace(a, b, 50) for a, b in zip([0.0, *path], path, strict=False)])
    z, force = np.zeros(element.states, complex), np.zeros(1, complex)
    numbers = np.array(list(element.numbers.values()), complex)
    for u in fine:
        element.law(np.array([u], complex), np.zeros(1, complex), z, numbers, force)
    return float(force[0].real)


def test_turns_that_a_larger_motion_passes_are_forgotten() -> None:
    element = FourParameterIwan("joint", "a.x", force_limit=1.0, stiffness=2.0, exponent=-0.3, ratio=0.5)

    def first(u: float) -> float:
        return float(np.real(element.stiffness * u - element.numbers["softening"] * u ** (element.exponent + 2)))

    assert iwan_force([0.3], element) == pytest.approx(first(0.3), rel=1e-12)
    assert iwan_force([0.3, 0.1], element) == pytest.approx(first(0.3) - 2 * first(0.1), rel=1e-12)
    nested = iwan_force([0.3, -0.1, 0.2, 0.0, 0.1, 0.05, 0.25], element)
    assert nested == pytest.approx(iwan_force([0.3, -0.1, 0.25], element), rel=1e-12)
    assert iwan_force([0.3, -0.1, 0.35], element) == pytest.approx(first(0.35), rel=1e-12)
    assert iwan_force([0.3, -0.1, -0.35], element) == pytest.approx(-first(0.35), rel=1e-12)
    assert iwan_force([5.0], element) == pytest.approx(1.0, rel=1e-12)
    assert iwan_force([5.0, -5.0], element) == pytest.approx(-1.0, rel=1e-12)


def test_more_turns_than_are_kept_change_little() -> None:
    element = FourParameterIwan("joint", "a.x", force_limit=1.0, stiffness=2.0, exponent=-0.3, ratio=0.5)
    sizes = 0.3 * 0.9 ** np.arange(40)
    path = [float(size * (-1) ** k) for k, size in enumerate(sizes)]
    assert abs(iwan_force(path, element)) < 0.05
    assert iwan_force([*path, 0.31], element) == pytest.approx(iwan_force([0.31], element), rel=1e-12)


def bouc_wen(stiffness: float, exponent: float) -> VibrationSystem:
    return system(BoucWen("mount", "a.x", stiffness=stiffness, ratio=0.1, yield_displacement=0.1, exponent=exponent))


def joint(limit: float, exponent: float) -> VibrationSystem:
    return system(
        FourParameterIwan("joint", "a.x", "b.x", force_limit=limit, stiffness=2.0, exponent=exponent, ratio=0.5)
    )


def damped(drag_number: float, stiffness: float) -> VibrationSystem:
    return system(
        UserLaw("water", "a.x", function=drag, values=[drag_number]), CubicSpring("c", "b.x", stiffness=stiffness)
    )


@pytest.mark.parametrize(
    ("build", "bounds"),
    [
        (bouc_wen, {"stiffness": (0.5, 1.5), "exponent": (1.2, 2.5)}),
        (joint, {"limit": (0.1, 0.3), "exponent": (-0.8, -0.2)}),
        (damped, {"drag_number": (0.1, 0.5), "stiffness": (0.1, 0.5)}),
    ],
)
def test_sensitivities_by_the_numbers_of_laws_are_those_of_differences(build: Callable, bounds: dict) -> None:
    places = np.array([0.1, 0.15])
    model = FrequencyResponse(build, bounds, ["a.x peak", "b.x peak"], places, HarmonicBalance(5, samples=256))
    vector = model.parameters.start
    jacobian = model.jacobian(vector)
    for column, scale in enumerate(model.parameters.scale):
        step = 1e-5 * scale * np.eye(2)[column]
        up, down = model.evaluate(np.stack([vector + step, vector - step])).values
        np.testing.assert_allclose(
            jacobian[..., column] * scale, (up - down) / 2e-5, atol=2e-5 * np.abs(jacobian * scale).max()
        )


def test_a_mode_with_a_law_that_dissipates_is_damped_by_it() -> None:
    free = backbone(joint(0.3, -0.5), np.array([0.02, 0.1]), method=HarmonicBalance(5, samples=256))
    assert free.converged.all()
    assert free.damping[1] > free.damping[0] > 0


def test_multipliers_have_none_of_the_states_that_nothing_changes() -> None:
    curve = frequency_response(joint(0.3, -0.5), np.array([0.12]), HarmonicBalance(5, samples=256))
    sizes = np.abs(floquet_multipliers(joint(0.3, -0.5), curve, 0))
    assert len(sizes) < 8
    assert np.all(sizes < 0.999)


def test_odd_harmonics_suffice_where_opposite_displacements_have_opposite_forces() -> None:
    made = VibrationSystem(lumped({"a.x": 1.0}, [("a.x", None, 1.0, 0.05)]))
    made.add(HarmonicForce("a.x", 0.3))
    made.add(FourParameterIwan("joint", "a.x", force_limit=0.4, stiffness=2.0, exponent=-0.4, ratio=0.8))
    odd = frequency_response(made, np.array([0.2]), HarmonicBalance(7, odd_only=True))
    every = frequency_response(made, np.array([0.2]), HarmonicBalance(7))
    np.testing.assert_allclose(odd.amplitude("a.x"), every.amplitude("a.x"), rtol=1e-7)
    made.add(Gap("stop", "a.x", stiffness=1.0, gap=1e-3))
    with refused(
        InputError,
        snapshot(
            "HarmonicBalance: odd_only=True, but the element 'stop' causes a mean or even harmonics; use odd_only=False"
        ),
    ):
        frequency_response(made, np.array([0.2]), HarmonicBalance(7, odd_only=True))


def test_elements_of_one_law_are_one_block() -> None:
    parts = [CubicSpring(f"c{k}", "a.x", stiffness=1.0 + k) for k in range(3)]
    (block,) = lower(system(*parts)).laws
    assert isinstance(block, LawBlock)
    assert block.numbers.tolist() == [[1.0], [2.0], [3.0]]
    assert block.names == ("c0", "c1", "c2")


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (
            lambda: UserLaw("w", "a.x", function=lambda u: u),
            snapshot("law '<lambda>': the function takes 1 arguments; expected u, v, z, numbers, force"),
        ),
        (
            lambda: UserLaw("w", "a.x"),
            snapshot("UserLaw 'w': function is missing; give a Python function(u, v, z, numbers, force)"),
        ),
        (
            lambda: UserLaw("w", "a.x", function=drag, values=[np.nan]),
            snapshot("UserLaw 'w': values is [nan]; expected a list of finite numbers"),
        ),
        (
            lambda: UserLaw("w", "a.x", function=drag, internal=-1),
            snapshot("UserLaw 'w': internal is -1; expected zero or a positive whole number"),
        ),
        (
            lambda: law(3),  # type: ignore[arg-type]
            snapshot(
                "the function of a law is 3; expected a Python function(u, v, z, numbers, force) that writes the forces"
            ),
        ),
        (
            lambda: BoucWen("m", "a.x", stiffness=1.0, yield_displacement=-1.0),
            snapshot("BoucWen 'm': yield_displacement is -1 m; expected a positive number"),
        ),
        (
            lambda: BoucWen("m", "a.x", stiffness=1.0, yield_displacement=1.0, ratio=2.0),
            snapshot("BoucWen 'm': ratio is 2; expected a number from 0 to 1"),
        ),
        (
            lambda: BoucWen("m", "a.x", stiffness=1.0, yield_displacement=1.0, exponent=0.5),
            snapshot("BoucWen 'm': exponent is 0.5; expected a number of at least 1"),
        ),
        (
            lambda: BoucWen("m", "a.x", stiffness=1.0, yield_displacement=1.0, beta=0.1, gamma=0.5),
            snapshot("BoucWen 'm': beta is 0.1 and gamma is 0.5; expected beta + gamma > 0 and beta at least |gamma|"),
        ),
        (
            lambda: FourParameterIwan("j", "a.x", force_limit=1, stiffness=1, exponent=0.5, ratio=1),
            snapshot("FourParameterIwan 'j': exponent is 0.5; expected a number above -1 and at most 0"),
        ),
        (
            lambda: FourParameterIwan("j", "a.x", force_limit=0, stiffness=1, exponent=-0.5, ratio=1),
            snapshot("FourParameterIwan 'j': force_limit is 0 N; expected a positive number"),
        ),
    ],
)
def test_what_cannot_be_meant_is_refused(make: Callable, message: str) -> None:
    with refused(InputError, message):
        make()


def test_a_law_that_drops_the_imaginary_part_is_refused() -> None:
    wrong = system(UserLaw("mine", "a.x", function=lossy, values=[0.4]))
    with pytest.raises(InputError, match=r"^element 'mine': the derivative of its force"):
        frequency_response(wrong, np.array([0.1]), HarmonicBalance(3))


def growing(u, v, z, numbers, force):
    """Forces that are not finite at large displacements."""
    force[0] = numbers[0] * u[0] ** 3 + z[0]
    z[0] = force[0] * numbers[0]


def test_trials_beyond_what_a_law_is_for_cause_no_warnings() -> None:
    system = VibrationSystem(lumped({"a": 1.0}, [("a", None, 1.0, 0.1)]))
    system.add(HarmonicForce("a", 1.0))
    system.add(UserLaw("law", "a", function=growing, values=[2.0], internal=1))
    problem = equations(system, HarmonicBalance(3))
    (block,) = problem.lowered.laws
    sums = block.sums(problem.balance(64).series)
    assert isinstance(sums, MarchedSums)
    moved = np.full((1, 1, 7), 1e3)
    assert not np.all(np.isfinite(sums.forces(moved, 1.0)))
    assert not np.all(np.isfinite(sums.with_slopes(moved, 1.0)[0]))
