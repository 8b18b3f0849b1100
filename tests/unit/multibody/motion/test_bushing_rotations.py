"""Findings on bushings in space that pass half a turn."""

import numpy as np
import pytest

from dalembert.multibody import GeneralizedAlpha, TimeResponse, simulate
from dalembert.multibody.spatial import Bushing, Inertia, RevoluteJoint, RigidBody, SpatialSystem

FREE, HELD = (1e3,) * 3 + (0.0,) * 3, (1e3,) * 3 + (1.0,) * 3


def turning(rate=8.0, stiffness=HELD, damping=(0.0,) * 6) -> SpatialSystem:
    """A wheel on a bushing that starts with a rate, rad/s; it turns by rate sqrt(moment / stiffness) at most."""
    system = SpatialSystem(gravity=(0.0, 0.0, 0.0))
    wheel = system.add(RigidBody("wheel", Inertia(1.0, (0.25,) * 3), angular_velocity=(0.0, rate, 0.0)))
    sides = system.ground, wheel.point("origin")
    system.add(RevoluteJoint("pin", *sides, axis=(0.0, 1.0, 0.0)))
    system.add(Bushing("bush", *sides, stiffness, damping))
    return system


def findings(*given, **fields):
    return simulate(turning(*given, **fields), 2.0, GeneralizedAlpha(1e-3)).findings


def test_a_bushing_that_passes_half_a_turn_is_named_with_the_time():
    (found,) = findings(8.0)  # cos(2 t) would bring the rotation 4 sin(2 t) to pi
    assert (found.code, found.severity, found.values["bushing"]) == ("bushing-half-turn", "warning", "bush")
    assert found.values["time"] == pytest.approx(np.arcsin(np.pi / 4) / 2, abs=2e-3)


@pytest.mark.parametrize(
    ("rate", "fields"),
    [(6.2, {}), (30.0, {"stiffness": FREE})],
    ids=["almost half a turn", "turning is free"],
)
def test_other_bushings_are_not_named(rate, fields):
    assert findings(rate, **fields) == ()


def test_damping_alone_ends_at_half_a_turn_too():
    (found,) = findings(8.0, stiffness=FREE, damping=(0.0, 0.0, 0.0, 0.0, 0.01, 0.0))
    assert found.code == "bushing-half-turn"


def test_a_model_of_measurements_has_the_finding():
    model = TimeResponse(turning, {"rate": (1.0, 10.0)}, ["pin.rate"], np.linspace(0.0, 2.0, 5))
    assert [found.code for found in model.findings(np.array([8.0]))] == ["bushing-half-turn"]
    assert model.findings(np.array([3.0])) == ()
