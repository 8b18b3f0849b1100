"""Checks of systems, and of numbers that are given for them."""

import numpy as np

from dalembert.arguments import numbers_of
from dalembert.errors import InputError
from dalembert.structure import Structure


def require_viscous(structure: Structure, what: str) -> None:
    """Refuse a structure with hysteretic damping where motions are not periodic of a given frequency.

    ``what``: what is not defined with it, in the plural. Raises InputError.
    """
    if structure.loss is not None and abs(structure.loss).max() > 0:
        raise InputError(
            f"the structure has hysteretic damping (loss), which is defined for harmonic motions only; {what} are not "
            "defined with it. Use viscous damping instead, such as Modal(loss factor / 2)"
        )


def require_force(forces: list, where: str) -> None:
    """Refuse a system without forces.

    Raises InputError.
    """
    if not forces:
        raise InputError(
            f"{where}: no force acts on the system, so that it stands still; add a HarmonicForce ('[[model.force]]'), "
            "or use backbone for motions without force"
        )


def positive_numbers(given: object, owner: str, what: str, unit: str) -> np.ndarray:
    """Return positive numbers (count,), two different ones of a tuple.

    Raises InputError.
    """
    numbers = np.atleast_1d(numbers_of(given, owner, what))
    if numbers.ndim != 1 or not len(numbers) or not np.all(np.isfinite(numbers) & (numbers > 0)):
        raise InputError(f"{owner}: the {what} are {given}; expected positive numbers in {unit}")
    if isinstance(given, tuple) and (len(numbers) != 2 or numbers[0] == numbers[1]):
        raise InputError(f"{owner}: the ends are {given}; expected two different {what} in {unit}")
    return numbers


def values_of(given: object, owner: str, parameter: str) -> np.ndarray:
    """Return the values (count,) of a parameter that is varied.

    Raises InputError.
    """
    values = numbers_of(given, owner, "values")
    if values.ndim != 1 or not len(values) or not np.all(np.isfinite(values)):
        raise InputError(f"{owner}: the values of {parameter!r} are {given}; expected one or more numbers")
    return values
