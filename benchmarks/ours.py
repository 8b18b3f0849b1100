"""The benchmark models written for dalembert."""

from collections.abc import Callable

import numpy as np

import dalembert as da
from benchmarks.cases import ARM, GRAVITY, PENDULUM, Bar, Integration, TwoLinkArm
from benchmarks.spatial_cases import Mechanism
from dalembert.multibody.spatial import (
    CylindricalJoint,
    Inertia,
    RevoluteJoint,
    RigidBody,
    SpatialSystem,
    SphericalJoint,
)

JOINT_AND_TIP = ("OA.end.x", "OA.end.y", "AB.end.x", "AB.end.y")


def solver(integration: Integration) -> da.GeneralizedAlpha:
    return da.GeneralizedAlpha(step=integration.step, spectral_radius=integration.spectral_radius)


def cable_pendulum(
    theta1=-PENDULUM.oa.angle,
    theta2=-PENDULUM.ab.angle,
    youngs_oa=PENDULUM.oa.youngs_modulus,
    youngs_ab=PENDULUM.ab.youngs_modulus,
) -> da.System:
    """The peer's element: gradient-deficient cable, two elements and four."""
    system = da.System(gravity=(0.0, -GRAVITY))
    oa = system.add(_cable("OA", PENDULUM.oa, youngs_oa, -theta1))
    ab = system.add(_cable("AB", PENDULUM.ab, youngs_ab, -theta2, start=oa.end))
    system.add(da.RevoluteJoint("O", system.ground, oa.start))
    system.add(da.RevoluteJoint("A", oa.end, ab.start))
    return system


def beam_pendulum(
    theta1=-PENDULUM.oa.angle,
    theta2=-PENDULUM.ab.angle,
    youngs_oa=PENDULUM.oa.youngs_modulus,
    youngs_ab=PENDULUM.ab.youngs_modulus,
    length_oa=PENDULUM.oa.length,
    length_ab=PENDULUM.ab.length,
    height=PENDULUM.oa.height,
    density=PENDULUM.oa.density,
    formulation="structural",
) -> da.System:
    """Fully parametrised beams, with twice the coordinates of the cables; the published ones are a continuum."""
    section = {"height": height, "width": PENDULUM.oa.width, "density": density, "poisson_ratio": 0.3}
    section |= {"formulation": formulation}
    system = da.System(gravity=(0.0, -GRAVITY))
    oa = system.add(da.AncfBeam("OA", length_oa, PENDULUM.oa.elements, youngs_oa, angle=-theta1, **section))
    ab = system.add(
        da.AncfBeam("AB", length_ab, PENDULUM.ab.elements, youngs_ab, angle=-theta2, start=oa.end, **section)
    )
    system.add(da.RevoluteJoint("O", system.ground, oa.start))
    system.add(da.RevoluteJoint("A", oa.end, ab.start))
    return system


def two_link_arm(case: TwoLinkArm = ARM) -> da.System:
    system = da.System(gravity=(0.0, -GRAVITY))
    oa = system.add(da.RigidBar("OA", case.upper.length, case.upper.mass, angle=case.upper.angle))
    ab = system.add(da.RigidBar("AB", case.lower.length, case.lower.mass, angle=case.lower.angle, start=oa.end))
    system.add(da.RevoluteJoint("O", system.ground, oa.start))
    system.add(da.RevoluteJoint("A", oa.end, ab.start))
    return system


def chain(bar: Bar) -> da.System:
    system = da.System(gravity=(0.0, -GRAVITY))
    cable = system.add(_cable("C", bar, bar.youngs_modulus, bar.angle))
    system.add(da.RevoluteJoint("O", system.ground, cable.start))
    return system


def strip(bar: Bar, kind: str) -> da.System:
    """Bar clamped at its start; ``kind``: ``"cable"``, or a formulation of beams."""
    system = da.System(gravity=(0.0, -GRAVITY))
    if kind == "cable":
        body = system.add(_cable("C", bar, bar.youngs_modulus, bar.angle))
    else:
        section = {"height": bar.height, "width": bar.width, "density": bar.density, "poisson_ratio": 0.3}
        body = system.add(
            da.AncfBeam("C", bar.length, bar.elements, bar.youngs_modulus, formulation=kind, angle=bar.angle, **section)
        )
    system.add(da.FixedJoint("clamp", system.ground, body.start))
    return system


def response(builder, integration: Integration, channels=JOINT_AND_TIP) -> Callable[[], np.ndarray]:
    """Channels (of joint and tip) at the output times, (samples, channels), and no more: what the peer keeps, too."""
    one = {"one": (0.0, 1.0)}  # a model needs a parameter; this one does nothing
    model = da.TimeResponse(
        lambda one: builder(), one, channels, integration.times, solver=solver(integration), workers=1
    )
    return lambda: model.evaluate(np.zeros((1, 1))).only()[0]


def simulated(system: da.System, integration: Integration, channels: tuple[str, ...]) -> np.ndarray:
    """Channels (samples, channels) at the output times."""
    trajectory = da.simulate(system, integration.end, solver=solver(integration), times=integration.times)
    return trajectory.channels(channels)


def _cable(name: str, bar: Bar, youngs_modulus, angle, start=(0.0, 0.0)) -> da.AncfCable:
    return da.AncfCable(
        name,
        bar.length,
        bar.elements,
        youngs_modulus,
        density=bar.density,
        height=bar.height,
        width=bar.width,
        angle=angle,
        start=start,
    )


def mechanism(case: Mechanism) -> SpatialSystem:
    """The bodies ``0``, ``1`` and so on, with their joints; the last one has the point ``tip``."""
    system = SpatialSystem(gravity=case.gravity)
    bodies = []
    for number, own in enumerate(case.bodies):
        points = {
            f"p{k}": tuple(pin.point - own.position) for k, pin in enumerate(case.joints) if number in (pin.a, pin.b)
        }
        body = RigidBody(
            f"{number}",
            Inertia.of(own.mass, own.tensor, own.centre),
            position=tuple(own.position),
            points=points | {"tip": tuple(case.tip)},
            velocity=own.velocity,
            angular_velocity=own.spin,
        )
        bodies.append(system.add(body))
    for k, pin in enumerate(case.joints):
        a, b = (
            system.ground.point(tuple(pin.point)) if side < 0 else bodies[side].point(f"p{k}")
            for side in (pin.a, pin.b)
        )
        turning = CylindricalJoint if pin.slides else RevoluteJoint
        system.add(SphericalJoint(f"j{k}", a, b) if pin.axis is None else turning(f"j{k}", a, b, axis=pin.axis))
    return system


def tip(case: Mechanism) -> tuple[str, ...]:
    """Channels of the position that is observed."""
    return tuple(f"{len(case.bodies) - 1}.tip.{axis}" for axis in "xyz")
