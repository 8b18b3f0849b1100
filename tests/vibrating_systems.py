"""The systems of the published references for friction in frequency."""

import numpy as np

from dalembert.structure import Dofs, Structure, lumped
from dalembert.vibration import (
    CubicSpring,
    ElasticSlider,
    FrictionContact,
    Gap,
    HarmonicForce,
    Rigid,
    StaticForce,
    VibrationSystem,
)


def one_mass() -> VibrationSystem:
    """One degree of freedom with a slider to the ground."""
    system = VibrationSystem(lumped({"m": 1.0}, [("m", None, 1.0, 0.04)]))
    system.add(HarmonicForce("m", 1.0))
    system.add(FrictionContact("slider", "m", friction=0.5, preload=2.0, law=ElasticSlider(0.8)))
    return system


SPRING = ElasticSlider(1.5)


def two_masses(law: ElasticSlider | Rigid = SPRING) -> VibrationSystem:
    """Two degrees of freedom with a slider on the second."""
    springs = [("m1", None, 1.0, 0.02), ("m1", "m2", 1.0, 0.02), ("m2", None, 0.5, 0.01)]
    system = VibrationSystem(lumped({"m1": 1.0, "m2": 1.0}, springs))
    system.add(HarmonicForce("m1", 1.0))
    system.add(FrictionContact("slider", "m2", friction=0.3, preload=2.0, law=law))
    return system


def chain() -> VibrationSystem:
    """Three masses between walls with sliders, cubic springs and a stop."""
    places = [("m1", None), ("m1", "m2"), ("m2", "m3"), ("m3", None)]
    system = VibrationSystem(lumped(dict.fromkeys(("m1", "m2", "m3"), 1.0), [(*ends, 1.0, 0.02) for ends in places]))
    system.add(HarmonicForce("m2", 1.0))
    system.add(FrictionContact("to ground", "m1", friction=1.0, preload=1.0, law=ElasticSlider(20.0)))
    system.add(FrictionContact("between", "m1", "m2", friction=1.0, preload=1.0, law=ElasticSlider(20.0)))
    system.add(CubicSpring("cubic to ground", "m2", stiffness=1.0))
    system.add(CubicSpring("cubic between", "m2", "m3", stiffness=1.0))
    system.add(Gap("stop", "m3", stiffness=1.0, gap=0.25))
    return system


def duffing() -> VibrationSystem:
    """An oscillator with a hardening spring."""
    system = VibrationSystem(lumped({"m": 1.0}, [("m", None, 1.0, 0.05)]))
    system.add(HarmonicForce("m", 0.18))
    system.add(CubicSpring("cubic", "m", stiffness=0.1))
    return system


def pressed(size: float, normal: float = 0.1) -> VibrationSystem:
    """A mass that a constant force presses on the ground and another one drives, along it and, in part, into it."""
    damping = np.diag([2 * 0.05 * np.sqrt(12), 2 * 0.1 * np.sqrt(100)])
    system = VibrationSystem(Structure(np.eye(2), np.diag([12.0, 21.0]), Dofs(("m.x", "m.z")), damping))
    system.add(StaticForce("m.z", 100.0))
    system.add(HarmonicForce("m.x", size))
    system.add(HarmonicForce("m.z", normal * size))
    law = ElasticSlider(5.0, normal_stiffness=21.0)
    system.add(FrictionContact("foot", "m", normal="z", friction=0.85, law=law))
    return system


def massless_foot(law: ElasticSlider | Rigid) -> VibrationSystem:
    """The one mass again, with the slider's spring in the structure: a foot without mass rubs on the ground."""
    springs = [("m", None, 1.0, 0.04), ("m", "foot", 0.8, 0.0)]
    system = VibrationSystem(lumped({"m": 1.0, "foot": 0.0}, springs))
    system.add(HarmonicForce("m", 1.0))
    system.add(FrictionContact("slider", "foot", friction=0.5, preload=2.0, law=law))
    return system


def heavy_foot(law: ElasticSlider | Rigid) -> VibrationSystem:
    """Two masses, the second of which rubs on the ground, well damped."""
    springs = [("m1", None, 1.0, 0.1), ("m1", "m2", 1.0, 0.1), ("m2", None, 0.5, 0.05)]
    system = VibrationSystem(lumped({"m1": 1.0, "m2": 1.0}, springs))
    system.add(HarmonicForce("m1", 1.0))
    system.add(FrictionContact("slider", "m2", friction=0.5, preload=1.0, law=law))
    return system


def pressed_blocks() -> VibrationSystem:
    """Three masses on two pressed contacts with friction in two directions, at which a motion is unstable."""
    axes = "xyz"
    masses = {f"{node}.{axis}": 1.0 for node in "abc" for axis in axes}
    springs = [
        (f"{node}.{axis}", end if end is None else f"{end}.{axis}", 1.0 + 0.1 * place + 0.2 * row, 0.03)
        for place, (node, end) in enumerate((("a", None), ("b", "a"), ("c", "b")))
        for row, axis in enumerate(axes)
    ]
    system = VibrationSystem(lumped(masses, springs))
    for axis, force in zip(axes, (0.6, 0.3, 0.3), strict=True):
        system.add(HarmonicForce(f"c.{axis}", force))
    law = ElasticSlider(2.0, normal_stiffness=3.0)
    for node in "ab":
        sides = {"tangential": ("x", "y"), "normal": "z"}
        system.add(FrictionContact(f"at {node}", node, **sides, friction=0.4, preload=0.5, law=law))
    return system
