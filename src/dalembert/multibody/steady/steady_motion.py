"""Steady motions of a mechanism, and the equations of small vibrations about them."""

from dataclasses import dataclass, field

import numpy as np
from scipy.linalg import block_diag, null_space

from dalembert.errors import InputError, ModelError
from dalembert.forward.complex_steps import SAFE
from dalembert.multibody.kernels.states import MotionState
from dalembert.multibody.model.evaluate import residual, tangent
from dalembert.multibody.model.lowered import Lowered, scales
from dalembert.multibody.model.observe import Observer
from dalembert.multibody.motion.complex_steps import Along, check_forces
from dalembert.multibody.steady.steady_nodes import Frame, Motion, SteadyNode, nodes_of

FIXED, ROTATING = FRAMES = "fixed", "rotating"
_MOST_ITERATIONS = 40
_LONGEST = 0.5  # of the extent, or rad: largest step of Newton's method
_STEADY = 1e-7  # relative change of the equations along the motion that counts as none
_INSTANTS = (0.1373, 0.3819, 0.7221)  # of a turn, at which the equations are compared with those of the start
_RANK = 1e-11
_AT_REST = 1e-12  # m/s or rad/s: rounding of velocities that follow from joints
_NEUTRAL = 1e-8  # of the largest stiffness


@dataclass(frozen=True, eq=False)
class SteadyEquations:
    """M z'' + C z' + K z = 0 of small vibrations about a steady motion, in a frame in which they are constant.
    ``frame``: "fixed" or "rotating"; ``frame_rate``, ``rate`` (1 or 3,): angular velocities of the frame and of the
    fastest body, rad/s, in the fixed axes; ``x`` (N + 1,): coordinates and multipliers at the time 0; ``mass``,
    ``damping``, ``stiffness`` (freedoms, freedoms); ``shapes`` (N + 1, freedoms): derivatives of coordinates and
    multipliers by z; ``turn`` (freedoms, freedoms): M J, where J turns a shape about the axis of the rate.
    """

    frame: str
    frame_rate: np.ndarray
    rate: np.ndarray
    x: np.ndarray
    mass: np.ndarray
    damping: np.ndarray
    stiffness: np.ndarray
    shapes: np.ndarray
    turn: np.ndarray

    @property
    def speed(self) -> float:
        """Magnitude of the rate, rad/s."""
        return float(np.linalg.norm(self.rate))

    @property
    def frame_speed(self) -> float:
        """Magnitude of the rate of the frame, rad/s."""
        return float(np.linalg.norm(self.frame_rate))


class _Unsteady(Exception):
    """The motion is not steady in a frame, with the reason."""


def moves(lowered: Lowered) -> bool:
    """Whether a mechanism moves at its start."""
    return bool(np.any(np.abs(np.real(lowered.v[:-1])) > _AT_REST))


def steady_equations(lowered: Lowered, frame: str | None = None) -> SteadyEquations:
    """Return the equations about the steady motion that is nearest to the start. The rates of bodies are those of the
    start; positions, directions of axes and forces of joints follow from the equations of motion, so springs carry
    centrifugal forces. ``frame``: "fixed", or "rotating" with a body; if not given, both are tried in turn.
    """
    v = np.real(lowered.v[:-1])
    nodes = nodes_of(lowered)
    spins = [node.spin(np.real(lowered.x), v) for node in nodes]
    fastest = max(spins, key=lambda rate: float(rate @ rate))
    reasons = {}
    for name, one in _frames(lowered, nodes, spins):
        if frame in (None, name):
            try:
                return _Steady(lowered, one).equations(name, fastest)
            except _Unsteady as reason:
                reasons.setdefault(name, str(reason))
    if not reasons:
        raise InputError(f"modes: frame {frame!r} was given, but no body turns; leave it out, or write 'fixed'")
    said = "; ".join(f"in the {name} frame, {reason}" for name, reason in reasons.items())
    raise ModelError(
        f"the motion at the start is not steady: {said}. Modes need bodies at rest, or bodies that turn at constant "
        "rates in balance, with equations that do not change along the motion. For modes about the state of rest, "
        "pass equilibrium(system)"
    )


def _frames(lowered: Lowered, nodes: list[SteadyNode], spins: list[np.ndarray]) -> list[tuple[str, Frame]]:
    """The fixed frame, and frames that turn with bodies, the fastest first."""
    x, v = np.real(lowered.x), np.real(lowered.v)
    still = Frame(np.zeros_like(spins[0]), np.zeros(lowered.dimension))
    found = [(FIXED, still)]
    for node, rate in sorted(zip(nodes, spins, strict=True), key=lambda pair: -float(pair[1] @ pair[1])):
        known = [other.rate for _, other in found]
        if min(float(np.abs(rate - other).max()) for other in known) <= 1e-9 * float(np.abs(rate).max()):
            continue
        node.begin(still, x, v)
        found.append((ROTATING, Frame(rate, node.centre)))
    return found


@dataclass
class _Steady:
    """A motion relative to a frame."""

    lowered: Lowered
    frame: Frame
    nodes: list[SteadyNode] = field(init=False)
    x: np.ndarray = field(init=False)
    """Multipliers, behind zeros."""

    def __post_init__(self) -> None:
        lowered = self.lowered
        x, v = np.real(lowered.x).astype(float), np.real(lowered.v)
        self.nodes, self.x = nodes_of(lowered), np.zeros(len(x))
        fastest = np.abs(v).max()
        left = [node.begin(self.frame, x, v) for node in self.nodes]
        worst = int(np.argmax(left))
        if left[worst] > 1e-9 * fastest:
            raise _Unsteady(f"points of {self._owner(self.nodes[worst].index[0])!r} do not turn about the axis")

    def _owner(self, entry: int) -> str:
        return self.lowered.structure.owners[entry]

    def at(self, t: float) -> tuple[Motion, Motion]:
        """State (N + 1,) without multipliers, and its derivatives (N, local)."""
        n, size = self.lowered.structure.n, len(self.x)
        local = sum(node.size for node in self.nodes)
        state, slopes = Motion(*np.zeros((3, size))), Motion(*np.zeros((3, size - 1, local)))
        column = 0
        for node in self.nodes:
            numbers, derivatives = node.at(self.frame, t)
            for level in range(3):
                state[level][node.index] = numbers[level]
                slopes[level][node.index, column : column + node.size] = derivatives[level]
            column += node.size
        assert not np.any(slopes.q[n:])
        return state, slopes

    def tangents(self, x: np.ndarray, state: Motion, t: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Derivatives of the residual by coordinates and multipliers, by velocities and by accelerations, (N, N)."""
        by = ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))
        k, c, m = (tangent(self.lowered, x, state.v, one, t=t, a=state.a).toarray() for one in by)
        n = self.lowered.structure.n
        c[n:], m[n:] = 0.0, 0.0  # constraints depend on positions alone
        return k, c, m

    def solve(self) -> None:
        """Move the nodes until the motion satisfies the equations of motion at the start, by Newton's method."""
        n, scale = self.lowered.structure.n, scales(self.lowered)[:-1]
        extent, before = scale[:n].max(), np.inf
        for _ in range(_MOST_ITERATIONS):
            state, slopes = self.at(0.0)
            x = state.q + self.x
            left = residual(self.lowered, self.lowered.real, x, state.v, state.a)
            k, c, m = self.tangents(x, state, 0.0)
            matrix = np.hstack([k[:, :n] @ slopes.q[:n] + c[:, :n] @ slopes.v[:n] + m[:, :n] @ slopes.a[:n], k[:, n:]])
            local, weights = slopes.q.shape[1], np.linalg.norm(matrix, axis=0)
            # A motion without stiffness, such as the turn of a rotor, has a column of rounding: it is not scaled up.
            weights[:local] = np.maximum(weights[:local], _NEUTRAL * weights[:local].max(initial=0.0))
            weights = 1.0 / (weights + 1e-300)
            step = weights * np.linalg.lstsq(matrix * weights, -left, rcond=_RANK)[0]
            size = np.abs(slopes.q[:n] @ step[:local]).max(initial=0.0) / extent
            share = _LONGEST / max(size, _LONGEST)
            column = 0
            for node in self.nodes:
                node.move(share * step[column : column + node.size])
                column += node.size
            self.x[n:-1] += share * step[local:]
            if size < 1e-11 or before <= size < 1e-7:  # it converged, or to rounding
                return
            if not np.isfinite(size):
                break
            before = size
        raise _Unsteady("no position was found in which all forces are in balance")

    def balanced(self, t: float) -> tuple[Motion, Motion, np.ndarray, np.ndarray]:
        """State and slopes at a time, with multipliers that balance it best, and what they leave of the forces."""
        n = self.lowered.structure.n
        state, slopes = self.at(t)
        left = residual(self.lowered, self.lowered.real, state.q, state.v, state.a, t)
        by = tangent(self.lowered, state.q, state.v, (1.0, 0.0, 0.0), t=t, a=state.a).toarray()[:n, n:]
        forces = np.linalg.lstsq(by, -left[:n], rcond=_RANK)[0] if by.size else np.zeros(by.shape[1])
        x = state.q.copy()
        x[n:-1] = forces
        rest = residual(self.lowered, self.lowered.real, x, state.v, state.a, t)
        return state, slopes, x, rest

    def equations(self, name: str, rate: np.ndarray) -> SteadyEquations:
        """The equations at the start, compared with those later in a turn."""
        self.solve()
        n = self.lowered.structure.n
        state = self.at(0.0)[0]
        self._check(state)
        first = self._matrices(0.0, None)
        spin = float(np.sqrt(rate @ rate))
        # A motion along a line has no turn: it is looked at over its extent.
        turns = spin or float(np.abs(state.v).max() / scales(self.lowered).max())
        for instant in _INSTANTS:
            later = self._matrices(2.0 * np.pi * instant / turns, first[-1])
            sizes = [np.abs(own).max(initial=0.0) for own in first[:3]]
            sizes[1], sizes[2] = max(sizes[1], turns * sizes[0]), max(sizes[2], turns * turns * sizes[0])
            for what, now, then, size in zip(("mass", "damping", "stiffness"), later, first, sizes, strict=False):
                if np.abs(now - then).max(initial=0.0) > _STEADY * size:
                    raise _Unsteady(f"the {what} matrix changes along the motion")
        m, c, k, x, shapes, free = first
        unit = rate / turns if spin else rate
        turned = block_diag(*(node.turned(unit) for node in self.nodes))
        whole = np.zeros((len(x), free.shape[1]))
        whole[:n] = shapes[:n] @ free
        mass = shapes[:n].T @ self.tangents(x, state, 0.0)[2][:n, :n] @ shapes[:n]
        return SteadyEquations(name, self.frame.rate, rate, x, m, c, k, whole, free.T @ mass @ turned @ free)

    def _check(self, state: Motion) -> None:
        """Refuse functions of the user's that lose the complex step: stiffness and damping would be wrong."""
        x, v, a = (own[None] for own in (state.q + self.x, state.v, state.a))
        along = Along(Observer((), ()), np.zeros(1), MotionState(x, v, a, a))
        check_forces(self.lowered, along, scales(self.lowered), SAFE)

    def _matrices(self, t: float, free: np.ndarray | None) -> tuple[np.ndarray, ...]:
        """Return mass, damping and stiffness of free local coordinates, the state, slopes, and the free local
        coordinates. With q, q' and q'' linear in z, z' and z'' by A0, A1 and A2, the projected residual has
        M = A0' M A0, C = A0' (C A0 + 2 M A1) and K = A0' (K A0 + C A1 + M A2).
        """
        lowered = self.lowered
        n, scale = lowered.structure.n, scales(lowered)
        state, slopes, x, rest = self.balanced(t)
        k, c, m = self.tangents(x, state, t)
        a0, a1, a2 = (own[:n] for own in slopes)
        wrong = a0.T @ rest[:n]
        forces = np.abs(a0.T @ np.abs(k[:n, n:] * x[n:-1])).max(initial=0.0) + np.abs(m[:n, :n] @ state.a[:n]).max(
            initial=0.0
        )
        forces += np.abs(residual(lowered, lowered.real, state.q, state.v, state.a, t)[:n]).max(initial=0.0)
        gap = np.abs(rest[n:] / scale[n:-1]).max(initial=0.0)
        if np.abs(wrong).max(initial=0.0) > _STEADY * max(forces, 1e-12) or gap > _STEADY * scale[:n].max():
            raise _Unsteady(self._unbalanced(wrong, rest, n))
        jacobian = k[n:, :n] @ a0
        jacobian = jacobian / (np.linalg.norm(jacobian, axis=1, keepdims=True) + 1e-300)
        jacobian[np.linalg.norm(k[n:, :n] @ a0, axis=1) < 1e-9] = 0.0  # constraints inside of bodies
        if free is None:
            free = null_space(jacobian, rcond=1e-9) if len(jacobian) else np.eye(a0.shape[1])
        elif np.abs(jacobian @ free).max(initial=0.0) > _STEADY:
            raise _Unsteady("the directions that joints leave free change along the motion")
        m, c, k = m[:n, :n], c[:n, :n], k[:n, :n]
        whole = a0.T @ m @ a0, a0.T @ (c @ a0 + 2.0 * m @ a1), a0.T @ (k @ a0 + c @ a1 + m @ a2)
        reduced = (free.T @ own @ free for own in whole)
        return (*reduced, x, slopes.q, free)

    def _unbalanced(self, wrong: np.ndarray, rest: np.ndarray, n: int) -> str:
        """What is not in balance."""
        if np.abs(wrong).max(initial=0.0) <= 1e-12 and len(rest) > n:
            return f"the joint {self._owner(n + int(np.argmax(np.abs(rest[n:]))))!r} does not hold along the motion"
        entry = int(np.argmax(np.abs(wrong)))
        column = 0
        for node in self.nodes:
            column += node.size
            if entry < column:
                return f"forces on {self._owner(node.index[0])!r} are not in balance along the motion"
        return "forces are not in balance"
