"""Checks of systems, and of numbers that are given for them."""

from collections.abc import Sequence

import numpy as np

from dalembert.argument_readers import numbers_of
from dalembert.errors import InputError
from dalembert.structure import Structure
from dalembert.vibration.system.forces import Force
from dalembert.vibration.system.system import VibrationSystem
from dalembert.vibration.system.tabulated_force import TabulatedForce

EDGE = 1e-9
"""Distance of a frequency from the end of a table, as part of it, that is rounding."""


def require_viscous(structure: Structure, what: str) -> None:
    """Raise InputError for hysteretic damping, with which ``what``, a plural, is not defined."""
    if structure.loss is not None and abs(structure.loss).max() > 0:
        raise InputError(
            f"the structure has hysteretic damping (loss), which is defined for harmonic motions only; {what} are not "
            "defined with it. Use viscous damping instead, such as Modal(loss factor / 2)"
        )


def require_forces(forces: Sequence[Force], frequencies: np.ndarray, where: str) -> None:
    """Raise InputError for a system without forces, and for frequencies, Hz, at which a force is not known."""
    if not forces:
        raise InputError(
            f"{where}: no force acts on the system, so that it stands still; add a HarmonicForce ('[[model.force]]'), "
            "or use backbone for motions without force"
        )
    first, last = float(np.min(frequencies)), float(np.max(frequencies))
    for force in forces:
        low, high = force.range if isinstance(force, TabulatedForce) else (0.0, np.inf)
        if first < low * (1 - EDGE) or last > high * (1 + EDGE):
            raise InputError(
                f"{where}: the frequencies reach from {first:.6g} to {last:.6g} Hz, and the table of {force.where} "
                f"from {low:.6g} to {high:.6g} Hz. Extend the table, or ask for frequencies inside it"
            )


def require_still(system: VibrationSystem, where: str) -> None:
    """Raise InputError for a rotor that turns."""
    if system.structure.rotates and system.speed:
        raise InputError(
            f"{where}: the structure has a rotor that turns, which only responses over frequency take. Use "
            "frequency_response"
        )


def positive_numbers(values: object, owner: str, what: str, unit: str) -> np.ndarray:
    """Return positive numbers (count,), two different ones of a tuple; else raise InputError."""
    numbers = np.atleast_1d(numbers_of(values, owner, what))
    if numbers.ndim != 1 or not len(numbers) or not np.all(np.isfinite(numbers) & (numbers > 0)):
        raise InputError(f"{owner}: the {what} are {values}; expected positive numbers in {unit}")
    if isinstance(values, tuple) and (len(numbers) != 2 or numbers[0] == numbers[1]):
        raise InputError(f"{owner}: the ends are {values}; expected two different {what} in {unit}")
    return numbers


def values_of(values: object, owner: str, parameter: str) -> np.ndarray:
    """Return the finite values (count,) of a parameter that is varied; else raise InputError."""
    numbers = numbers_of(values, owner, "values")
    if numbers.ndim != 1 or not len(numbers) or not np.all(np.isfinite(numbers)):
        raise InputError(f"{owner}: the values of {parameter!r} are {values}; expected one or more numbers")
    return numbers
