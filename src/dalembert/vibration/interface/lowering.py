"""From a vibrating system to arrays: the rows that its elements see, their numbers, its loads."""

import hashlib
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np
from scipy.sparse import csc_array, vstack

from dalembert.errors import InputError, ModelError
from dalembert.structure import Structure
from dalembert.structure.structure import MATRICES
from dalembert.vibration.fourier import Fourier
from dalembert.vibration.interface.coordinates import Coordinates, coordinates
from dalembert.vibration.interface.loads import Loads, load_coefficients, loads
from dalembert.vibration.laws.contacts import ElasticSlider, FrictionContact, Rigid
from dalembert.vibration.laws.element import LawElement
from dalembert.vibration.laws.friction_law import NORMAL, TANGENTIAL, sliding
from dalembert.vibration.laws.law_block import LawBlock
from dalembert.vibration.laws.user_element import UserElement
from dalembert.vibration.laws.user_law import UserLaw
from dalembert.vibration.system.forces import Force
from dalembert.vibration.system.system import SYNCHRONOUS, VibrationSystem

ELASTIC = "elastic"


@dataclass(frozen=True)
class FrictionBlock:
    """Sliders of one shape and one kind of law. ``kind``: "elastic", "displacement", "velocity"; ``rows``
    (cells, tangents + normal): among all elements' rows; ``contacts`` (cells,): contact of each cell; ``numbers``
    (cells, 5): as :mod:`dalembert.vibration.laws.friction_law` takes them; stiffnesses of rigid contacts are penalties.
    """

    kind: str
    tangents: int
    normal: bool
    rows: np.ndarray
    contacts: np.ndarray
    numbers: np.ndarray

    @property
    def memory(self) -> bool:
        """Whether the slider remembers."""
        return self.kind != "velocity"

    @property
    def ruled(self) -> LawBlock:
        """Elastic contacts as elements that follow a general law."""
        return LawBlock(UserLaw("slider", "", function=sliding, internal=self.tangents), (), self.rows, self.numbers)


def penalties(block: FrictionBlock) -> np.ndarray:
    """Penalty of each row of a block, (cells, columns)."""
    columns = [block.numbers[:, TANGENTIAL]] * block.tangents + [block.numbers[:, NORMAL]] * block.normal
    return np.stack(columns, axis=1)


def law_numbers(block: FrictionBlock) -> np.ndarray:
    """Numbers of a block's law; one that is given forces for displacements has a unit stiffness."""
    numbers = np.ascontiguousarray(block.numbers, dtype=np.result_type(float, block.numbers))
    if not block.memory:
        numbers = numbers.copy()
        numbers[:, TANGENTIAL] = 1.0
    return numbers


@dataclass(frozen=True)
class Lowered:
    """A vibrating system as arrays. ``row_names``: names of the coordinates that elements see, such as ``"foot.x"``;
    ``matrix`` (rows, n); ``contacts``: names of the friction contacts; ``functions``: rows of each element whose law is
    a function of arrays; ``speed``: of the rotor parts, rad/s, or "synchronous";
    ``periods``: of the excitation in a period of the motion; ``measured``: row of a degree of freedom whose response is
    measured, if there is one; ``added``: whether no element sees that row, so that it was added as the last one.
    """

    structure: Structure
    forces: tuple[Force, ...]
    row_names: tuple[str, ...]
    matrix: csc_array
    contacts: tuple[str, ...]
    blocks: tuple[FrictionBlock, ...]
    laws: tuple[LawBlock, ...]
    functions: tuple[tuple[np.ndarray, UserElement], ...]
    speed: complex | str = 0.0
    periods: int = 1
    measured: int | None = None
    added: bool = False

    def measuring(self, dof: int) -> "Lowered":
        """The same with a row of a degree of freedom, so that its displacement is known where those of elements are."""
        entries, column = np.diff(self.matrix.tocsr().indptr), self.matrix[:, [dof]].toarray()[:, 0]
        # Rows of rigid contacts may have another unknown than their displacement.
        rigid = [block.rows.ravel() for block in self.blocks if block.kind != ELASTIC]
        known = np.setdiff1d(np.flatnonzero((entries == 1) & (column == 1)), np.concatenate([[], *rigid]))
        if len(known):
            return replace(self, measured=int(known[0]))
        unit = csc_array(([1.0], ([0], [dof])), shape=(1, self.structure.size))
        names = (*self.row_names, self.structure.dofs.names[dof])
        matrix = csc_array(vstack([self.matrix, unit]))
        return replace(self, row_names=names, matrix=matrix, measured=len(names) - 1, added=True)

    @property
    def seen(self) -> int:
        """Number of the rows that elements see, which are the first."""
        return len(self.row_names) - self.added

    @cached_property
    def coordinates(self) -> Coordinates:
        """Retained and interior coordinates; the rows of rigid contacts are retained ones themselves."""
        rigid = [block.rows.ravel() for block in self.blocks if block.kind != ELASTIC]
        first = np.concatenate(rigid) if rigid else np.zeros(0, dtype=int)
        result = coordinates(self.matrix, first)
        for row in first:
            if row not in result.rows:
                raise ModelError(
                    f"the rigid contact coordinate {self.row_names[row]!r} moves only together with other rigid "
                    "contacts, so their forces are not determined. Remove one of them, or choose an elastic law"
                )
        return result

    def loads(self, series: Fourier) -> Loads:
        """Forces over the excitation frequency, real."""
        return loads(self.forces, self.structure, series, self.periods)

    def load_coefficients(self, series: Fourier, omega: float) -> np.ndarray:
        """Coefficients of the forces on all degrees of freedom at ω, (n, coefficients)."""
        return load_coefficients(self.forces, self.structure, series, omega, self.periods)

    def spin(self, omega: float) -> tuple[Any, float]:
        """Speed of the rotor at a frequency of the motion, both in rad/s, and its derivative by that."""
        return (self.periods * omega, self.periods) if self.speed == SYNCHRONOUS else (self.speed, 0.0)

    @property
    def real(self) -> "Lowered":
        """The same without the parts that are directions of derivatives."""
        speed = self.speed if isinstance(self.speed, str) else float(np.real(self.speed))
        return replace(self, blocks=tuple(map(_real, self.blocks)), laws=tuple(map(_real, self.laws)), speed=speed)

    def fingerprint(self, method: object, *more: object) -> str:
        """Hash of a system's matrices, forces and elements, of the method, and of what else there is."""
        structure = self.structure
        digest = hashlib.sha256(repr((*more, method)).encode())
        names = structure.dofs.names, self.row_names, self.contacts
        digest.update(repr((*names, self.forces, self.speed, self.periods)).encode())
        matrices = {name: getattr(structure, name) for name in MATRICES} | {"rows": self.matrix}
        if structure.base_inertia is not None:
            digest.update(structure.base_inertia.tobytes())
        for name, matrix in matrices.items():
            if matrix is None:
                continue
            digest.update(name.encode())
            digest.update(np.asarray(matrix @ np.linspace(0.5, 1.5, structure.size)).tobytes())
        for block in self.blocks:
            digest.update(repr((block.kind, block.tangents, block.normal)).encode() + block.numbers.tobytes())
        for block in self.laws:
            digest.update(repr((block.law.digest, block.states, block.names)).encode() + block.numbers.tobytes())
        for rows, element in self.functions:
            probe = np.linspace(-1.0, 1.0, 7 * len(rows)).reshape(len(rows), 7)
            digest.update(np.asarray(element.law(probe)[0]).tobytes())
        return digest.hexdigest()


def lower(system: VibrationSystem) -> Lowered:
    """Arrays of a system."""
    rows, names = _Rows(system.structure), []
    cells: dict[tuple[str, int, bool], list[tuple[list[int], int, list]]] = {}
    laws: dict[tuple, list[tuple[LawElement, list[int]]]] = {}
    functions = []
    for element in system.elements:
        where = f"element {element.name!r}"
        if isinstance(element, FrictionContact):
            normal = [element.normal] if element.normal is not None else []
            element_rows = [rows.contact(element, direction) for direction in (*element.tangential, *normal)]
            kind = element.law.prediction if isinstance(element.law, Rigid) else ELASTIC
            key = kind, len(element.tangential), bool(normal)
            for numbers in _numbers(element, element_rows, rows):
                cells.setdefault(key, []).append((element_rows, len(names), numbers))
            names.append(element.name)
        elif isinstance(element, UserElement):
            element_rows = [rows.between(f"{element.name}.{dof}", dof, None, where) for dof in element.dofs]
            functions.append((np.array(element_rows), element))
        else:
            single = len(element.ends) == 1
            element_rows = [
                rows.between(element.name if single else f"{element.name}.{first}", first, second, where)
                for first, second in element.ends
            ]
            key = type(element), element.law, element.events, element.states, len(element_rows), tuple(element.numbers)
            laws.setdefault(key, []).append((element, element_rows))
    for dof in (dof for force in system.forces for dof in force.dofs):
        system.structure.dofs.index(dof, "a force")
    blocks = tuple(
        FrictionBlock(*key, *(np.array(column) for column in zip(*entries, strict=True)))
        for key, entries in cells.items()
    )
    ruled = tuple(
        LawBlock(
            entries[0][0], tuple(element.name for element, _ in entries), np.array([rows_of for _, rows_of in entries]),
            np.array([list(element.numbers.values()) for element, _ in entries]),
        )
        for entries in laws.values()
    )  # fmt: skip
    return Lowered(
        system.structure, tuple(system.forces), tuple(rows.names), rows.matrix(), tuple(names), blocks, ruled,
        tuple(functions), system.speed,
    )  # fmt: skip


class _Rows:
    """Rows of relative displacements, as they are asked for."""

    def __init__(self, structure: Structure) -> None:
        self.structure = structure
        self.names: list[str] = []
        self.entries: list[dict[int, float]] = []

    def contact(self, element: FrictionContact, direction: str) -> int:
        """Row of a contact along one of its directions."""
        sign, axis = (-1.0 if direction.startswith("-") else 1.0), direction.removeprefix("-")
        second = None if element.second is None else f"{element.second}.{axis}"
        name, where = f"{element.name}.{axis}", f"contact {element.name!r}"
        return self.between(name, f"{element.first}.{axis}", second, where, sign)

    def between(self, name: str, first: str, second: str | None, where: str, sign: float = 1.0) -> int:
        """Row of the difference of two degrees of freedom, times a sign."""
        entries = {self.structure.dofs.index(first, where): sign}
        if second is not None:
            end = self.structure.dofs.index(second, where)
            if end in entries:
                raise InputError(
                    f"{where} is between {first!r} and itself; expected two degrees of freedom, or one and the ground"
                )
            entries[end] = -sign
        self.names.append(name)
        self.entries.append(entries)
        return len(self.names) - 1

    def matrix(self) -> csc_array:
        rows = [row for row, entries in enumerate(self.entries) for _ in entries]
        columns = [column for entries in self.entries for column in entries]
        values = [value for entries in self.entries for value in entries.values()]
        return csc_array((values, (rows, columns)), shape=(len(self.entries), self.structure.size), dtype=float)

    def penalty(self, row: int) -> object:
        """Stiffness of the structure behind a row, with everything else held: springs of its ends in series."""
        diagonal = self.structure.stiffness.diagonal()
        stiffnesses = [diagonal[place] for place in self.entries[row]]
        if not all(stiffness.real > 0 for stiffness in stiffnesses):
            raise ModelError(
                f"the rigid contact coordinate {self.names[row]!r} lies on a degree of freedom without stiffness; "
                "give its law Rigid(penalty=...) in N/m, about the stiffness of the structure there"
            )
        # Both ends in series, each with everything else held: the diagonal of K. To harmonics above the kept ones the
        # penalty answers in place of the structure, so that its stiffness leaves the smallest error
        # (docs/theory/harmonic-balance.md, "What the penalty does").
        return 1 / sum(1 / stiffness for stiffness in stiffnesses)


def _real(block: Any) -> Any:
    return replace(block, numbers=np.ascontiguousarray(np.real(block.numbers), dtype=float))


def _numbers(element: FrictionContact, element_rows: list[int], rows: _Rows) -> list[list]:
    law = element.law
    if isinstance(law, Rigid):
        penalties = [
            law.penalty if law.penalty is not None else rows.penalty(row) for row in (element_rows[0], element_rows[-1])
        ]
        return [[*penalties, law.gap, element.friction, element.preload]]
    normal = law.normal_stiffness if law.normal_stiffness is not None else 0.0
    if isinstance(law, ElasticSlider):
        return [[law.tangential_stiffness, normal, law.gap, element.friction, element.preload]]
    return [
        [stiffness, share * normal, law.gap, element.friction, share * element.preload]
        for stiffness, share in zip(law.stiffnesses, law.shares, strict=True)
    ]
