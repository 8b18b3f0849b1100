"""The balance by receptances, against that by dynamic stiffnesses, and its Jacobian against differences."""

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

from dalembert.errors import InputError, SolveError
from dalembert.structure import Dofs, Structure, lumped
from dalembert.vibration import (
    BilinearStop,
    BoucWen,
    CubicSpring,
    ElasticSlider,
    FrequencyResponse,
    FrictionContact,
    Gap,
    HarmonicBalance,
    HarmonicForce,
    Iwan,
    Rigid,
    StaticForce,
    UserElement,
    UserLaw,
    VibrationSystem,
    floquet_multipliers,
    frequency_response,
)
from dalembert.vibration.balance.equations import equations
from dalembert.vibration.balance.receptance_balance import ReceptanceBalance
from dalembert.vibration.balance.receptance_tangent import ReceptanceTangent
from dalembert.vibration.interface.receptances import ReceptancePoint

Fill = Callable[[VibrationSystem], None]
BY_RECEPTANCES = HarmonicBalance(3, samples=64, solver="receptance", tolerance=1e-12)
PLAIN = replace(BY_RECEPTANCES, events=False)


def structure(damping: str = "general", held: bool = True) -> Structure:
    """Three nodes with three directions each; without ``held`` only contacts hold the last one."""
    rng = np.random.default_rng(1)
    names = tuple(f"{node}.{axis}" for node in "abc" for axis in "xyz")
    root = rng.normal(size=(9, 9))
    stiffness, mass = root @ root.T + 5 * np.eye(9), np.diag(rng.uniform(1, 2, 9))
    if not held:
        stiffness[6:], stiffness[:, 6:] = 0.0, 0.0
    kinds = {
        "general": {"damping": 0.1 * np.eye(9) + 0.02 * stiffness + np.diag([0.4, *[0.0] * 8])},
        "proportional": {"damping": 0.1 * mass},
        "hysteretic": {"damping": 0.05 * mass, "loss": 0.04 * stiffness},
    }
    return Structure(mass, stiffness, Dofs(names), **kinds[damping])


def laws(to: VibrationSystem) -> None:
    """Laws of all sorts, two of them at one degree of freedom."""
    to.add(CubicSpring("cubic", "a.x", "b.x", stiffness=3.0))
    to.add(Gap("gap", "a.x", stiffness=2.0, gap=0.1))
    to.add(BilinearStop("stop", "b.x", stiffness=2.0, gap=0.1))
    to.add(BoucWen("hysteresis", "c.y", stiffness=2.0, ratio=0.2, yield_displacement=0.3, beta=0.7, gamma=0.3))
    to.add(UserElement("user", ["a.x", "b.y"], lambda u: np.stack([u[0] * u[1] ** 2, u[0] ** 2 * u[1]])))
    to.add(UserLaw("drag", "c.z", function=drag, values=[0.3]))


def drag(u, v, z, numbers, force):
    """Force by the square of the velocity."""
    force[0] = numbers[0] * v[0] * (v[0] if v[0].real > 0 else -v[0])


def contacts(to: VibrationSystem) -> None:
    """Contacts in one and two directions, with constant and with varying load, some of them open."""
    to.add(FrictionContact("single", "a", friction=0.4, preload=1.0, law=ElasticSlider(3.0)))
    pressed = {"tangential": ("x", "y"), "normal": "-z", "friction": 0.4}
    to.add(FrictionContact("pair", "a", "b", preload=0.4, law=ElasticSlider(3.0, 4.0, 0.02), **pressed))
    to.add(FrictionContact("open", "c", "b", law=ElasticSlider(2.0, 3.0, 0.15), **pressed))
    cells = Iwan((1.0, 4.0), (0.4, 0.6), 2.0)
    to.add(FrictionContact("cells", "c", tangential=("y",), normal="z", friction=0.3, preload=0.5, law=cells))


def everything(to: VibrationSystem) -> None:
    laws(to)
    contacts(to)


def system(fill: Fill, damping: str = "general", held: bool = True) -> VibrationSystem:
    result = VibrationSystem(structure(damping, held))
    result.add(HarmonicForce("c.x", 3.0, 0.3))
    result.add(HarmonicForce("a.y", 2.0, -0.5, harmonic=2))
    result.add(StaticForce("b.z", 0.5))
    fill(result)
    return result


CASES = [(contacts, "general"), (contacts, "proportional"), (contacts, "hysteretic"), (laws, "general")]


@pytest.mark.parametrize("method", [BY_RECEPTANCES, PLAIN], ids=["events", "plain"])
@pytest.mark.parametrize(("fill", "damping"), [*CASES, (everything, "general")])
def test_motions_are_those_by_dynamic_stiffnesses(fill: Fill, damping: str, method: HarmonicBalance):
    posed, frequencies = system(fill, damping), np.array([0.3, 0.36])
    curve = frequency_response(posed, frequencies, method, check=False)
    other = frequency_response(posed, frequencies, replace(method, solver="stiffness"), check=False)
    assert curve.converged.all()
    for name in ("response", "displacements", "forces"):
        np.testing.assert_allclose(getattr(curve, name), getattr(other, name), rtol=0, atol=1e-9)
    np.testing.assert_array_equal(curve.states, other.states)
    assert curve.provenance["method"]["solver"] == "receptance"


def test_odd_harmonics_alone_are_those_by_dynamic_stiffnesses():
    posed = VibrationSystem(structure())
    posed.add(HarmonicForce("c.x", 3.0))
    posed.add(FrictionContact("single", "a", "b", ("x", "y"), friction=0.4, preload=1.0, law=ElasticSlider(3.0)))
    method = replace(BY_RECEPTANCES, odd_only=True)
    curve, other = (
        frequency_response(posed, np.array([0.3]), replace(method, solver=solver), check=False)
        for solver in ("receptance", "stiffness")
    )
    np.testing.assert_allclose(curve.response, other.response, rtol=0, atol=1e-10)


def test_a_part_that_only_contacts_hold_is_an_ordinary_one():
    posed = VibrationSystem(structure("proportional", held=False))
    posed.add(HarmonicForce("a.x", 3.0))
    posed.add(StaticForce("c.z", 20.0))
    for axis in "xy":
        posed.add(CubicSpring(f"soft {axis}", f"c.{axis}", stiffness=0.2))
    law = ElasticSlider(3.0, 4.0)
    posed.add(FrictionContact("foot", "c", "a", ("x", "y"), "z", friction=0.4, law=law))
    posed.add(FrictionContact("ground", "a", None, ("x", "y"), "z", friction=0.4, preload=30.0, law=law))
    curve, other = (
        frequency_response(posed, np.linspace(0.25, 0.4, 3), replace(BY_RECEPTANCES, solver=solver), check=False)
        for solver in ("receptance", "stiffness")
    )
    assert curve.converged.all()
    np.testing.assert_allclose(curve.response, other.response, rtol=0, atol=1e-8)


def point_of(fill: Fill, damping: str) -> tuple[ReceptanceBalance, ReceptancePoint, np.ndarray]:
    problem = equations(system(fill, damping), BY_RECEPTANCES)
    balance, point = problem.balance(64), problem.at(2.0)
    assert isinstance(balance, ReceptanceBalance)
    assert isinstance(point, ReceptancePoint)
    return balance, point, point.linear + 0.05 * np.random.default_rng(3).normal(size=balance.shape)


@pytest.mark.parametrize("damping", ["general", "proportional", "hysteretic"])
def test_the_jacobian_is_that_of_differences(damping: str):
    balance, point, place = point_of(everything, damping)
    _, tangent = balance.linearised(point, place)
    direction = np.random.default_rng(4).normal(size=place.shape)
    step = 1e-6
    ahead, behind = (balance.at(point, place + sign * step * direction).residual for sign in (1, -1))
    # J⁻¹ (J d) = d.
    np.testing.assert_allclose(
        tangent.solve(((ahead - behind) / (2 * step))[:, :, None])[:, :, 0], direction, rtol=0, atol=2e-7
    )


def test_the_slope_by_frequency_is_that_of_differences():
    problem = equations(system(everything, "general"), BY_RECEPTANCES)
    balance, point, place = point_of(everything, "general")
    step = 1e-6
    ahead, behind = (balance.at(problem.at(2.0 + sign * step), place).residual for sign in (1, -1))  # type: ignore[arg-type]
    slope = balance.linearised(point, place)[1].slope
    np.testing.assert_allclose(slope, (ahead - behind) / (2 * step), rtol=0, atol=1e-7)


def test_iterations_and_the_dense_matrix_solve_the_same_system(monkeypatch: pytest.MonkeyPatch):
    balance, point, place = point_of(everything, "general")
    right = np.random.default_rng(5).normal(size=(*place.shape, 2))
    dense = balance.linearised(point, place)[1].solve(right)
    monkeypatch.setattr("dalembert.vibration.balance.receptance_tangent.DIRECT", 0)
    exact, coarse = (balance.linearised(point, place)[1].solve(right, tolerance) for tolerance in (1e-12, 1e-3))
    np.testing.assert_allclose(exact, dense, rtol=0, atol=1e-9 * np.abs(dense).max())
    np.testing.assert_allclose(coarse, dense, rtol=0, atol=2e-2 * np.abs(dense).max())


def test_the_solution_does_not_depend_on_the_reference():
    problem = equations(system(contacts), BY_RECEPTANCES)
    known = problem.first(2.0)
    other = equations(system(contacts), BY_RECEPTANCES)
    other.contacts_stuck.reference = 0.7 * problem.contacts_stuck.reference + 0.1
    found = other.first(2.0)
    assert known.converged
    assert found.converged
    np.testing.assert_allclose(found.unknowns, known.unknowns, rtol=0, atol=1e-10)


def test_contacts_that_the_static_forces_leave_open_have_no_reference():
    reference = equations(system(contacts), BY_RECEPTANCES).contacts_stuck.reference
    names = equations(system(contacts), BY_RECEPTANCES).lowered.row_names
    stiffnesses = dict(zip(names, reference.tolist(), strict=True))
    assert stiffnesses["open.x"] == stiffnesses["open.z"] == 0.0
    assert stiffnesses["pair.x"] == 3.0
    assert stiffnesses["pair.z"] == 4.0
    assert stiffnesses["cells.y"] == 5.0


def hardening() -> VibrationSystem:
    """Two masses with a stiff spring that bends the resonance, and a slider."""
    springs = [("m1", None, 1.0, 0.03), ("m1", "m2", 1.0, 0.03)]
    posed = VibrationSystem(lumped({"m1": 1.0, "m2": 1.0}, springs))
    posed.add(HarmonicForce("m1", 0.2))
    posed.add(CubicSpring("cubic", "m1", stiffness=0.5))
    posed.add(FrictionContact("slider", "m2", friction=0.5, preload=0.1, law=ElasticSlider(0.4)))
    return posed


def test_paths_go_past_folds_as_those_by_dynamic_stiffnesses():
    ends = (0.1, 0.22)
    curve, other = (
        frequency_response(hardening(), ends, HarmonicBalance(7, solver=solver), continuation="arc-length", check=False)
        for solver in ("receptance", "stiffness")
    )
    assert curve.fold.sum() == other.fold.sum() == 2
    np.testing.assert_allclose(curve.frequencies[curve.fold], other.frequencies[other.fold], rtol=1e-6)
    np.testing.assert_allclose(curve.amplitude("m1").max(), other.amplitude("m1").max(), rtol=1e-3)


def test_a_curve_is_used_by_what_needs_dynamic_stiffnesses():
    posed = system(everything, "general")
    curve, other = (
        frequency_response(posed, np.array([0.3]), replace(BY_RECEPTANCES, solver=solver), check=False)
        for solver in ("receptance", "stiffness")
    )
    np.testing.assert_allclose(floquet_multipliers(posed, curve, 0), floquet_multipliers(posed, other, 0), atol=1e-7)
    begun = frequency_response(posed, np.array([0.3]), replace(BY_RECEPTANCES, solver="stiffness"), start=(curve, 0))
    again = frequency_response(posed, np.array([0.3]), BY_RECEPTANCES, start=(other, 0))
    np.testing.assert_allclose(begun.response, again.response, atol=1e-9)


@pytest.mark.parametrize(
    ("prediction", "more", "words"),
    [
        ("velocity", {}, "is rigid and predicts velocities"),
        ("displacement", {"stability": True}, "is rigid"),
    ],
)
def test_rigid_contacts_that_need_dynamic_stiffnesses(prediction: str, more: dict[str, bool], words: str):
    posed = hardening()
    posed.add(FrictionContact("heel", "m1", friction=0.5, preload=0.1, law=Rigid(prediction=prediction)))
    with pytest.raises(InputError) as error:
        frequency_response(posed, np.array([0.1]), HarmonicBalance(3, solver="receptance"), **more)
    assert str(error.value) == (
        f"HarmonicBalance: solver is 'receptance', but the contact 'heel' {words}, which needs dynamic stiffnesses. "
        "Use solver='stiffness'"
    )


def rigid_contacts(to: VibrationSystem) -> None:
    """Rigid contacts in one and two directions, with constant and with varying load, beside an elastic one."""
    to.add(FrictionContact("line", "a", friction=0.4, preload=0.8, law=Rigid()))
    sides = {"tangential": ("x", "y"), "friction": 0.4}
    to.add(FrictionContact("pair", "a", "b", preload=0.4, normal="-z", law=Rigid(gap=0.02), **sides))
    to.add(FrictionContact("plane", "c", "b", preload=0.4, law=Rigid(), **sides))
    to.add(FrictionContact("elastic", "c", tangential=("z",), friction=0.4, preload=0.5, law=ElasticSlider(3.0)))


def test_rigid_contacts_move_as_by_dynamic_stiffnesses():
    posed, frequencies = system(rigid_contacts), np.array([0.3, 0.36, 0.42])
    curve, other = (
        frequency_response(posed, frequencies, replace(BY_RECEPTANCES, solver=solver), check=False)
        for solver in ("receptance", "stiffness")
    )
    assert curve.converged.all()
    assert other.converged.all()
    assert {1, 2} <= set(np.unique(curve.states))
    for name in ("response", "displacements", "forces"):
        np.testing.assert_allclose(getattr(curve, name), getattr(other, name), rtol=0, atol=1e-8)
    # Each starts from a point of the other, where nothing is left to do.
    for begun, method in ((other, BY_RECEPTANCES), (curve, replace(BY_RECEPTANCES, solver="stiffness"))):
        again = frequency_response(posed, frequencies[[1]], method, start=(begun, 1), check=False)
        assert again.iterations[0] <= 1


@pytest.mark.parametrize("direct", [120, 0], ids=["dense", "iterated"])
def test_the_tangent_of_rigid_contacts_is_that_of_differences(direct: int, monkeypatch):
    monkeypatch.setattr("dalembert.vibration.balance.receptance_tangent.DIRECT", direct)
    balance, point, place = point_of(rigid_contacts, "general")
    tangent = balance.linearised(point, place)[1]
    chance = np.random.default_rng(3).normal(size=place.shape)
    step = 1e-7
    moved = [balance.at(point, place + sign * step * chance).residual for sign in (1, -1)]
    difference = (moved[0] - moved[1]) / (2 * step)
    solved = tangent.solve(difference[:, :, None], 1e-12)[:, :, 0]
    np.testing.assert_allclose(solved, chance, rtol=0, atol=1e-5)


def row_of_masses(count: int) -> VibrationSystem:
    names = [f"m{k}" for k in range(count)]
    # Damping in proportion to the mass couples no modes.
    springs = [(names[k], names[k + 1], 1.0, 0.0) for k in range(count - 1)] + [
        (name, None, 0.1, 0.02) for name in names
    ]
    posed = VibrationSystem(lumped(dict.fromkeys(names, 1.0), springs))
    posed.add(HarmonicForce(names[-1], 1.0))
    for name in names:
        posed.add(FrictionContact(f"on {name}", name, friction=0.5, preload=0.1, law=ElasticSlider(0.4)))
    return posed


@pytest.mark.parametrize(
    ("count", "more", "solver"),
    [(10, {}, "stiffness"), (70, {}, "receptance"), (70, {"stability": True}, "receptance")],
)
def test_the_solver_is_chosen_by_the_unknowns(count: int, more: dict[str, bool], solver: str):
    curve = frequency_response(row_of_masses(count), np.array([0.05]), HarmonicBalance(4), check=False, **more)
    assert curve.provenance["method"]["solver"] == solver
    assert curve.converged.all()


def test_the_tangent_of_stuck_contacts_is_the_identity():
    _, point, place = point_of(contacts, "general")
    tangent = ReceptanceTangent(point, np.zeros_like(place), ())
    np.testing.assert_array_equal(tangent.solve(place[:, :, None])[:, :, 0], place)
    assert tangent.sign == 1.0


def parametrised(
    inertia: float, spring: float, dashpot: float, friction: float, load: float, contact: float, gap: float,
    drag_of: float, cubic: float, push: float,
) -> VibrationSystem:  # fmt: skip
    """A system each of whose parts has a parameter."""
    whole = structure()
    mass, stiffness = whole.mass * (1 + inertia), whole.stiffness + spring * np.diag([0.0, 1.0, *[0.0] * 7])
    own = Structure(mass, stiffness, whole.dofs, whole.damping + dashpot * np.diag([*[0.0] * 4, 1.0, *[0.0] * 4]))
    result = VibrationSystem(own)
    result.add(HarmonicForce("c.x", push, 0.3))
    result.add(StaticForce("b.z", 0.5))
    law = ElasticSlider(contact, 4.0, gap)
    sides = {"tangential": ("x", "y"), "normal": "-z"}
    result.add(FrictionContact("pair", "a", "b", **sides, friction=friction, preload=load, law=law))
    cells = Iwan((1.0, 4.0), (0.4, 0.6), 2.0)
    result.add(FrictionContact("cells", "c", tangential=("y",), friction=friction, preload=1.0, law=cells))
    result.add(UserLaw("drag", "c.z", function=drag, values=[drag_of]))
    result.add(UserElement("user", ["a.x"], lambda u: cubic * u**3))
    result.add(FrictionContact("rigid", "b", tangential=("y",), friction=friction, preload=0.5, law=Rigid()))
    return result


STARTS = {
    "inertia": 0.1, "spring": 0.5, "dashpot": 0.2, "friction": 0.4, "load": 0.5, "contact": 3.0, "gap": 0.02,
    "drag_of": 0.3, "cubic": 0.2, "push": 3.0,
}  # fmt: skip


@pytest.mark.parametrize("method", [BY_RECEPTANCES, PLAIN], ids=["events", "plain"])
def test_sensitivities_are_those_by_dynamic_stiffnesses(method: HarmonicBalance):
    ranges = {name: (0.9 * value, 1.1 * value) for name, value in STARTS.items()}
    values, slopes = zip(
        *(
            FrequencyResponse(
                parametrised,
                ranges,
                ["a.x harmonic 1", "c.y harmonic 3", "b.z rms"],
                [0.3, 0.36],
                replace(method, solver=solver),
            ).linearise(np.array(list(STARTS.values())))
            for solver in ("receptance", "stiffness")
        ),
        strict=True,
    )
    np.testing.assert_allclose(values[0], values[1], rtol=0, atol=1e-10)
    np.testing.assert_allclose(slopes[0], slopes[1], rtol=0, atol=1e-8 * np.abs(slopes[1]).max())


def test_samples_that_share_a_structure_do_not_depend_on_their_order():
    def joint(friction: float) -> VibrationSystem:
        return parametrised(**{**STARTS, "friction": friction})

    def model() -> FrequencyResponse:
        return FrequencyResponse(joint, {"friction": (0.2, 0.6)}, ["a.x peak"], [0.3], BY_RECEPTANCES)

    both = model().evaluate(np.array([[0.3], [0.5]])).values
    np.testing.assert_array_equal(model().evaluate(np.array([[0.5], [0.3]])).values, both[::-1])


def test_large_forces_begin_without_contacts():
    posed = hardening()
    problem = equations(posed, BY_RECEPTANCES)
    balance, point = problem.balance(64), problem.at(1.0)
    assert isinstance(balance, ReceptanceBalance)
    assert isinstance(point, ReceptancePoint)
    bare = VibrationSystem(posed.structure)
    bare.add(HarmonicForce("m1", 0.2))
    expected = frequency_response(bare, np.array([1.0]) / (2 * np.pi), HarmonicBalance(3), check=False).response[0]
    np.testing.assert_allclose(balance.without_contacts(point), expected[[0, 1]], rtol=0, atol=1e-7)


def sliding_block(bias: float = 0.0) -> VibrationSystem:
    """A mass on a driven one that only friction ties to it, and which slips all the time."""
    posed = VibrationSystem(lumped({"base": 1.0, "block": 0.5}, [("base", None, 4.0, 0.1)]))
    posed.add(HarmonicForce("base", 5.0))
    if bias:
        posed.add(StaticForce("block", bias))
    for name in ("left", "right"):
        posed.add(FrictionContact(name, "block", "base", friction=0.5, preload=0.2, law=ElasticSlider(20.0)))
    return posed


@pytest.mark.parametrize("direct", [0, 120])
def test_the_mean_of_a_part_that_slips_all_the_time_is_supported(direct: int, monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setattr("dalembert.vibration.balance.receptance_tangent.DIRECT", direct)
    frequencies = np.array([0.3, 0.32, 0.34])
    curve, other = (
        frequency_response(sliding_block(), frequencies, HarmonicBalance(7, solver=solver), check=False)
        for solver in ("receptance", "stiffness")
    )
    assert curve.converged.all()
    problem = equations(sliding_block(), HarmonicBalance(7, solver="receptance"))
    tangent = problem.first(2 * np.pi * 0.3).tangent
    assert tangent.unresisted.shape == (2, 1)
    np.testing.assert_allclose(curve.amplitude("base"), other.amplitude("base"), rtol=1e-8)
    np.testing.assert_allclose(curve.forces[:, :, 1:], other.forces[:, :, 1:], rtol=0, atol=1e-8)


def test_a_mean_force_that_no_contact_balances_is_the_finding():
    curve = frequency_response(
        sliding_block(0.3), np.array([0.3]), HarmonicBalance(7, solver="receptance"), check=False
    )
    assert not curve.converged.any()
    assert [finding.code for finding in curve.findings] == ["unbalanced-mean"]
    assert "a mean force of 0.3 N along" in curve.findings[0].message


def test_contacts_tie_a_structure_that_nothing_holds_by_dynamic_stiffnesses():
    names = [f"m{k}" for k in range(140)]
    springs = [(names[k], names[k + 1], 1.0, 0.0) for k in range(139)]
    posed = VibrationSystem(lumped(dict.fromkeys(names, 1.0), springs))
    posed.add(HarmonicForce(names[-1], 1.0))
    for k in range(70):
        posed.add(FrictionContact(f"on {k}", names[k], names[k + 1], friction=0.5, preload=0.1, law=ElasticSlider(0.4)))
    curve = frequency_response(posed, np.array([0.05]), HarmonicBalance(4), check=False)
    assert curve.provenance["method"]["solver"] == "stiffness"
    with pytest.raises(SolveError, match="moves without being held"):
        frequency_response(posed, np.array([0.05]), HarmonicBalance(4, solver="receptance"))


def test_a_part_that_stops_alone_hold_has_their_stiffness():
    posed = VibrationSystem(lumped({"m": 1.0, "free": 1.0}, [("m", None, 1.0, 0.05)]))
    posed.add(HarmonicForce("m", 0.2))
    posed.add(StaticForce("free", 0.3))
    posed.add(FrictionContact("pad", "m", friction=0.5, preload=0.1, law=ElasticSlider(0.4)))
    posed.add(Gap("floor", "free", "m", stiffness=8.0, gap=0.01))
    curve, other = (
        frequency_response(posed, np.array([0.1, 0.11]), replace(BY_RECEPTANCES, solver=solver), check=False)
        for solver in ("receptance", "stiffness")
    )
    assert curve.converged.all()
    np.testing.assert_allclose(curve.response, other.response, rtol=0, atol=1e-9)


def test_an_undamped_mode_at_its_frequency_is_detuned_by_slip():
    posed = VibrationSystem(lumped({"m": 1.0}, [("m", None, 1.0, 0.0)]))
    posed.add(HarmonicForce("m", 1.0))
    posed.add(FrictionContact("pad", "m", friction=0.5, preload=1.0, law=ElasticSlider(3.0)))
    at = np.array([2.0]) / (2 * np.pi)  # where the mass vibrates on both springs
    curve, other = (
        frequency_response(posed, at, replace(BY_RECEPTANCES, tolerance=1e-9, solver=solver), check=False)
        for solver in ("receptance", "stiffness")
    )
    assert curve.converged.all()
    np.testing.assert_allclose(curve.response, other.response, rtol=0, atol=1e-6)
