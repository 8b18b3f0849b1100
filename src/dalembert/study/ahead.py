"""Everything that is compiled, compiled ahead: for an image, for the machines of a cluster, before a course."""

import inspect
from collections.abc import Iterator
from concurrent.futures import ProcessPoolExecutor, as_completed
from multiprocessing import get_context
from time import perf_counter

import numpy as np

from dalembert.forward.builders import cores


def compile_ahead() -> Iterator[tuple[str, float]]:
    """Compile what is not on disk yet, by small runs of every sort in processes of their own, one a core.

    Yields
    ------
    name : str
        Of the sort that is done.
    seconds : float
        That it took: next to nothing if it was on disk.
    """
    with ProcessPoolExecutor(cores(), get_context("spawn")) as pool:
        for done in as_completed([pool.submit(_timed, name) for name in _sorts()]):
            yield done.result()


def _sorts() -> list[str]:
    """The integrators by their names, and what else is compiled; longest first, but what shares its parts apart."""
    from dalembert.study.catalogue import catalogue

    first = ["GeneralizedAlpha", "friction in frequency", "bounds of surrogates", "RadauIIA", "Collocation"]
    return [*first, *(kind.__name__ for kind in catalogue()["solver"] if kind.__name__ not in [*first, "Automatic"])]


def _timed(name: str) -> tuple[str, float]:
    began = perf_counter()
    {"friction in frequency": _vibrate, "bounds of surrogates": _bound}.get(name, lambda: _move(name))()
    return name, perf_counter() - began


def _move(name: str) -> None:
    """A pendulum by an integrator, with its derivatives and energies."""
    from dalembert import multibody

    kind = getattr(multibody, name)
    solver = kind(step=1e-3) if "step" in inspect.signature(kind).parameters else kind()
    times = np.linspace(0.0, 2e-3, 3)
    model = multibody.TimeResponse(_pendulum, {"angle": (0.0, 1.0)}, ["bar.end.x"], times, solver=solver)
    model.linearise(np.array([0.5]))
    trajectory = multibody.simulate(_pendulum(0.5), times[-1], solver=solver)
    _ = trajectory.energies, trajectory.violations


def _pendulum(angle):
    from dalembert.multibody import RevoluteJoint, RigidBar, System

    system = System(gravity=(0.0, -9.81))
    bar = system.add(RigidBar("bar", length=1.0, mass=1.0, angle=angle))
    system.add(RevoluteJoint("pin", system.ground, bar.start))
    return system


def _vibrate() -> None:
    """A mass with a damper of dry friction, by harmonic balance and in time."""
    from dalembert.structure import lumped
    from dalembert.vibration import (
        Elastic,
        FrictionContact,
        HarmonicBalance,
        HarmonicForce,
        VibrationSystem,
        compare_in_time,
        frequency_response,
    )

    system = VibrationSystem(lumped({"m": 1.0}, [("m", None, 1.0, 0.04)]))
    system.add(HarmonicForce("m", 1.0))
    system.add(FrictionContact("damper", "m", friction=0.5, preload=2.0, law=Elastic(0.8)))
    curve = frequency_response(system, np.array([0.17, 0.18]), HarmonicBalance(harmonics=3), stability=True)
    compare_in_time(system, curve)


def _bound() -> None:
    """A parabola's bounds."""
    from dalembert.surrogate import ChebyshevPolynomial, bounds

    powers, coefficients = np.array([[0], [2]]), np.array([[0.5], [0.5]])
    bounds(ChebyshevPolynomial(np.array([-1.0]), np.array([1.0]), powers, coefficients), [-1.0], [0.4])
