"""Free decays of oscillators with sliders and springs, step by step in time, and the same as systems over frequency."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from dalembert.data import Measurements
from dalembert.structure import lumped
from dalembert.vibration import CubicSpring, ElasticSlider, FrictionContact, HarmonicBalance, VibrationSystem, backbone

STEPS = 640
"""Steps of the fourth-order Runge-Kutta method in a period."""
EACH = 20
"""Steps between two samples."""
QUANTITIES = ("displacement", "velocity", "acceleration")


@dataclass(frozen=True)
class Oscillator:
    """x'' + damping x' + x + cubic x³ + sliders = 0, released at rest.

    ``sliders``: stiffness and displacement at which each slips.
    """

    damping: float
    cubic: float = 0.0
    sliders: tuple[tuple[float, float], ...] = ()
    start: float = 1.0
    periods: int = 60

    @cached_property
    def decay(self) -> tuple[np.ndarray, np.ndarray]:
        """Times (samples,), and displacement, velocity and acceleration at them, (samples, 3)."""
        stiffness, slips = (np.array(column) for column in zip(*(self.sliders or ((0.0, 1.0),)), strict=True))
        limits = stiffness * slips
        step = 2 * np.pi / np.sqrt(1 + stiffness.sum()) / STEPS

        def acceleration(x, v, z):
            friction = np.clip(stiffness * (x - z), -limits, limits).sum()
            return -self.damping * v - x - self.cubic * x**3 - friction

        x, v, z = self.start, 0.0, np.maximum(self.start - slips, 0.0)
        samples = [(x, v, acceleration(x, v, z))]
        for number in range(1, self.periods * STEPS + 1):
            v1 = acceleration(x, v, z)
            v2 = acceleration(x + step / 2 * v, v + step / 2 * v1, z)
            v3 = acceleration(x + step / 2 * (v + step / 2 * v1), v + step / 2 * v2, z)
            v4 = acceleration(x + step * (v + step / 2 * v2), v + step * v3, z)
            x += step * v + step**2 / 6 * (v1 + v2 + v3)
            v += step / 6 * (v1 + 2 * v2 + 2 * v3 + v4)
            z = np.clip(z, x - slips, x + slips)
            if number % EACH == 0:
                samples.append((x, v, acceleration(x, v, z)))
        return step * EACH * np.arange(len(samples)), np.array(samples)

    def record(self, order: int = 0, noise: float = 0.0, seed: int = 0) -> Measurements:
        """A record of the displacement, velocity or acceleration, with white noise."""
        times, samples = self.decay
        noises = noise * np.random.default_rng(seed).standard_normal(len(times))
        return Measurements.of(times, {"x": samples[:, order] + noises})

    def system(self) -> VibrationSystem:
        """The same for nonlinear modes."""
        system = VibrationSystem(lumped({"m": 1.0}, [("m", None, 1.0, self.damping)]))
        if self.cubic:
            system.add(CubicSpring("spring", "m", stiffness=self.cubic))
        for number, (stiffness, slip) in enumerate(self.sliders):
            law = ElasticSlider(tangential_stiffness=stiffness)
            system.add(FrictionContact(f"slider {number}", "m", friction=1.0, preload=stiffness * slip, law=law))
        return system

    def periodic(self, amplitudes: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Frequencies, Hz, and damping ratios of periodic motions at amplitudes, (points,) each."""
        order = np.argsort(amplitudes)
        mode = backbone(self.system(), amplitudes[order], method=HarmonicBalance(harmonics=9))
        assert mode.converged.all()
        frequencies, damping = np.empty(len(order)), np.empty(len(order))
        frequencies[order], damping[order] = mode.frequencies, mode.damping
        return frequencies, damping


IWAN = tuple((0.005, float(slip)) for slip in np.geomspace(0.1, 5.0, 20))
JENKINS = Oscillator(0.004, sliders=((0.1, 1.0),), start=6.0)
DUFFING = Oscillator(0.02, cubic=0.3, start=2.0)
SEVERAL_SLIDERS = Oscillator(0.004, sliders=IWAN, start=6.0, periods=80)
LINEAR = Oscillator(0.02)
