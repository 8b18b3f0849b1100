r"""Fourier coefficients of the forces of any law, with their exact derivatives.

Alternating frequency and time: the law goes through the samples of the motion, period after period from rest, until its
internal state returns. Derivatives come from complex steps through all of these periods,
:math:`\partial\lambda/\partial U_k = \Im\,\lambda(u + i\eta\,\cos k\tau)/\eta`.
"""

from dataclasses import dataclass
from functools import partial
from typing import NamedTuple, Protocol

import numpy as np

from dalembert.errors import InputError
from dalembert.forward.complex_steps import DROPPING, attempted, lost_step
from dalembert.kernels.kernel import inner, kernel
from dalembert.kernels.words import Address, Complexes, Complexes2, Complexes3, Reals, Reals2, Reals4
from dalembert.vibration.balance.fourier import Fourier
from dalembert.vibration.laws.law import Law, call_law

SWEEPS = 200
"""Periods after which a state is taken as it is."""
PLAIN = 3
"""Periods before a state that converges slowly is extrapolated, which is done every second period."""
FAST, SLOW = 0.05, 1 - 1e-9
"""Ratios of the changes over two periods between which a state is extrapolated."""
NOISE = 1e-11
"""Change of a state over a period, as part of its size, that is too small to extrapolate."""
SETTLED = 1e-13
"""Change of a state over a period, as part of its largest value, at which it is periodic."""
STEP = 1e-30
"""Size of the imaginary step; second-order terms vanish below the rounding of the first."""


class Room(NamedTuple):
    """Room for one element: vectors of columns, and of internal numbers."""

    u: Complexes
    v: Complexes
    force: Complexes
    state: Complexes
    before: Complexes
    change: Complexes
    largest: Reals

    @classmethod
    def of(cls, columns: int, states: int) -> "Room":
        """Room for so many columns and internal numbers."""
        u, v, force = np.zeros((3, columns), complex)
        state, before, change = np.zeros((3, states), complex)
        return cls(u, v, force, state, before, change, np.zeros(states))


class Motion(NamedTuple):
    """Displacements and velocities of an element (columns, samples), and a direction of differentiation.

    Column ``column`` moves by ``wave`` and its velocity by ``rate``, each (samples,); none does if it is negative.
    """

    place: Complexes2
    velocity: Complexes2
    column: int
    wave: Reals
    rate: Reals


@inner
def _returned(room):
    """Whether the state has changed over a period, in either part, by no more than rounding."""
    for i in range(len(room.state)):
        change = room.state[i] - room.before[i]
        if abs(change.real) > SETTLED * room.largest[i] or abs(change.imag) > 1e-10 * abs(room.state[i].imag):
            return False
    return True


@inner
def _act(law, motion, t, numbers, room):
    """The law at a sample."""
    for i in range(len(room.u)):
        room.u[i], room.v[i] = motion.place[i, t], motion.velocity[i, t]
    if motion.column >= 0:
        room.u[motion.column] += 1j * STEP * motion.wave[t]
        room.v[motion.column] += 1j * STEP * motion.rate[t]
    call_law(law, room.u, room.v, room.state, numbers, room.force)


@inner
def _ahead(change, last, size):
    """What Aitken's extrapolation adds to a value that changed by ``change`` over a period, by ``last`` before."""
    if abs(change) <= NOISE * size or last == 0.0:
        return 0.0
    ratio = change / last
    return change * ratio / (1.0 - ratio) if FAST < ratio < SLOW else 0.0


@inner
def _extrapolate(room):
    """Move a state that converges slowly to where it converges, real parts and derivatives apart."""
    for i in range(len(room.state)):
        change, last = room.state[i] - room.before[i], room.change[i]
        real = _ahead(change.real, last.real, room.largest[i])
        room.state[i] += real + 1j * _ahead(change.imag, last.imag, abs(room.state[i].imag))


@inner
def _periods(law, motion, numbers, room, result):
    """Periods from rest until the state returns; writes the forces (columns, samples) of the last one."""
    room.state[:] = 0.0
    room.largest[:] = 0.0
    for sweep in range(SWEEPS if len(room.state) else 1):
        for i in range(len(room.state)):
            room.before[i] = room.state[i]
        for t in range(result.shape[1]):
            _act(law, motion, t, numbers, room)
            for i in range(len(room.u)):
                result[i, t] = room.force[i]
            for i in range(len(room.state)):
                room.largest[i] = max(room.largest[i], abs(room.state[i].real))
        if _returned(room):
            break
        if sweep >= PLAIN and sweep % 2 == 1:
            _extrapolate(room)
        for i in range(len(room.state)):
            room.change[i] = room.state[i] - room.before[i]


@kernel
def law_forces(
    law: Address, numbers: Complexes2, place: Complexes3, velocity: Complexes3, none: Reals, room: Room,
    result: Complexes3,
) -> None:  # fmt: skip
    """Forces (elements, columns, samples) over the period."""
    for e in range(len(place)):
        _periods(law, Motion(place[e], velocity[e], -1, none, none), numbers[e], room, result[e])


@inner
def _along(law, motion, numbers, room, trial, slope):
    """Derivative of the forces (columns, samples) in the motion's direction."""
    _periods(law, motion, numbers, room, trial)
    for i in range(slope.shape[0]):
        for t in range(slope.shape[1]):
            slope[i, t] = trial[i, t].imag / STEP


@inner
def _spread(slope, waves, slopes):
    """Add a derivative at samples (columns, samples), times waves, to those by coefficients."""
    for k in range(len(waves)):
        for i in range(slope.shape[0]):
            for t in range(slope.shape[1]):
                slopes[k, i, t] += slope[i, t] * waves[k, t]


@kernel
def law_slopes(
    law: Address, numbers: Complexes2, place: Complexes3, velocity: Complexes3, waves: Reals2, rates: Reals2,
    units: Reals2, slope: Reals2, room: Room, result: Complexes3, slopes: Reals4,
) -> None:  # fmt: skip
    """Forces (elements, columns, samples), their derivatives by coefficients (elements, unknowns, columns, samples).

    ``waves`` and ``rates`` (coefficients, samples): what a unit of each coefficient adds to displacements and
    velocities, no rates if forces do not depend on velocities. ``units`` (2, samples): ones and zeros. ``slope``
    (columns, samples) is room.
    """
    count = len(waves)
    for e in range(len(place)):
        for column in range(len(room.u)):
            own = slopes[e, column * count : (column + 1) * count]
            if len(room.state) == 0:  # a sample's force depends on its own displacement and velocity alone
                own[:] = 0.0
                if len(rates):
                    motion = Motion(place[e], velocity[e], column, units[1], units[0])
                    _along(law, motion, numbers[e], room, result[e], slope)
                    _spread(slope, rates, own)
                motion = Motion(place[e], velocity[e], column, units[0], units[1])
                _along(law, motion, numbers[e], room, result[e], slope)
                _spread(slope, waves, own)
                continue
            for k in range(count):
                rate = rates[k] if len(rates) else units[1]
                motion = Motion(place[e], velocity[e], column, waves[k], rate)
                _along(law, motion, numbers[e], room, result[e], own[k])


@kernel
def law_samples(
    law: Address, numbers: Complexes, motion: Motion, room: Room, trial: Complexes2, moved: Complexes, slopes: Reals4
) -> None:
    """Derivatives of forces and next state by displacement, velocity and state before, at each sample of one element.

    ``slopes`` (1, samples, columns + states, 2 columns + states); ``trial`` (columns, samples) and ``moved`` (states,)
    are room.
    """
    columns, states = len(room.u), len(room.state)
    _periods(law, motion, numbers, room, trial)
    for t in range(trial.shape[1]):
        for direction in range(2 * columns + states):
            for i in range(columns):
                room.u[i], room.v[i] = motion.place[i, t], motion.velocity[i, t]
            for i in range(states):
                moved[i] = room.state[i]
            if direction < columns:
                room.u[direction] += 1j * STEP
            elif direction < 2 * columns:
                room.v[direction - columns] += 1j * STEP
            else:
                moved[direction - 2 * columns] += 1j * STEP
            call_law(law, room.u, room.v, moved, numbers, room.force)
            for i in range(columns):
                slopes[0, t, i, direction] = room.force[i].imag / STEP
            for i in range(states):
                slopes[0, t, columns + i, direction] = moved[i].imag / STEP
        _act(law, motion, t, numbers, room)


class Sums(Protocol):
    """Forces of the elements of a block from their displacements (elements, columns, coefficients) and ω."""

    def forces(self, displacements: np.ndarray, omega: float) -> np.ndarray:
        """Coefficients of forces, as those of displacements; complex numbers too."""
        ...

    def with_slopes(self, displacements: np.ndarray, omega: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """The same, Jacobians (elements, columns · coefficients, columns · coefficients), and derivatives by ω."""
        ...


@dataclass(frozen=True)
class LawSums:
    """Sums of samples, of any law.

    Parameters
    ----------
    name : str
        Of an element, for messages.
    law : Law
    numbers : array, shape (elements, numbers)
    states : int
        Internal numbers of an element.
    rated : bool
        Whether forces depend on velocities.
    series : Fourier
    """

    name: str
    law: Law
    numbers: np.ndarray
    states: int
    rated: bool
    series: Fourier

    def forces(self, displacements: np.ndarray, omega: float) -> np.ndarray:
        """Coefficients of forces; see :class:`Sums`."""
        force = self._sampled(*self._moved(displacements, omega)) @ self.series.analysis.T
        return force if np.iscomplexobj(displacements) or np.iscomplexobj(self.numbers) else np.real(force)

    def with_slopes(self, displacements: np.ndarray, omega: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Coefficients of forces, Jacobians and derivatives by ω; see :class:`Sums`."""
        if not self.law.packaged:
            _compare(self, displacements, omega)
        (elements, columns, count), series = displacements.shape, self.series
        unknowns = columns * count
        moved, rate = self._moved(displacements, omega)
        slopes = np.empty((elements, unknowns, columns, series.samples))
        turn = omega * series.waves[1].T if self.rated else np.zeros((0, series.samples))
        units = np.stack([np.ones(series.samples), np.zeros(series.samples)])
        force = np.empty_like(moved)
        law_slopes(
            self.law.address, self._complex, moved, rate, np.ascontiguousarray(series.synthesis.T),
            np.ascontiguousarray(turn), units, np.empty((columns, series.samples)), Room.of(columns, self.states),
            force, slopes,
        )  # fmt: skip
        local = (slopes.reshape(-1, series.samples) @ series.analysis.T).reshape(elements, unknowns, columns, count)
        by_omega = np.zeros(displacements.shape)
        if self.rated and omega:  # a velocity ω u' grows with ω at unchanged displacements
            faster = self._sampled(moved, rate * (1 + 1j * STEP / omega))
            by_omega = np.imag(faster) / STEP @ series.analysis.T
        jacobians = np.moveaxis(local, 1, 3).reshape(elements, unknowns, unknowns)
        return np.real(force) @ series.analysis.T, jacobians, by_omega

    def over(self, place: np.ndarray) -> np.ndarray:
        """Forces over a period of displacements without velocities, (elements, columns, samples), real."""
        still = np.zeros(place.shape, complex)
        return np.real(self._sampled(np.ascontiguousarray(place, dtype=complex), still))

    def at_samples(self, element: int, displacements: np.ndarray, omega: float) -> np.ndarray:
        """Derivatives of an element's law at each sample, (samples, columns + states, 2 columns + states)."""
        moved, rate = self._moved(displacements, omega)
        columns, samples = moved[element].shape
        slopes = np.empty((1, samples, columns + self.states, 2 * columns + self.states))
        law_samples(
            self.law.address, self._complex[element], Motion(moved[element], rate[element], -1, _NONE, _NONE),
            Room.of(columns, self.states), np.empty((columns, samples), complex), np.empty(self.states, complex),
            slopes,
        )  # fmt: skip
        return slopes[0]

    @property
    def _complex(self) -> np.ndarray:
        return np.ascontiguousarray(self.numbers, dtype=complex)

    def _moved(self, displacements: np.ndarray, omega: float) -> tuple[np.ndarray, np.ndarray]:
        """Displacements and velocities at samples."""
        waves = self.series.waves
        speed = displacements @ waves[1].T * omega if self.rated else 0.0 * (displacements @ waves[1].T)
        return tuple(np.ascontiguousarray(own, dtype=complex) for own in (displacements @ waves[0].T, speed))  # type: ignore[return-value]

    def _sampled(self, place: np.ndarray, velocity: np.ndarray) -> np.ndarray:
        """Forces at samples."""
        result = np.empty_like(place)
        room = Room.of(place.shape[1], self.states)
        law_forces(self.law.address, self._complex, place, velocity, _NONE, room, result)
        return result


_NONE = np.zeros(0)
_compared: set[str] = set()
"""Digests of the laws whose complex step was compared with differences."""


def _compare(sums: LawSums, displacements: np.ndarray, omega: float) -> None:
    """Refuse a law that drops the imaginary part of displacements or of its state."""
    if sums.law.digest in _compared or not np.any(displacements):
        return
    place, velocity = sums._moved(displacements, omega)
    way = np.random.default_rng(0).uniform(0.5, 1.0, displacements.shape)
    way *= np.max(np.abs(place)) / max(np.max(np.abs(way @ sums.series.synthesis.T)), np.finfo(float).tiny)
    moves, speeds = sums._moved(way, omega)

    def forces(shift: complex) -> np.ndarray:
        values = np.ravel(sums._sampled(place + shift * moves, velocity + shift * speeds))
        return values if np.imag(shift) else np.real(values)

    lost = attempted(partial(lost_step, forces, 1.0))
    if lost:
        raise InputError(
            f"element {sums.name!r}: the derivative of its force along a motion is {lost.by_step:.6g} N by the complex "
            f"step, but {lost.by_differences:.6g} N by differences. Its law {sums.law.name!r} drops the imaginary "
            f"part, as {DROPPING} do. Compare real parts (u[0].real), and use absolute, norm, hypot and atan2 of "
            "dalembert"
        )
    _compared.add(sums.law.digest)
