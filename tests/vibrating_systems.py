"""The systems of the published references for friction in frequency."""

from dalembert.structure import lumped
from dalembert.vibration import CubicSpring, Elastic, FrictionContact, Gap, HarmonicForce, Rigid, VibrationSystem


def one_mass() -> VibrationSystem:
    """One degree of freedom with a slider to the ground."""
    system = VibrationSystem(lumped({"m": 1.0}, [("m", None, 1.0, 0.04)]))
    system.add(HarmonicForce("m", 1.0))
    system.add(FrictionContact("slider", "m", friction=0.5, preload=2.0, law=Elastic(0.8)))
    return system


SPRING = Elastic(1.5)


def two_masses(law: Elastic | Rigid = SPRING) -> VibrationSystem:
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
    system.add(FrictionContact("to ground", "m1", friction=1.0, preload=1.0, law=Elastic(20.0)))
    system.add(FrictionContact("between", "m1", "m2", friction=1.0, preload=1.0, law=Elastic(20.0)))
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
