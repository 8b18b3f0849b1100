"""Torsion springs in space: turns that are counted by every integrator, at rest, at a restart, and from the start on."""

import numpy as np
import pytest

import dalembert.multibody as mb
import dalembert.multibody.spatial as sp

MOMENT, STIFFNESS, RATE = 0.02, 0.05, 20.0
OMEGA = np.sqrt(STIFFNESS / MOMENT)
TIMES = np.linspace(0.0, 2.0, 9)


def wheel(stiffness=STIFFNESS, rate=RATE, torque=0.0, **fields) -> sp.SpatialSystem:
    """A wheel that winds a spring by rate / OMEGA, two turns."""
    system = sp.SpatialSystem(gravity=(0.0, 0.0, 0.0))
    disc = system.add(sp.RigidBody("disc", sp.Inertia(1.0, (MOMENT,) * 3), angular_velocity=(0.0, 0.0, rate)))
    sides = system.ground, disc.point("origin")
    system.add(sp.RevoluteJoint("pin", *sides))
    system.add(sp.TorsionSpring("coil", *sides, stiffness=stiffness, **fields))
    system.add(sp.Torque("load", disc.point("origin"), z=torque))
    return system


@pytest.mark.parametrize(
    ("solver", "tolerance"),
    [
        (mb.RadauIIA(tolerance=1e-9), 1e-9),
        (mb.GeneralizedAlpha(1e-3), 1e-2),
        (mb.GeneralizedAlpha(1e-3, adaptive=True), 1e-2),
        (mb.RungeKutta4(2e-3), 1e-5),
        (mb.OdeSolver(), 1e-5),
        (mb.EnergyMomentum(2e-3), 1e-2),
        (mb.Variational(2e-3), 1e-2),
        (mb.Collocation(1e-2), 1e-2),
    ],
    ids=str,
)
def test_integrators_count_the_turns(solver: mb.Integrator, tolerance: float) -> None:
    twist, torque = mb.simulate(wheel(), 2.0, solver, TIMES).channels(["coil.twist", "coil.torque"]).T
    expected = RATE / OMEGA * np.sin(OMEGA * TIMES)
    assert expected.max() > 4 * np.pi
    np.testing.assert_allclose(twist, expected, atol=tolerance)
    np.testing.assert_allclose(torque, STIFFNESS * twist, rtol=1e-12)


def test_an_equilibrium_winds_the_spring_by_turns() -> None:
    rest = mb.equilibrium(wheel(rate=0.0, torque=0.5))
    np.testing.assert_allclose(rest.channels(["coil.twist", "coil.torque"]), (10.0, 0.5), rtol=1e-12)
    assert mb.modes(rest).frequencies == pytest.approx([OMEGA / (2 * np.pi)], rel=1e-9)


@pytest.mark.parametrize(
    ("fields", "twist"),
    [
        ({}, 0.0),
        ({"free_angle": 1.0}, -1.0),
        ({"free_angle": 6.0}, 2 * np.pi - 6.0),
        ({"near": 12.0}, 0.0),
        ({"near": 12.0, "free_angle": 0.5}, 4 * np.pi - 0.5),
        ({"near": -6.0, "free_angle": 6.0}, -2 * np.pi - 6.0),
    ],
)
def test_where_the_twist_begins(fields: dict, twist: float) -> None:
    motion = mb.simulate(wheel(**fields), 1e-3)
    assert motion.channels(["coil.twist"])[0, 0] == pytest.approx(twist, abs=1e-12)


def test_a_segment_continues_the_count() -> None:
    at = np.array([STIFFNESS, RATE])
    box = {"stiffness": (0.01, 0.1), "rate": (10.0, 30.0)}
    whole = mb.TimeResponse(wheel, box, ["coil.twist"], TIMES, mb.RadauIIA(tolerance=1e-9))
    first = whole.restarted(0.0, TIMES[:5], None, whole.state_chart(at, whole=True))
    chart = whole.state_chart(at, first.evaluate(at[None]).values[0, -1, 1:])
    rest = whole.restarted(TIMES[4], TIMES[4:] - TIMES[4], chart, None)
    twist = rest.evaluate(np.append(at, chart.values)[None]).only()[0, :, 0]
    assert twist[0] > 3 * np.pi
    np.testing.assert_allclose(twist, RATE / OMEGA * np.sin(OMEGA * TIMES[4:]), atol=1e-8)
