"""Paths of a nonlinear mode: from its linear mode to an amplitude, and from one amplitude to another."""

from collections.abc import Iterator
from dataclasses import replace
from itertools import islice

import numpy as np

from dalembert.vibration.balance.arc_length import EASY, MOST_POINTS, SHORTEST, STEADY, Progress
from dalembert.vibration.modes.free_motion import FreeMotion, Linear, ModePlane
from dalembert.vibration.modes.mode_equations import ModeEquations
from dalembert.vibration.paths.continuation import MOST_AROUND

SMALLER = (1.0, 0.1, 1e-2, 1e-3, 1e-4)
"""Parts of the first amplitude that are tried in turn."""
CORNER = 1e-2
"""Step behind a corner of the path, as part of the longest."""
RETRACED = 1e-3
"""Relative difference of frequencies below which a path has returned to its start."""
BEHIND = 2.0
"""Ratio by which the path between two amplitudes may pass behind the first."""
FIRST_PART, LEAST_PART = 0.125, 2.0**-10
"""First and smallest step of the part of the nonlinearity on the way from the linear mode."""
SAME = 0.9
"""Cosine of the angle between two motions, weighted by the mass, below which they belong to different modes.

With 0.7, Newton's iteration passed a fold of a chain to a mode of another frequency (cosine 0.73) on some processors.
"""


def first_motion(mode: ModeEquations, linear: Linear, size: float) -> FreeMotion:
    """Return the motion at the first amplitude, or at a smaller one if the linear mode is too far from it."""
    # A smaller amplitude is nearer to the linear mode, unless the stiffness changes at rest.
    for part in SMALLER:
        harmonics = linear.rest.copy()
        harmonics[:, int(mode.problem.method.orders[0] == 0)] += part * size * linear.moved
        guess = FreeMotion(harmonics, linear.omega, linear.growth, part * size)
        motion = mode.at_size(guess, part * size, mode.problem.method.first_samples)
        if same_mode(mode, guess, motion):
            return motion
    return from_linear_mode(mode, linear, size) or replace(motion, size=size, converged=False)


def from_linear_mode(mode: ModeEquations, linear: Linear, size: float) -> FreeMotion | None:
    """Return the motion at an amplitude by increasing the nonlinearity from none to all."""
    harmonics = linear.rest.copy()
    harmonics[:, int(mode.problem.method.orders[0] == 0)] += size * linear.moved
    known = FreeMotion(harmonics, linear.omega, linear.growth, size, samples=mode.problem.method.first_samples)
    part, step = 0.0, FIRST_PART
    while part < 1.0:
        target = min(part + step, 1.0)
        softer = mode.softer(target, linear.rest)
        if softer is None:
            return None
        candidate = (mode if target == 1.0 else softer).at_size(known, size, known.samples)
        if same_mode(mode, known, candidate):
            known, part, step = candidate, target, 2 * step
        elif (step := step / 2) < LEAST_PART:
            return None
    return known


def same_mode(mode: ModeEquations, known: FreeMotion, candidate: FreeMotion) -> bool:
    """Whether a motion is converged, and belongs to the same mode."""
    if not candidate.converged:
        return False
    matrix, mean = mode.mass, mode.series().mean
    first, other = (mode.displacements(motion)[:, mean : mean + 2] for motion in (known, candidate))
    # MAC of first harmonics, weighted by the mass: 1 for the same shape, 0 for another linear mode.
    inner = [float(np.sum(left * (matrix @ right))) for left, right in ((first, other), (first, first), (other, other))]
    return inner[0] > SAME * np.sqrt(inner[1] * inner[2])


def motions_at(mode: ModeEquations, first: FreeMotion, sizes: np.ndarray, rest: np.ndarray) -> Iterator[FreeMotion]:
    """Yield motions at given amplitudes, each from the one before."""
    known = first
    for size in sizes:
        motion = motion_towards(mode, known, float(size), rest) if known.converged else replace(first, size=float(size))
        known = motion if motion.converged else known
        yield motion


def motion_towards(mode: ModeEquations, known: FreeMotion, size: float, rest: np.ndarray) -> FreeMotion:
    """Return the motion at an amplitude from that at another. Ratios that do not converge are halved."""
    way = [size]
    worst = None
    while way:
        if way[-1] == known.size:
            way.pop()
            continue
        # All harmonics in proportion to the amplitude, about the static position.
        guess = replace(known, harmonics=rest + (known.harmonics - rest) * (way[-1] / known.size))
        candidate = mode.at_size(guess, way[-1], known.samples)
        if same_mode(mode, known, candidate):
            known = candidate
            way.pop()
        elif len(way) > mode.problem.method.halvings:
            for motion in islice(motions_along(mode, known, known.size, size, BEHIND), MOST_AROUND):
                if motion.converged and motion.size == size:
                    return motion
            return replace(worst or candidate, size=size, converged=False)
        else:
            worst = worst or candidate
            # The geometric mean: amplitudes vary by decades.
            way.append(float(np.sqrt(known.size * way[-1])))
    return known


def motions_along(
    mode: ModeEquations, first: FreeMotion, begin: float, end: float, behind: float = 1.0
) -> Iterator[FreeMotion]:
    """Yield motions along the path from the first amplitude to another, by arc length."""
    low, high = sorted((begin / behind if end > begin else begin * behind, end))
    known, onward = first, np.zeros(first.harmonics.size + 3)
    onward[-1] = np.sign(end - begin)
    yield known
    if not known.converged:
        return
    longest = 10 * mode.problem.method.resolution
    step, direction, progress = longest / 4, mode.direction(known, onward), Progress(longest)
    for _ in range(MOST_POINTS):
        scale = mode.scale(known)
        plane = ModePlane(direction, known, scale)
        # Predictor and corrector as for forced motions; the plane is across the direction at the predicted motion.
        guess = plane.moved(known, step * direction)
        motion = mode.solve(guess, replace(plane, at=guess), known.samples)
        after = mode.direction(motion, direction) if same_mode(mode, known, motion) else None
        bent = after is not None and float(direction @ after) < STEADY
        # A refused or bent step is halved; a path of friction has corners, at which no step is short enough.
        if after is None or (bent and step > 1e-2 * longest):
            step /= 2
            if step > SHORTEST * longest:
                continue
            turned = _around_a_corner(mode, known, direction, CORNER * longest)
            if turned is None:
                yield replace(motion, converged=False)
                return
            (motion, after), step = turned, CORNER * longest
        if not low <= motion.size <= high and motion.size * direction[-1] > known.size * direction[-1]:
            last = mode.at_size(motion, low if motion.size < low else high, motion.samples)
            # A path that leaves over its first amplitude at its first frequency has gone back on itself.
            retraced = last.size == begin and abs(last.omega / first.omega - 1) < RETRACED
            yield replace(last, converged=last.converged and not retraced)
            return
        if low <= motion.size <= high:
            yield motion
        if progress.ends(step):
            return
        known, direction = motion, after
        step = min(longest, step * (1.5 if motion.iterations <= EASY else 0.7))


def _around_a_corner(
    mode: ModeEquations, known: FreeMotion, direction: np.ndarray, step: float
) -> tuple[FreeMotion, np.ndarray] | None:
    """A motion behind a corner of the path, such as where a contact begins to slip, and the direction there.

    The tangent behind it is that of the equations a little beyond; of its two senses one leads on, the other back.
    """
    scale = mode.scale(known)
    # The tangent at a point beyond the corner, though that is no solution: contacts there have the states behind it.
    beyond = ModePlane(direction, known, scale).moved(known, step * direction)
    tangent = mode.direction(beyond, direction)
    for way in (tangent, -tangent):
        plane = ModePlane(way, known, scale)
        guess = plane.moved(known, step * way)
        motion = mode.solve(guess, replace(plane, at=guess), known.samples)
        if not same_mode(mode, known, motion):
            continue
        moved = plane.from_here(motion)
        if float(direction @ moved) > -0.5 * np.linalg.norm(moved):
            return motion, mode.direction(motion, moved)
    return None
