"""Random vibrating systems with contacts, and the balance of their forces evaluated anew in plain NumPy.

As a command (``python tests/random_vibrations.py 200``) it goes through that many systems, at given frequencies and
along paths, and writes the table tests/verification/references/random_vibrations.csv. With a second number it stops
after that many seconds; begun again, it goes on after the last line of its unfinished table, which lies beside that.
"""

import sys
import time
from dataclasses import dataclass, field, replace
from pathlib import Path

import numpy as np

from dalembert.structure import lumped
from dalembert.vibration import (
    BilinearStop,
    CubicSpring,
    ElasticSlider,
    FrequencyCurve,
    FrictionContact,
    Gap,
    HarmonicBalance,
    HarmonicForce,
    Rigid,
    StaticForce,
    VibrationSystem,
    frequency_response,
)

METHOD = HarmonicBalance(harmonics=5, sampling=1e-9)
"""Samples are doubled until the sums are known ten times better than the residual is judged."""
PATHS = replace(METHOD, sampling=1e-4)
FIXED = [
    replace(METHOD, samples=samples, events=events) for events in (True, False) for samples in (128, 256, 1024)
]  # fmt: skip
ACCEPTED = 1e-8
TABLE = Path(__file__).parent / "verification" / "references" / "random_vibrations.csv"
SAMPLES = 2**14
ROUNDS, PARTS = 4, 16
"""How often an interval in which a state changes is divided, and into how many parts."""
GAUSS = np.array([0.5 - np.sqrt(1 / 12), 0.5 + np.sqrt(1 / 12)])
OPEN, STICKS, SLIPS_UP, SLIPS_DOWN = range(4)
KINDS = ("slider", "pressed slider", "rigid", "pressed rigid", "gap", "stop")


@dataclass(frozen=True)
class Law:
    """A contact in the evaluation: rows of relative displacement, and numbers."""

    tangent: np.ndarray | None
    normal: np.ndarray | None
    stiffness: float = 0.0
    normal_stiffness: float = 0.0
    gap: float = 0.0
    friction: float = 0.0
    load: float = 0.0
    rigid: bool = False

    @property
    def rows(self) -> np.ndarray:
        return np.array([row for row in (self.tangent, self.normal) if row is not None])


@dataclass
class RandomSystem:
    """A system, its resonances and what the evaluation knows of it."""

    system: VibrationSystem
    frequencies: np.ndarray
    kinds: list[str] = field(default_factory=list)
    laws: list[Law] = field(default_factory=list)
    cubic: list[tuple[np.ndarray, float]] = field(default_factory=list)


def random_system(seed: int) -> RandomSystem:
    """A chain of masses, 2 to 6 degrees of freedom, with 1 to 4 contacts."""
    rng = np.random.default_rng(seed)
    nodes = int(rng.integers(2, 5))
    lifted = rng.random(nodes) < 0.4
    while nodes + lifted.sum() > 6:
        lifted[np.flatnonzero(lifted)[-1]] = False
    masses, springs = {}, []
    for number in range(nodes):
        for axis in "xy" if lifted[number] else "x":
            masses[f"m{number}.{axis}"] = float(rng.uniform(0.5, 2.0))
            stiffness = float(rng.uniform(0.3, 2.0))
            springs.append((f"m{number}.{axis}", None, stiffness, stiffness * float(rng.uniform(0.01, 0.05))))
    for number in range(1, nodes):
        stiffness = float(rng.uniform(0.5, 2.0))
        springs.append((f"m{number - 1}.x", f"m{number}.x", stiffness, stiffness * float(rng.uniform(0.01, 0.05))))
    structure = lumped(masses, springs)
    values = np.linalg.eigvals(np.linalg.solve(structure.mass, structure.stiffness))
    resonances = np.sort(np.sqrt(values.real)) / (2 * np.pi)
    own = RandomSystem(VibrationSystem(structure), np.linspace(0.6, 1.6, 5) * resonances[rng.integers(2)])
    names = structure.dofs.names
    amplitude = float(10 ** rng.uniform(-0.5, 0.5))
    own.system.add(HarmonicForce(names[rng.integers(len(names))], amplitude))
    if rng.random() < 0.3:
        own.system.add(
            HarmonicForce(
                names[rng.integers(len(names))], amplitude / 2, float(rng.uniform(0, 6)), int(rng.integers(1, 4))
            )
        )
    if rng.random() < 0.4:
        own.system.add(StaticForce(names[rng.integers(len(names))], float(rng.normal()) * amplitude / 2))
    rubbing: set[int] = set()
    for number in range(int(rng.integers(1, 5))):
        _add_contact(own, rng, number, nodes, lifted, amplitude, rubbing)
    if rng.random() < 0.3:
        dof, stiffness = names[rng.integers(len(names))], float(rng.uniform(0.02, 0.5))
        own.system.add(CubicSpring("cubic", dof, stiffness=stiffness))
        own.cubic.append((_row(names, dof), stiffness))
    return own


def _row(names: tuple[str, ...], first: str, second: str | None = None) -> np.ndarray:
    row = np.zeros(len(names))
    row[names.index(first)] = 1.0
    if second is not None:
        row[names.index(second)] = -1.0
    return row


def _add_contact(
    own: RandomSystem, rng: np.random.Generator, number: int, nodes: int, lifted: np.ndarray, force: float,
    rubbing: set[int],
) -> None:  # fmt: skip
    """A contact of a random kind; a node has one with friction at most, so that their rows are independent."""
    names, kind = own.system.structure.dofs.names, KINDS[rng.integers(len(KINDS))]
    free = [node for node in range(nodes) if node not in rubbing]
    able = [node for node in free if lifted[node]]
    if kind.startswith("pressed") and not able:
        kind = kind.split()[1]
    if kind not in ("gap", "stop") and not free:
        kind = "gap"
    own.kinds.append(kind)
    if kind in ("gap", "stop"):
        dof = names[rng.integers(len(names))]
        stiffness, gap = float(10 ** rng.uniform(-0.3, 1.5)), float(rng.uniform(0.05, 1.5)) * force
        element = Gap if kind == "gap" else BilinearStop
        own.system.add(element(f"{kind} {number}", dof, stiffness=stiffness, gap=gap))
        for side in (1.0, -1.0)[: 1 if kind == "gap" else 2]:
            own.laws.append(Law(None, side * _row(names, dof), normal_stiffness=stiffness, gap=gap))
        return
    pressed, rigid = kind.startswith("pressed"), kind.endswith("rigid")
    node = int(rng.choice(able if pressed else free))
    rubbing.add(node)
    others = [other for other in range(nodes) if other not in rubbing] if not pressed else []
    other = int(rng.choice(others)) if others and rng.random() < 0.3 else None
    if other is not None:
        rubbing.add(other)
    friction, preload = float(rng.uniform(0.2, 0.8)), float(rng.uniform(0.1, 1.5)) * force
    stiffness, normal_stiffness = float(10 ** rng.uniform(-0.3, 1.3)), float(10 ** rng.uniform(-0.3, 1.3))
    gap = 0.0
    if pressed and rng.random() < 0.3:
        preload, gap = 0.0, float(rng.uniform(-0.5, 0.5)) * force
    if rigid:
        law, normal_stiffness = Rigid(penalty=stiffness, prediction="displacement", gap=gap), stiffness
    else:
        law = ElasticSlider(stiffness, normal_stiffness if pressed else None, gap)
    own.system.add(
        FrictionContact(
            f"contact {number}",
            f"m{node}",
            None if other is None else f"m{other}",
            ("x",),
            "y" if pressed else None,
            friction=friction,
            preload=preload,
            law=law,
        )
    )
    tangent = _row(names, f"m{node}.x", None if other is None else f"m{other}.x")
    own.laws.append(
        Law(
            tangent,
            _row(names, f"m{node}.y") if pressed else None,
            stiffness,
            normal_stiffness,
            gap,
            friction,
            preload,
            rigid,
        )
    )


def waves(angles: np.ndarray, harmonics: int) -> np.ndarray:
    """1, cos, sin, cos 2, sin 2, ... at angles, (angles, coefficients)."""
    result = np.ones((len(angles), 2 * harmonics + 1))
    for order in range(1, harmonics + 1):
        result[:, 2 * order - 1], result[:, 2 * order] = np.cos(order * angles), np.sin(order * angles)
    return result


def contact_force(law: Law, u: np.ndarray, samples: int = SAMPLES) -> np.ndarray:
    """Coefficients of a contact's forces from those of its relative displacements, (rows, coefficients).

    States on a grid that is refined where they change; between, the forces are integrated by Gauss' rule.
    """
    harmonics = (u.shape[1] - 1) // 2
    angles = np.linspace(0.0, 2 * np.pi, samples + 1)
    for last in (False,) * ROUNDS + (True,):
        states, sliders = _states(law, waves(angles, harmonics) @ u.T)
        changed = np.flatnonzero(states[1:] != states[:-1])
        if last or not len(changed):
            break
        # The displacement may turn back, and the slider stick, in the interval before.
        changed = np.unique(np.clip(changed[:, None] + np.array([-1, 0, 1]), 0, len(states) - 2))
        inner = np.arange(1, PARTS) / PARTS
        new = (angles[changed, None] + inner * (angles[changed + 1] - angles[changed])[:, None]).ravel()
        angles = np.sort(np.append(angles, new))
    widths, total = np.diff(angles), np.zeros_like(u)
    for part in GAUSS:  # an interval with a change is so short by now that the state at its start will do
        basis = waves(angles[:-1] + part * widths, harmonics)
        force = _force(law, basis @ u.T, states[:-1], sliders[:-1])
        total += 0.5 * (force * widths) @ basis
    total /= np.pi
    total[:, 0] /= 2
    return total


def _load(law: Law, d: np.ndarray) -> np.ndarray:
    load = np.full(len(d), law.load)
    return load if law.normal is None else load + law.normal_stiffness * (d[:, -1] - law.gap)


def _states(law: Law, d: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """State and place of the slider at each instant of the second of two periods."""
    load = _load(law, d)
    if law.tangent is None:
        return np.where(load > 0, STICKS, OPEN), np.zeros(len(d))
    z, states, sliders = 0.0, np.zeros(len(d), dtype=int), np.zeros(len(d))
    trial, limits = (law.stiffness * d[:, 0]).tolist(), (law.friction * load).tolist()
    for _ in range(2):
        for t, (k_u, limit) in enumerate(zip(trial, limits, strict=True)):
            force = k_u - z
            if law.normal is not None and limit <= 0:
                z, states[t] = k_u, OPEN
            elif force > limit:
                z, states[t] = k_u - limit, SLIPS_UP
            elif force < -limit:
                z, states[t] = k_u + limit, SLIPS_DOWN
            else:
                states[t] = STICKS
            sliders[t] = z
    return states, sliders


def _force(law: Law, d: np.ndarray, states: np.ndarray, sliders: np.ndarray) -> np.ndarray:
    """Forces (rows, instants), the normal one beyond the preload."""
    load, rows = np.where(states == OPEN, 0.0, _load(law, d)), []
    if law.tangent is not None:
        trial = law.stiffness * d[:, 0] - sliders
        rows.append(np.select([states == OPEN, states == STICKS], [0.0, trial], law.friction * load))
        rows[0][states == SLIPS_DOWN] *= -1
    if law.normal is not None:
        rows.append(load - law.load)
    return np.array(rows)


def unbalanced(own: RandomSystem, curve: FrequencyCurve, point: int, samples: int = SAMPLES) -> float:
    """Residual of the whole structure at a point of a curve, as part of the forces."""
    structure, x = own.system.structure, curve.response[point]
    harmonics, omega = (x.shape[1] - 1) // 2, 2 * np.pi * curve.frequencies[point]
    missing = np.zeros_like(x)
    for force in own.system.forces:
        row = structure.dofs.index(force.dof)
        if isinstance(force, StaticForce):
            missing[row, 0] += force.value
        elif force.harmonic <= harmonics:
            missing[row, 2 * force.harmonic - 1] += force.amplitude * np.cos(force.phase)
            missing[row, 2 * force.harmonic] -= force.amplitude * np.sin(force.phase)
    scale = np.linalg.norm(missing)
    for order in range(harmonics + 1):
        static = structure.stiffness - (order * omega) ** 2 * structure.mass
        if order == 0:
            missing[:, 0] -= static @ x[:, 0]
            continue
        cosine, sine, damping = x[:, 2 * order - 1], x[:, 2 * order], order * omega * structure.damping
        missing[:, 2 * order - 1] -= static @ cosine + damping @ sine
        missing[:, 2 * order] -= static @ sine - damping @ cosine
    for row, stiffness in own.cubic:
        angles = 2 * np.pi * np.arange(64) / 64
        basis = waves(angles, harmonics)
        force = stiffness * (basis @ (row @ x)) ** 3 @ basis / 32
        force[0] /= 2
        missing -= np.outer(row, force)
        scale += np.linalg.norm(force)
    for law in own.laws:
        if not law.rigid:
            force = contact_force(law, law.rows @ x, samples)
            missing -= law.rows.T @ force
            scale += np.linalg.norm(force)
    rigid = [law for law in own.laws if law.rigid]
    if not rigid:
        return float(np.linalg.norm(missing) / scale)
    rows = np.concatenate([law.rows for law in rigid])
    needed = np.linalg.lstsq(rows.T, missing)[0]
    errors, first = [missing - rows.T @ needed], 0
    for law in rigid:
        own_rows = slice(first, first + len(law.rows))
        force = contact_force(law, law.rows @ x + needed[own_rows] / law.stiffness, samples)
        errors.append(force - needed[own_rows])
        scale += np.linalg.norm(force)
        first += len(law.rows)
    return float(np.sqrt(sum(np.sum(error**2) for error in errors)) / scale)


@dataclass(frozen=True)
class Outcome:
    """What became of a system at given frequencies.

    Parameters
    ----------
    residuals : list of float
        Of the points found, by :func:`unbalanced`.
    lost : int
        Points that are not found though a fixed sampling finds them.
    refused : int
        Points that no sampling finds.
    """

    residuals: list[float]
    lost: int
    refused: int


def at_frequencies(own: RandomSystem, method: HarmonicBalance = METHOD) -> Outcome:
    """The points of a system, each judged."""
    curve = frequency_response(own.system, own.frequencies, method, check=False)
    residuals = [_judged(own, curve, point) for point in np.flatnonzero(curve.converged)]
    missing = ~curve.converged
    others = np.zeros(len(curve), dtype=bool)
    for fixed in FIXED if missing.any() else []:
        others |= frequency_response(own.system, own.frequencies, fixed, check=False).converged
    return Outcome(residuals, int(np.sum(missing & others)), int(np.sum(missing & ~others)))


def _judged(own: RandomSystem, curve: FrequencyCurve, point: int) -> float:
    """Residual of a point, on a finer grid where a state between two instants of the coarse one may be missing."""
    residual = unbalanced(own, curve, point)
    return residual if residual < ACCEPTED / 3 else unbalanced(own, curve, point, 4 * SAMPLES)


def path_end(own: RandomSystem, method: HarmonicBalance = PATHS) -> tuple[float, FrequencyCurve]:
    """Part of the range at which a path by arc length ends, and the path."""
    low, high = own.frequencies[[0, -1]]
    path = frequency_response(own.system, (low, high), method, continuation="arc-length", check=False)
    last = path.frequencies[path.converged][-1:] if path.converged.any() else np.array([low])
    return float((last[0] - low) / (high - low)), path


def row(number: int) -> str:
    """A line of the table."""
    own = random_system(number)
    outcome, (part, path) = at_frequencies(own), path_end(own)
    worst = f"{max(outcome.residuals):.0e}" if outcome.residuals else ""
    found = len(outcome.residuals)
    return f"{number},{'; '.join(own.kinds)},{found},{worst},{outcome.lost},{outcome.refused},{part:.4f},{len(path)}"


HEAD = "system,contacts,points found,largest residual,points lost,points refused,part of the range,points of the path"


def main() -> None:
    """Write the table, or go on with it for some seconds."""
    count, limit = int(sys.argv[1]) if len(sys.argv) > 1 else 200, float(sys.argv[2]) if len(sys.argv) > 2 else np.inf
    begin, part = time.monotonic(), TABLE.with_suffix(".part")
    if not part.exists():
        part.write_text(HEAD + "\n", encoding="utf-8")
    for number in range(len(part.read_text(encoding="utf-8").splitlines()) - 1, count):
        if time.monotonic() - begin > limit:
            return
        line = row(number)
        with part.open("a", encoding="utf-8") as file:
            file.write(line + "\n")
    part.replace(TABLE)


if __name__ == "__main__":
    main()
