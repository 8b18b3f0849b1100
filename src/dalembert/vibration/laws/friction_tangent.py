"""Compiled: the exact tangent of friction over the samples of a period."""

from dalembert.kernels.blas import product
from dalembert.kernels.kernel import inner, kernel
from dalembert.kernels.views import address_of, local, reals2, reals3, stack
from dalembert.kernels.words import Address, Bytes2, Reals, Reals2, Reals3, Reals4
from dalembert.vibration.laws.friction_law import FRICTION, NORMAL, SEPARATED, SLIPPING, STUCK, TANGENTIAL, update
from dalembert.vibration.laws.friction_period import (
    SWEEPS,
    balanced,
    identity,
    largest,
    line,
    project,
    restarted,
    settled,
)

_square, _pair = local(float, 2, 2), local(float, 2)


@inner
def _line_slopes(states, stiffness, synthesis, slopes):
    """Derivatives of the forces of :func:`line`, (samples, coefficients), where it slips at some time.

    A slider that sticks is where its last slip left it: its place moves as the displacement did at that sample.
    """
    last = 0
    for t in range(len(states)):
        # Of the period before: the place at the first sample is that of the last slip.
        last = t if states[t] == SLIPPING else last
    for t in range(len(states)):
        if states[t] == SLIPPING:
            slopes[t], last = 0.0, t
            continue
        for j in range(slopes.shape[1]):
            slopes[t, j] = stiffness * (synthesis[t, j] - synthesis[last, j])


@inner
def _slopes(d, z, force, states, moved, kept, slopes, past, numbers, tangents, normal, memory, synthesis):
    """One period's derivatives of the forces by the displacements' coefficients, (columns, samples, unknowns).
    ``moved`` (tangents, unknowns) is carried on: the derivative of the slider's place. ``kept`` becomes that of the end
    by the start, and ``past`` (tangents, samples, tangents) that of the forces by it.
    """
    count = synthesis.shape[1]
    stiffness, friction = numbers[TANGENTIAL], numbers[FRICTION]
    direction, own, unknowns = _pair(), tangents * count, slopes.shape[2]
    identity(kept, tangents)
    for t in range(d.shape[1]):
        for i in range(tangents):
            direction[i] = stiffness * (d[i, t] - z[i])
        state, size = update(d[:, t], z, force, numbers, tangents, normal, memory)
        states[t] = state
        if normal:
            rise = numbers[NORMAL] if state != SEPARATED else 0.0
            slopes[tangents, t, :own] = 0.0
            for j in range(count):
                slopes[tangents, t, own + j] = rise * synthesis[t, j]
        # ∂f = k (∂d - ∂z) where it sticks; the same, projected across the direction, where it slips in two directions;
        # in one direction only the limit changes.
        held = stiffness if state == STUCK or (state == SLIPPING and tangents == 2) else 0.0
        for i in range(tangents):
            for j in range(unknowns):
                slopes[i, t, j] = -held * moved[i, j]
            for j in range(count):
                slopes[i, t, i * count + j] += held * synthesis[t, j]
            for j in range(tangents):
                past[i, t, j] = -held * kept[i, j]
        if state == SLIPPING:
            for i in range(tangents):
                direction[i] /= size
            if tangents == 2:
                e, f = direction[0], direction[1]
                ratio = (force[0] * e + force[1] * f) / size
                # mu N/|p| (1 - e e^T) k (∂d - ∂z)
                project(slopes[0, t], slopes[1, t], e, f, ratio)
                project(past[0, t], past[1, t], e, f, ratio)
            if normal:
                for i in range(tangents):
                    for j in range(own, unknowns):
                        # + mu e ∂N
                        slopes[i, t, j] += friction * direction[i] * slopes[tangents, t, j]
        if memory and state != STUCK:
            for i in range(tangents):
                for j in range(unknowns):
                    # z = d - f/k after slip, so that ∂z = ∂d - ∂f/k; an open contact has f = 0.
                    moved[i, j] = -slopes[i, t, j] / stiffness
                for j in range(count):
                    moved[i, i * count + j] += synthesis[t, j]
                for j in range(tangents):
                    kept[i, j] = -past[i, t, j] / stiffness


@inner
def _differentiate(
    d, z, before, force, states, kept, slopes, past, moved, numbers, tangents, normal, memory, synthesis, forgets
):  # fmt: skip
    """Slopes of a balanced contact. Where the slider's place over the period does not depend on where it was before,
    from a single period; else carried through all periods from rest, as the place itself.
    """
    moved[:] = 0.0
    if forgets or not memory:
        for i in range(tangents):
            z[i] = before[i]
        _slopes(d, z, force, states, moved, kept, slopes, past, numbers, tangents, normal, memory, synthesis)
        return
    z[:] = 0.0
    scale = largest(d)
    for sweep in range(SWEEPS):
        for i in range(tangents):
            before[i] = z[i]
        _slopes(d, z, force, states, moved, kept, slopes, past, numbers, tangents, normal, memory, synthesis)
        if sweep > 0 and (tangents == 1 or settled(z, before, tangents, scale)):
            break


@inner
def _begin_again(kept, moved, tangents):
    """Turn the derivative of the slider's place at the end of a period into that of the periodic motion's place."""
    for j in range(moved.shape[1]):
        # z(end) = z(start): ∂z = (1 - ∂z(end)/∂z(start))⁻¹ ∂z(end)/∂U
        first, second = restarted(kept, tangents, moved[0, j], moved[tangents - 1, j])
        moved[0, j] = first
        if tangents == 2:
            moved[1, j] = second


@kernel
def forces_and_slopes(
    numbers: Reals2, tangents: int, normal: bool, memory: bool, synthesis: Reals2, analysis: Reals2, gemm: Address,
    displacements: Reals3, result: Reals3, states: Bytes2, jacobians: Reals4, scratch: Reals,
) -> None:  # fmt: skip
    """Forces and Jacobians (contacts, columns, coefficients, unknowns); the workspace has a contact's derivatives.
    These are, by samples, those of forces by displacements (columns, samples, unknowns) and by the slider's place at
    the start of the period (tangents, samples, tangents), with harmonics (coefficients, tangents); and those of that
    place by displacements (tangents, unknowns).
    """
    columns, samples, count = displacements.shape[1], displacements.shape[2], synthesis.shape[1]
    unknowns, at = columns * count, address_of(scratch)
    slopes = reals3(at, columns, samples, unknowns)
    at += 8 * columns * samples * unknowns
    past = reals3(at, tangents, samples, tangents)
    at += 8 * tangents * samples * tangents
    harmonics, moved = reals2(at, count, tangents), reals2(at + 8 * count * tangents, tangents, unknowns)
    z, before, force, kept = stack(numbers, 2), stack(numbers, 2), stack(numbers, 3), _square()
    for c in range(len(displacements)):
        d, own = displacements[c], numbers[c]
        straight = memory and tangents == 1 and not normal
        forgets, moving = line(d[0], result[c, 0], states[c], own) if straight else (False, True)
        if straight and forgets:
            _line_slopes(states[c], own[TANGENTIAL], synthesis, slopes[0])
            product(gemm, analysis, slopes[0], 0.0, jacobians[c, 0])
            continue
        if moving:
            forgets, moving = balanced(d, z, before, force, result[c], states[c], kept, own, tangents, normal, memory)
        if memory and not moving:
            for i in range(columns):
                for j in range(count):
                    jacobians[c, i, j, i * count + j] = own[TANGENTIAL] if i < tangents else own[NORMAL]
            continue
        _differentiate(
            d, z, before, force, states[c], kept, slopes, past, moved, own, tangents, normal, memory, synthesis, forgets
        )
        for i in range(columns):
            product(gemm, analysis, slopes[i], 0.0, jacobians[c, i])
        if forgets and memory:
            _begin_again(kept, moved, tangents)
            for i in range(tangents):
                product(gemm, analysis, past[i], 0.0, harmonics)
                product(gemm, harmonics, moved, 1.0, jacobians[c, i])
