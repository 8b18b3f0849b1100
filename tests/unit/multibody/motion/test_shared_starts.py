"""Samples that start alike share the closed start; samples that do not are closed one by one."""

import numpy as np
import pytest

import dalembert.multibody as mb
from dalembert.multibody.motion import motion_model


def build(stiffness: float, angle: float) -> mb.System:
    system = mb.System(gravity=(0.0, -9.81))
    bar = system.add(mb.RigidBar("bar", 1.0, 2.0, angle=angle))
    system.add(mb.RevoluteJoint("pin", system.ground, bar.start))
    system.add(mb.TorsionSpring("coil", system.ground, bar.start, stiffness=stiffness, free_angle=0.0))
    return system


@pytest.mark.parametrize(("vectors", "starts"), [([(1.0, 0.3), (5.0, 0.3)], 1), ([(1.0, 0.3), (1.0, 0.4)], 2)])
def test_a_start_is_closed_once_for_samples_that_share_it(vectors, starts, monkeypatch) -> None:
    box = {"stiffness": (0.1, 9.0), "angle": (0.0, 1.0)}
    model = mb.TimeResponse(build, box, ("bar.end.x",), np.linspace(0.0, 0.1, 3), mb.GeneralizedAlpha(1e-2), 1)
    closed, inner = [], motion_model.assembled
    monkeypatch.setattr(
        motion_model, "assembled", lambda *given, **options: closed.append(1) or inner(*given, **options)
    )
    values = [model.evaluate(np.array([vector])).only()[0] for vector in vectors]
    assert len(closed) == starts
    alone = mb.TimeResponse(build, box, ("bar.end.x",), np.linspace(0.0, 0.1, 3), mb.GeneralizedAlpha(1e-2), 1)
    np.testing.assert_array_equal(values[1], alone.evaluate(np.array([vectors[1]])).only()[0])
