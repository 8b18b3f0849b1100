"""An arch that snaps through."""

import dalembert.multibody as mb


def flat_arch(load: float) -> mb.System:
    """A flat arch of two springs, pushed down at its apex; its limit load is 3.82988 N."""
    system = mb.System(gravity=(0.0, 0.0))
    apex = system.add(mb.PointMass("apex", mass=1.0, position=(0.0, 0.1)))
    for name, x in (("left", -1.0), ("right", 1.0)):
        ground = system.ground.point(x, 0.0)
        system.add(mb.Spring(name, ground, apex.centre, stiffness=1e4, free_length=1.01**0.5))
    system.add(mb.Force("push", apex.centre, y=-load))
    return system
