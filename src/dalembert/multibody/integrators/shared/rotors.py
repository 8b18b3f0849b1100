"""Masses that change with the coordinates as constant ones of rotors, for integrators that need constant masses.

A component of a kind with a ``rotor`` keeps its forces, and hands its inertia to a coordinate u and a multiplier behind
those of the mechanism: the constraint ties u to the coordinate of the joint, g = joint(q) - u = 0. The motion is the
same; what the integrator answers is cut to the unknowns of the mechanism.
"""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from dalembert.multibody.integrators.shared.run import Run
from dalembert.multibody.kernels.kind import Kind
from dalembert.multibody.kernels.states import MotionState
from dalembert.multibody.model.evaluate import constraint_rates, residual
from dalembert.multibody.model.lowered import Lowered
from dalembert.multibody.model.structure import Structure


def with_rotors(samples: Sequence[Lowered]) -> tuple[list[Lowered], np.ndarray]:
    """Return samples of one structure with rotors, and which of their unknowns (N + 1,) are those of the mechanism."""
    first = samples[0]
    structure, kept = _structure(first)
    return [_moved(one, structure, kept) for one in samples], kept


def without_rotors(run: Run, kept: np.ndarray) -> Run:
    """Return the run of the mechanism itself."""
    states = MotionState(*(part[..., kept] for part in run.states))
    return replace(run, states=states, derivatives=MotionState(*(part[..., kept] for part in run.derivatives)))


def _structure(lowered: Lowered) -> tuple[Structure, np.ndarray]:
    """The structure with a coordinate and a multiplier for each rotor, and the places of its former unknowns."""
    old = lowered.structure
    varying = [kind for kind in old.index if kind.rotor is not None]
    names = [name for kind in varying for name in lowered.parts[kind]]
    count, n, size = len(names), old.n, old.size
    kept = np.arange(size + 1)
    kept[n:] += count
    kept[size] += count
    index = {kind: kept[own] for kind, own in old.index.items()}
    meta = dict(old.meta)
    rotor = 0
    for kind in varying:
        own = rotor + np.arange(len(old.index[kind]))
        rotor += len(own)
        tie, inertia = kind.rotor
        unknowns = np.column_stack([index[kind][:, : kind.coordinates], n + own, size + count + own])
        integers = old.meta[kind][:, [kind.integers.index(name) for name in tie.integers]]
        for added, places, numbers in ((tie, unknowns, integers), (inertia, n + own[:, None], 0 * own[:, None])):
            index[added] = _behind(index, added, places)
            meta[added] = _behind(meta, added, numbers)
    owners = (*old.owners[:n], *names, *old.owners[n:], *names)
    kinds = (*old.kinds, *("rotor" for _ in names))
    changed = {"n": n + count, "size": size + 2 * count, "owners": owners, "kinds": kinds, "index": index, "meta": meta}
    return replace(old, **changed), kept


def _moved(lowered: Lowered, structure: Structure, kept: np.ndarray) -> Lowered:
    """The arrays of a sample with rotors that begin where its joints do."""
    data, parts = dict(lowered.data), dict(lowered.parts)
    for kind in [kind for kind in lowered.data if kind.rotor is not None]:
        data[kind] = lowered.data[kind].copy()
        data[kind][:, kind.columns(kind.varying)] = 0.0
        for added in kind.rotor:
            data[added] = _behind(data, added, lowered.data[kind][:, kind.columns(added.numbers)])
            parts[added] = (*parts.get(added, ()), *lowered.parts[kind])
    count = structure.n - lowered.structure.n
    x, v = (np.zeros(structure.size + 1, dtype=part.dtype) for part in (lowered.x, lowered.v))
    x[kept], v[kept] = lowered.x, lowered.v
    moved = replace(lowered, structure=structure, data=data, parts=parts, x=x, v=v)
    complex_state = lowered.is_complex
    model = moved.complex_model if complex_state else moved.real
    if complex_state:
        x, v = x.astype(complex), v.astype(complex)
    own, still = slice(lowered.structure.n, structure.n), np.zeros_like(x)
    x[own] = residual(moved, model, x, still, still)[-count:]  # g at u = 0
    v[own] = constraint_rates(moved, model, x, v, still)[0][-count:]
    return replace(moved, x=x, v=v)


def _behind(rows: dict[Kind, np.ndarray], kind: Kind, added: np.ndarray) -> np.ndarray:
    """Rows of a kind, with more behind those that there are; kernels read them by rows."""
    return np.ascontiguousarray(np.concatenate([rows[kind], added]) if kind in rows else added)
