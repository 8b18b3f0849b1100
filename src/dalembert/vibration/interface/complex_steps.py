"""Whether a vibrating system carries the complex step of its parameters, and laws of the user's that of displacements.

The numbers of a system (matrices, forces, contacts, springs) are compared with differences of the same numbers, which
needs no solution. Bases of reduced structures are held, as the complex step holds them. Laws of the user's that close
over parameters are compared at displacements of a solution.
"""

from collections.abc import Callable, Iterator, Mapping
from typing import Any

import numpy as np
from scipy.sparse import issparse

from dalembert.forward.complex_steps import check_steps
from dalembert.parameters import Parameters
from dalembert.structure.craig_bampton import CachedBases
from dalembert.structure.structure import MATRICES, Structure
from dalembert.vibration.interface.lowering import Lowered, lower
from dalembert.vibration.laws.user_element import UserElement
from dalembert.vibration.system.system import VibrationSystem

NUMBERS = ("tangential stiffness", "normal stiffness", "gap", "friction", "preload")
"""Columns of the numbers of contacts."""
FORCES = ("amplitude", "phase", "value", "moment", "scale", "displacement", "acceleration")
"""Numbers of forces."""
Part = tuple[np.ndarray, Callable[[int], str]]
"""Numbers (count,), and what each of them is."""


def check_numbers(
    builder: Callable[..., VibrationSystem], parameters: Parameters, vector: np.ndarray, thorough: bool = True
) -> None:
    """Raise where a number of a system loses the complex step of a parameter."""
    _check(builder, parameters, vector, lambda system: _parts(lower(system)), thorough)


def check_laws(
    builder: Callable[..., VibrationSystem],
    parameters: Parameters,
    vector: np.ndarray,
    displacements: Mapping[str, np.ndarray],
) -> None:
    """Raise InputError, which names the parameter and the element, where a law of the user's loses the complex step of
    a parameter. ``displacements``: of each element with such a law, over a period, m.
    """

    def forces(system: VibrationSystem) -> Iterator[Part]:
        for element in system.elements:
            if isinstance(element, UserElement) and element.name in displacements:
                values = np.asarray(element.function(displacements[element.name]))
                yield values.ravel(), lambda _, name=element.name: f"a force of {name!r}"

    if displacements:
        _check(builder, parameters, vector, forces, thorough=True)


def _check(
    builder: Callable[..., VibrationSystem],
    parameters: Parameters,
    vector: np.ndarray,
    parts: Callable[[VibrationSystem], Iterator[Part]],
    thorough: bool,
) -> None:
    bases = CachedBases()

    def numbers(vector: np.ndarray) -> list[Part]:
        arguments = [value if value.imag else value.real for value in vector.tolist()]  # one of them is complex at most
        with bases.call():
            return list(parts(builder(**parameters.arguments(arguments))))

    def place(entry: int) -> str:
        for values, name in numbers(vector):
            if entry < len(values):
                return name(entry)
            entry -= len(values)
        raise IndexError(entry)

    check_steps(
        parameters,
        vector,
        lambda at: np.concatenate([np.zeros(0), *(values for values, _ in numbers(at))]),
        place,
        thorough=thorough,
    )


def _parts(lowered: Lowered) -> Iterator[Part]:
    structure = lowered.structure
    for name in MATRICES:
        matrix = getattr(structure, name)
        if matrix is not None:
            yield _entries(matrix), lambda entry, name=name, matrix=matrix: _entry(structure, name, matrix, entry)
    for force in lowered.forces:
        names = [name for name in FORCES if hasattr(force, name)]
        values = np.array([getattr(force, name) for name in names])
        yield values, lambda entry, names=names, where=force.where: f"{names[entry]!r} of {where}"
    if not isinstance(lowered.speed, str):
        yield np.array([lowered.speed]), lambda _: "the speed of the rotor"
    for block in lowered.blocks:
        names = [lowered.contacts[place] for place in block.contacts]
        yield (
            block.numbers.ravel(),
            lambda entry, names=names: f"{NUMBERS[entry % len(NUMBERS)]!r} of {names[entry // len(NUMBERS)]!r}",
        )
    for block in lowered.laws:
        owners = [f"{number!r} of {name!r}" for name in block.names for number in list(block.element.numbers)]
        yield block.numbers.ravel(), lambda entry, owners=owners: owners[entry]


def _entries(matrix: Any) -> np.ndarray:
    """Entries of a matrix; of a sparse one its product with a vector, since its pattern may change."""
    return matrix @ np.random.default_rng(0).uniform(0.5, 1.0, matrix.shape[0]) if issparse(matrix) else matrix.ravel()


def _entry(structure: Structure, name: str, matrix: Any, entry: int) -> str:
    names = structure.dofs.names
    if issparse(matrix):
        return f"the {name} of the structure at {names[entry]!r}"
    first, second = divmod(entry, structure.size)
    return f"the {name} of the structure between {names[first]!r} and {names[second]!r}"
