"""A rigid crank and a flexible rod with material damping, stiff from the first microsecond."""

import numpy as np

import dalembert as da


def damped_slider_crank(damping: float) -> da.System:
    """The rod is at rest but for its end, so that its fastest vibrations start; ``damping`` in s."""
    system, radius, length, angle = da.System(), 0.15, 0.3, 0.4
    crank = system.add(da.RigidBar("crank", radius, 1.0, angle=angle, angular_velocity=12.0))
    slope = -np.arcsin(radius * np.sin(angle) / length)
    rod = system.add(
        da.AncfCable("rod", length, 4, 2e9, 2000.0, 0.01, 0.01, start=crank.end, angle=slope, damping=damping)
    )
    slider = system.add(da.RigidBody("slider", 0.5, 0.1, position=rod.end))
    system.add(da.RevoluteJoint("O", system.ground, crank.start))
    system.add(da.RevoluteJoint("A", crank.end, rod.start))
    system.add(da.RevoluteJoint("B", rod.end, slider.centre))
    system.add(da.PrismaticJoint("guide", system.ground.point(0.0, 0.0), slider.centre))
    return system
