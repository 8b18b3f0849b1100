"""First placements and velocities: loops that close, and chains that hang together."""

import numpy as np
import pytest
from scipy.linalg import qr

import dalembert.multibody as mb
from dalembert.errors import InputError, ModelError
from dalembert.multibody.start import assemble
from dalembert.multibody.start.assemble import assembled
from support import says

CRANK, COUPLER, ROCKER, BASE = 0.4, 1.0, 0.8, 1.1


def four_bar(crank: float = 0.7, coupler: str = "rigid", tilt: float = 0.3, rocker: float = 1.5) -> mb.System:
    """A four-bar whose coupler and rocker are placed roughly; the crank drives."""
    system = mb.System(driving=["crank.angle"])
    a = system.add(mb.RigidBar("crank", CRANK, 1.0, angle=crank, angular_velocity=2.0))
    place = {"angle": tilt, "start": a.end}
    if coupler == "rigid":
        b = system.add(mb.RigidBar("coupler", COUPLER, 2.0, **place))
    else:
        b = system.add(mb.AncfCable("coupler", COUPLER, 3, 2e9, 2000.0, 0.02, 0.02, **place))
    c = system.add(mb.RigidBar("rocker", ROCKER, 1.5, start=(BASE, 0.0), angle=rocker))
    system.add(mb.RevoluteJoint("A0", system.ground.point(0.0, 0.0), a.start))
    system.add(mb.RevoluteJoint("A", a.end, b.start))
    system.add(mb.RevoluteJoint("B", b.end, c.end))
    system.add(mb.RevoluteJoint("B0", system.ground.point(BASE, 0.0), c.start))
    return system


def closed(crank: float, side: int = 1) -> tuple[float, float]:
    """Angles of coupler and rocker of the four-bar, by the intersection of two circles."""
    pin = CRANK * np.exp(1j * crank)
    gap = BASE - pin
    along = (abs(gap) ** 2 + COUPLER**2 - ROCKER**2) / (2 * abs(gap))
    joint = pin + gap / abs(gap) * (along + 1j * side * np.sqrt(COUPLER**2 - along**2))
    return float(np.angle(joint - pin)), float(np.angle(joint - BASE))


@pytest.mark.parametrize("coupler", ["rigid", "flexible"])
@pytest.mark.parametrize("crank", [0.7, 2.0, -1.3])
def test_a_four_bar_closes_at_the_angle_of_its_crank(crank: float, coupler: str) -> None:
    trajectory = mb.simulate(four_bar(crank, coupler=coupler), 1e-3)
    given = trajectory.channels(["crank.end.angle", "coupler.end.angle", "rocker.end.angle"])[0]
    np.testing.assert_allclose(given, [crank, *closed(crank)], rtol=0, atol=1e-12)


def test_the_other_branch_is_found_from_the_other_side() -> None:
    given = mb.simulate(four_bar(tilt=-0.3, rocker=-1.5), 1e-3).channels(["rocker.end.angle"])[0]
    assert np.angle(np.exp(1j * given[0])) == pytest.approx(closed(0.7, -1)[1], abs=1e-12)


def test_its_first_velocities_are_those_of_the_closed_loop() -> None:
    given = mb.simulate(four_bar(), 1e-3).channels(["crank.end.rate", "coupler.end.rate", "rocker.end.rate"])[0]
    h = 1e-5
    slope = (np.array(closed(0.7 + h)) - np.array(closed(0.7 - h))) / (2 * h)
    np.testing.assert_allclose(given, [2.0, *2.0 * slope], rtol=1e-8)


def test_what_is_closed_stays_where_it_was_put() -> None:
    system = mb.System()
    bar = system.add(mb.RigidBar("bar", 1.0, 1.0, angle=0.3, start=(0.2, 0.1)))
    rope = system.add(mb.AncfCable("rope", 0.7, 2, 1e7, 1000.0, 0.01, 0.01, start=bar.end, angle=-0.8))
    system.add(mb.RevoluteJoint("O", system.ground, bar.start))
    system.add(mb.RevoluteJoint("A", bar.end, rope.start))
    placed = [0.2 + np.cos(0.3) + 0.7 * np.cos(-0.8), 0.1 + np.sin(0.3) + 0.7 * np.sin(-0.8)]
    trajectory = mb.simulate(system, 1e-3)
    np.testing.assert_allclose(trajectory.channels(["rope.end.x", "rope.end.y"])[0], placed, rtol=0, atol=1e-15)


def test_a_loop_with_a_beam_is_closed_without_strain() -> None:
    lowered = assembled(four_bar(coupler="flexible"))
    first = lowered.structure.first["coupler"]
    nodes = lowered.x[first : first + 16].reshape(4, 2, 2)
    np.testing.assert_allclose(np.hypot(*nodes[:, 1].T), 1.0, rtol=1e-14)
    np.testing.assert_allclose(np.diff(nodes[:, 0], axis=0), COUPLER / 3 * nodes[1:, 1], rtol=0, atol=1e-14)


def test_a_body_may_start_at_a_point_of_another() -> None:
    system = mb.System(gravity=(0.0, 0.0))
    plate = system.add(mb.RigidBody("plate", 1.0, 0.1, (1.0, 2.0), 0.5, points={"corner": (0.3, 0.4)}))
    system.add(mb.RigidBody("twin", 1.0, 0.1, plate.point("corner"), anchor="tip", points={"tip": (0.0, 0.2)}))
    corner = [1 + 0.3 * np.cos(0.5) - 0.4 * np.sin(0.5), 2 + 0.3 * np.sin(0.5) + 0.4 * np.cos(0.5)]
    trajectory = mb.simulate(system, 1e-3)
    for point in ("plate.corner", "twin.tip"):
        np.testing.assert_allclose(trajectory.channels([f"{point}.x", f"{point}.y"])[0], corner, rtol=1e-15)


@pytest.mark.parametrize(
    ("driving", "sentence"),
    [
        ("crank.angel", "driving 'crank.angel': unknown coordinate 'angel'; did you mean 'angle'?"),
        ("cranck.angle", "driving 'cranck.angle': unknown body 'cranck'; did you mean 'crank'?"),
    ],
)
def test_an_unknown_driving_coordinate_is_told(driving: str, sentence: str) -> None:
    system = four_bar()
    system.driving = (driving,)
    with pytest.raises(InputError, match=says(sentence)):
        mb.simulate(system, 1.0)


def slider_crank(crank_length: float, rod_length: complex) -> mb.System:
    """Closed, with the crank upright."""
    system = mb.System()
    crank = system.add(mb.RigidBar("crank", crank_length, 1.0, angle=np.pi / 2))
    rod = system.add(
        mb.RigidBar(
            "rod", rod_length, 1.0, start=crank.end, angle=-np.arcsin(crank_length * np.sin(np.pi / 2) / rod_length)
        )
    )
    slider = system.add(mb.RigidBody("slider", 1.0, 0.1, position=rod.end))
    system.add(mb.RevoluteJoint("O", system.ground, crank.start))
    system.add(mb.RevoluteJoint("A", crank.end, rod.start))
    system.add(mb.RevoluteJoint("B", rod.end, slider.centre))
    system.add(mb.PrismaticJoint("guide", system.ground.point(0.0, 0.0), slider.centre))
    return system


@pytest.mark.parametrize(("rod", "lack"), [(1.25, 1e-7), (2.375, 3e-8), (5.0, 1e-7), (9.5, 3e-8)])
def test_large_derivatives_of_the_start_are_rounded_in_proportion(rod: float, lack: float) -> None:
    """The rod is nearly upright: its angle changes by thousands of rad while a length changes by its size."""
    crank = rod * (1.0 - lack)
    lowered = assembled(slider_crank(crank, rod + 1e-30j * rod), perturbed=True)
    slope = np.imag(lowered.x[lowered.structure.first["rod"] + 2]) / 1e-30
    assert slope == pytest.approx(1.0 / np.sqrt((rod / crank) ** 2 - 1.0), rel=1e-6)


def test_a_joint_that_no_derivative_closes_is_told() -> None:
    """A bar between two fixed points fits at one length only."""
    system = mb.System()
    bar = system.add(mb.RigidBar("bar", 1.0 + 1e-30j, 1.0))
    system.add(mb.RevoluteJoint("left", system.ground.point(0.0, 0.0), bar.start))
    system.add(mb.RevoluteJoint("right", system.ground.point(1.0, 0.0), bar.end))
    sentence = r"^joint '(left|right)' is closed, but not for other values of a parameter, so there is no derivative"
    with pytest.raises(ModelError, match=sentence):
        assembled(system, perturbed=True)


@pytest.mark.parametrize("held", [False, True])
def test_independent_constraints_need_no_dense_decomposition(held: bool, monkeypatch: pytest.MonkeyPatch) -> None:
    """A chain whose last link is pinned twice keeps the answer of the dense one."""
    system, last = mb.System(), None
    for k in range(30):
        bar = system.add(mb.RigidBar(f"bar {k}", 1.0, 1.0, start=(float(k), 0.0)))
        system.add(mb.RevoluteJoint(f"pin {k}", last or system.ground.point(0.0, 0.0), bar.start))
        last = bar.end
    if held:
        system.add(mb.RevoluteJoint("again", system.ground.point(0.0, 0.0), system.bodies[0].start))
    calls = []
    monkeypatch.setattr(assemble, "qr", lambda *given, **options: calls.append(1) or qr(*given, **options))
    found = assemble.redundancy(assembled(system))
    assert (found.count, found.rank, len(calls)) == ((62, 60, 1) if held else (60, 60, 0))
