"""Motions of every kind of component in space: energy balance, joints, and derivatives by every number."""

from functools import cache

import numpy as np
import pytest

import dalembert.multibody as mb
import dalembert.multibody.spatial as sp
from dalembert.multibody.model.lowering import lower
from slopes import errors
from spatial_scenes import SCENES, fields_of, numbers_of, parameters_of

TIMES = np.array([0.0, 0.02, 0.05, 0.08])
STEPS = mb.RungeKutta4(step=1e-2)
VARIED = [(scene, name) for scene, (_, fields) in SCENES.items() for name in numbers_of(fields)]


@pytest.mark.parametrize("scene", SCENES)
def test_energy_balance_and_joints(scene: str) -> None:
    build, fields = SCENES[scene]
    motion = mb.simulate(build(**fields), 0.3, mb.RadauIIA(tolerance=1e-10))
    kinetic = motion.energies["kinetic"]
    given = lower(build(**fields))
    works = given.dissipates or any(kind.loads or kind.driven for kind in given.data)
    assert np.ptp(kinetic) > 0.1
    # work is a sum over the steps, whose error is that of the quadrature
    assert np.abs(motion.energies["balance"]).max() < (1e-5 if works else 1e-11) * np.abs(kinetic).max()
    assert motion.violations["position"].max() < 1e-12


def response(build, fields: dict) -> mb.TimeResponse:
    """A scene as a function of all of its numbers."""

    def builder(**numbers) -> sp.SpatialSystem:
        return build(**fields_of(fields, numbers))

    parameters = parameters_of(fields)
    system = build(**fields)
    names = [
        f"{body.name}.{body.point_names[-1]}.{entry}"
        for body in system.bodies
        for entry in ("x", "vy", "az", *(("wx", "rotation_z", "q1") if body.has_axes else ()))
    ]
    names += ["system.total_energy", *(f"{joint.name}.{entry}" for joint in system.joints for entry in outputs(joint))]
    names += [f"{load.name}.{entry}" for load in system.loads for entry, _ in load.kind.outputs]
    return mb.TimeResponse(builder, parameters, names, TIMES, STEPS)


def outputs(joint: sp.Joint) -> tuple[str, ...]:
    """Channels of a joint that are compared: of a coupling all."""
    known = [name for name, _ in joint.kind.outputs]
    turns = [name for name in known if name.startswith(("angle_", "rate_"))]
    return ("force_x", "torque_3", *turns) if "force_x" in known else tuple(known)


@cache
def compared(scene: str) -> tuple[dict[str, float], dict[str, float]]:
    return errors(response(*SCENES[scene]), relative=5e-3)


@pytest.mark.parametrize(("scene", "name"), VARIED)
def test_its_derivative_is_the_slope_of_the_motion(scene: str, name: str) -> None:
    error, size = (values[name] for values in compared(scene))
    assert size > 1e-6, "the scene does not depend on it"
    assert error < 1e-8
