"""A computation prepares the kernels that it calls, so that they are compiled on all cores and with progress."""

from collections.abc import Callable, Iterable
from importlib import import_module

import numpy as np
import pytest

import dalembert.multibody as mb
from dalembert.kernels.kernel import Compiled
from dalembert.kernels.objects import OBJECTS


def rod(mass: float) -> mb.System:
    """A pendulum with friction, under a spring."""
    system = mb.System()
    bar = system.add(mb.RigidBar("bar", 1.0, mass, angle=0.2))
    system.add(mb.RevoluteJoint("pin", system.ground, bar.start, viscous=0.1))
    system.add(mb.Spring("spring", system.ground.point(0.0, 1.0), bar.end, stiffness=100.0))
    return system


def motion() -> mb.Trajectory:
    return mb.simulate(rod(1.0), 0.01, mb.GeneralizedAlpha(step=1e-3))


def model() -> mb.TimeResponse:
    channels = ["bar.end.x", "pin.force_x", "system.total_energy"]
    return mb.TimeResponse(rod, {"mass": (1.0, 2.0)}, channels, np.linspace(0.0, 0.01, 3), mb.GeneralizedAlpha(1e-3))


CASES: dict[str, Callable[[], object]] = {
    "simulation": motion,
    "channels": lambda: motion().channels(motion().channel_names),
    "energies": lambda: motion().energies,
    "response": lambda: model().evaluate(np.array([[1.5]])),
    "derivatives": lambda: model().jacobian(np.array([1.5])),
    "equilibrium": lambda: mb.equilibrium(rod(1.0)),
    "modes": lambda: mb.modes(rod(1.0)),
}


@pytest.mark.parametrize("case", CASES)
def test_what_is_called_was_prepared(case: str, monkeypatch: pytest.MonkeyPatch) -> None:
    prepared: set[str] = set()

    def prepare(kernels: Iterable[Compiled]) -> None:
        for kernel in kernels:
            if kernel.symbol not in prepared:
                prepared.add(kernel.symbol)
                prepare(kernel.needs)

    def address(kernel: Compiled) -> int:
        assert kernel.symbol in prepared
        return OBJECTS.address(kernel)

    for module in ("motion.simulation", "motion.motion_model", "motion.trajectory", "start.statics"):
        monkeypatch.setattr(import_module(f"dalembert.multibody.{module}"), "prepare", prepare)
    monkeypatch.setattr(Compiled, "address", property(address))
    CASES[case]()
    assert prepared
