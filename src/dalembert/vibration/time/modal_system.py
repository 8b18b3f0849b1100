r"""From a vibrating system to arrays for integration in time: modes of its structure, cells and springs in it.

The modes are those of the pencil :math:`(M, M + K/\omega^2)`, which also has them where some of the mass, or of the
stiffness, is missing.
"""

import ctypes
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from scipy.linalg import LinAlgError, eigh

from dalembert.errors import ModelError
from dalembert.structure.eigenmodes import dense
from dalembert.vibration.fourier import Fourier
from dalembert.vibration.interface.condensation import DENSE, coupled
from dalembert.vibration.interface.lowering import ELASTIC, Lowered
from dalembert.vibration.laws.friction_law import NORMAL, TANGENTIAL
from dalembert.vibration.system.requirements import require_viscous
from dalembert.vibration.time.elements import Elements, Ruled
from dalembert.vibration.time.steps import ModalStructure, Scheme

MASSLESS = 1e-12
"""Mass of a mode, as part of its mass and stiffness, below which it has no inertia of its own."""
_C_FUNCTION = ctypes.CFUNCTYPE(None, ctypes.c_void_p, ctypes.c_void_p, ctypes.c_void_p)


@dataclass(frozen=True)
class Spectral:
    """A structure in its modes. ``shapes`` (n, modes); ``mass``, ``stiffness``, ``damping`` (modes,): diagonals;
    ``coupled`` (modes, modes) or (0, 0): the damping where it couples modes.
    """

    shapes: np.ndarray
    mass: np.ndarray
    stiffness: np.ndarray
    damping: np.ndarray
    coupled: np.ndarray

    def accelerations(self, force: np.ndarray, place: np.ndarray, velocity: np.ndarray) -> np.ndarray:
        """Of the modes (modes,) under forces on them; none of those without mass."""
        damping = self.coupled @ velocity if len(self.coupled) else self.damping * velocity
        heavy = self.mass > MASSLESS
        return np.where(heavy, force - damping - self.stiffness * place, 0.0) / np.where(heavy, self.mass, 1.0)


def spectral(lowered: Lowered, omega: float) -> Spectral:
    """Modes of a structure, normalised to 1 in mass and stiffness/ω²."""
    structure, speed = lowered.structure, lowered.spin(omega)[0]
    if structure.size > DENSE:
        raise ModelError(
            f"the structure has {structure.size} degrees of freedom, too many to be integrated in time (at most "
            f"{DENSE}); reduce it with craig_bampton"
        )
    require_viscous(structure, "motions in time")
    matrices = (structure.mass, structure.stiffness, structure.damping)
    mass, stiffness, damping = (
        np.real(dense(matrix)) for matrix in (*matrices[:2], matrices[0] * 0.0 if matrices[2] is None else matrices[2])
    )
    try:
        # M + K/ω² is positive definite even where M or K is singular; its modes diagonalise both matrices.
        shapes = eigh(mass, mass + stiffness / omega**2)[1]
    except LinAlgError:
        raise ModelError(
            "the structure has degrees of freedom with neither mass nor stiffness, or with negative ones, and cannot "
            "be integrated in time; give them some mass or a spring"
        ) from None
    circulatory = structure.circulatory
    if circulatory is not None and speed and abs(circulatory).max() > 0:
        raise ModelError(
            "the structure has circulatory forces, such as those of damping that turns with a rotor, which motions in "
            "time do not take here. Use frequency_response"
        )
    if structure.gyroscopic is not None:
        damping = damping + speed * np.real(dense(structure.gyroscopic))
    # Damping that couples these modes is kept whole: nothing is approximated.
    modal = shapes.T @ damping @ shapes
    inertia, hold = (np.einsum("ij,ij->j", shapes, matrix @ shapes) for matrix in (mass, stiffness))
    return Spectral(shapes, inertia, hold, np.diag(modal).copy(), modal if coupled(modal) else np.zeros((0, 0)))


@dataclass(frozen=True)
class ModalSystem:
    """A lowered system in its modes, at one frequency. ``lowered``: real; ``steps``: of a period; ``stand_in``:
    stiffness of the springs in place of rigid contacts, in multiples of the penalties.
    """

    lowered: Lowered
    omega: float
    steps: int
    stand_in: float

    @cached_property
    def spectral(self) -> Spectral:
        """The structure's modes."""
        return spectral(self.lowered, self.omega)

    @cached_property
    def places(self) -> np.ndarray:
        """Row of the lowered system that each column of a cell, and each row of an element, sees: (rows,) of these."""
        cells = [block.rows.ravel() for block in (*self.lowered.blocks, *self.lowered.laws)]
        return np.concatenate(
            [np.zeros(0, dtype=int), *cells, *(function_rows for function_rows, _ in self.lowered.functions)]
        )

    @cached_property
    def seen(self) -> np.ndarray:
        """What elements see of the modes, (rows, modes)."""
        return np.ascontiguousarray((self.lowered.matrix @ self.spectral.shapes)[self.places])

    @cached_property
    def forces(self) -> np.ndarray:
        """On the modes at the steps' ends, (steps, modes); those of the last end are those of the period's start."""
        highest = max((force.harmonic for force in self.lowered.forces), default=0)
        series = Fourier(tuple(range(max(highest, 1) + 1)), self.steps)
        # Forces at the ends of steps: sample t + 1 in row t.
        loads = np.real(self.lowered.load_coefficients(series, self.omega))
        samples = series.synthesis @ (loads.T @ self.spectral.shapes)
        return np.ascontiguousarray(np.roll(samples, -1, axis=0))

    def arrays(self, scheme: Scheme) -> tuple[ModalStructure, Elements]:
        """Arrays of the structure for a method, and of the elements with matched stiffnesses."""
        modal, seen = self.spectral, self.seen
        ratio = (1 - scheme.alpha_f) / (1 - scheme.alpha_m)
        by_place, by_velocity = scheme.beta * scheme.step**2 * ratio, scheme.gamma * scheme.step * ratio
        # S = M + g C + b K: its inverse is a diagonal in modes, if damping does not couple them, so that a step costs
        # as much as it has modes and rows.
        inverse = 1 / (modal.mass + by_velocity * modal.damping + by_place * modal.stiffness)
        solver = modal.coupled
        if len(solver):
            solver = np.linalg.inv(np.diag(modal.mass + by_place * modal.stiffness) + by_velocity * modal.coupled)
        pushed = solver @ seen.T if len(solver) else inverse[:, None] * seen.T
        compliance = by_place * (seen @ pushed)
        # Contacts are matched to the compliance behind them: a single stiff contact then needs one iteration, whatever
        # its stiffness is.
        elements, shifts = _matched(self.elements, np.diag(compliance))
        modes = ModalStructure(
            modal.mass, modal.damping, modal.stiffness, inverse, modal.coupled, solver, seen,
            np.ascontiguousarray(pushed.T),
            np.ascontiguousarray(compliance - np.diag(shifts)), self.forces,
        )  # fmt: skip
        return modes, elements

    @cached_property
    def elements(self) -> Elements:
        """Arrays of the elements."""
        blocks = self.lowered.blocks
        rows, numbers, at = [np.zeros((0, 3), dtype=int)], [np.zeros((0, 5))], 0
        for block in blocks:
            block_rows = at + np.arange(block.rows.size).reshape(block.rows.shape)
            at += block.rows.size
            rows.append(np.pad(block_rows, ((0, 0), (0, 3 - block.rows.shape[1]))))
            numbers.append(block.numbers.astype(float))
            if block.kind != ELASTIC:
                # Rigid contacts become stiff springs; the error falls with the inverse of their stiffness.
                numbers[-1][:, [TANGENTIAL, NORMAL]] *= self.stand_in
        return Elements(
            rows=np.concatenate(rows),
            tangents=np.array([block.tangents for block in blocks for _ in block.rows], dtype=np.int64),
            normal=np.array([block.normal for block in blocks for _ in block.rows], dtype=np.int64),
            numbers=np.concatenate(numbers),
            contacts=np.concatenate([np.zeros(0, dtype=int), *(block.contacts for block in blocks)]),
            ruled=self._ruled(at),
        )

    def _ruled(self, at: int) -> Ruled:
        """Elements that follow a law; their rows are those from ``at`` on."""
        laws, layout, rows, numbers, number, state = [], [], [], [np.zeros(0)], 0, 0
        for block in self.lowered.laws:
            columns = block.rows.shape[1]
            for values in block.numbers:
                laws.append(block.law.address)
                layout.append([columns, len(values), block.states, number, state])
                rows.append(at + np.arange(columns))
                numbers.append(values)
                at, number, state = at + columns, number + len(values), state + block.states
        widest = max((len(row) for row in rows), default=0)
        most = max((block.states for block in self.lowered.laws), default=0)
        u, v, force = np.zeros((3, widest), complex)
        return Ruled(
            np.array(laws, dtype=np.int64), np.array(layout, dtype=np.int64).reshape(-1, 5),
            np.array([np.pad(row, (0, widest - len(row))) for row in rows], dtype=np.int64).reshape(len(rows), widest),
            np.concatenate(numbers).astype(complex), u, v, np.zeros(most, complex), force,
        )  # fmt: skip

    def users(self, failures: list[Exception]) -> Any:
        """The laws of the user's as a C function, a null pointer without any; what they raise is kept."""
        laws, end = [], len(self.places)
        for law_rows, element in reversed(self.lowered.functions):  # their rows are the last ones
            # Compiled steps call Python through one C function: its rows are the last ones, filled from the end.
            laws.insert(0, (np.arange(end - len(law_rows), end), element.law))
            end -= len(law_rows)
        return _C_FUNCTION(_trampoline(laws, len(self.places), failures)) if laws else _C_FUNCTION()


def _matched(elements: Elements, compliance: np.ndarray) -> tuple[Elements, np.ndarray]:
    r"""Return elements whose cells have the stiffness of what is behind them, and the shifts of their displacements
    (rows,), :math:`1/\rho - 1/k`; 0 where there is no cell. A cell of stiffness k at u says of its force what one of
    stiffness :math:`\rho` says at :math:`u + (1/\rho - 1/k) \lambda`. With :math:`1/\rho = y + 1/k` and y the
    compliance of a step behind it, a single contact is solved at once, whatever k is.
    """
    numbers, shifts = elements.numbers.copy(), np.zeros(len(compliance))
    for cell, rows, tangents, normal in zip(numbers, elements.rows, elements.tangents, elements.normal, strict=True):
        # One stiffness for both tangents, as the law has only one: the larger compliance, with which Newton's method
        # converges.
        behind = compliance[rows[:tangents]].max()
        # d = u + (1/rho - 1/k) λ, with 1/rho - 1/k = y.
        shifts[rows[:tangents]] = behind
        cell[TANGENTIAL] = 1 / (behind + 1 / cell[TANGENTIAL])
        if normal:
            shifts[rows[tangents]] = compliance[rows[tangents]]
            cell[NORMAL] = 1 / (compliance[rows[tangents]] + 1 / cell[NORMAL])
    return elements._replace(numbers=numbers), shifts


def _trampoline(
    laws: Sequence[tuple[np.ndarray, Callable]], rows: int, failures: list[Exception]
) -> Callable[[int, int, int], None]:
    def call(place: int, force: int, slopes: int) -> None:
        u, into, matrix = _view(place, rows), _view(force, rows), _view(slopes, rows * rows).reshape(rows, rows)
        try:
            for law_rows, law in laws:
                values, changes = law(u[law_rows][:, None])
                np.add.at(into, law_rows, values[:, 0])
                np.add.at(matrix, (law_rows[:, None], law_rows[None, :]), changes[:, :, 0])
        # NaN ends Newton's method of the step; the error is raised behind the compiled code.
        except Exception as error:  # must not cross the compiled code
            failures.append(error)
            into[:] = np.nan

    return call


def address(function: Any) -> int:
    """Address of a C function; 0 of a null pointer."""
    return ctypes.cast(function, ctypes.c_void_p).value or 0


def _view(address: int, count: int) -> np.ndarray:
    return np.ctypeslib.as_array((ctypes.c_double * count).from_address(address))
