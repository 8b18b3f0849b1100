"""Write link.inp, the mesh of the link, and motion.csv: the tip of the link in a motion of the robot (mm), with noise.

The data are those of a finer mesh with more modes, by another integrator than that of the study.
"""

from pathlib import Path

import numpy as np

import dalembert.multibody as mb
import dalembert.multibody.spatial as sp
from dalembert.structure import Material, free_body_modes, solid

FOLDER = Path(__file__).parent
LENGTH, THICK, WIDE, NARROW = 0.5, 0.006, 0.03, 0.015  # m; the width falls from the foot to the tip
MODULUS, RATIO, DENSITY, DAMPING = 20e9, 0.35, 1800.0, 0.02
NOISE = 0.2  # mm


def write_mesh(path: Path, along: int, across: int, through: int) -> None:
    """Write bricks of a tapered bar as an input file of Abaqus, with the sets of nodes foot and tip."""
    counts = along, across, through
    numbers = np.arange(1, np.prod(np.add(counts, 1)) + 1).reshape(np.add(counts, 1))
    lines = ["*NODE"]
    for (i, j, k), number in np.ndenumerate(numbers):
        share = i / along
        width = WIDE + (NARROW - WIDE) * share
        place = LENGTH * share, width * (j / across - 0.5), THICK * (k / through - 0.5)
        lines.append(f"{number}, " + ", ".join(f"{entry:.6g}" for entry in place))
    lines.append("*ELEMENT, TYPE=C3D8")
    for element, (i, j, k) in enumerate(np.ndindex(*counts), start=1):
        corners = [numbers[i + a, j + b, k + c] for c in (0, 1) for a, b in ((0, 0), (1, 0), (1, 1), (0, 1))]
        lines.append(f"{element}, " + ", ".join(map(str, corners)))
    for name, nodes in (("foot", numbers[0]), ("tip", numbers[-1])):
        lines += [f"*NSET, NSET={name}", ", ".join(map(str, nodes.ravel()))]
    path.write_text("\n".join(lines) + "\n", encoding="utf-8")


def robot(mesh: Path, modes: int) -> sp.SpatialSystem:
    """The robot of the study, with other modes of its link."""
    shapes = free_body_modes(solid(mesh, Material(MODULUS, RATIO, DENSITY)), {"foot": "foot", "tip": "tip"}, modes)
    system = sp.SpatialSystem()
    inertia = sp.Inertia.box(0.5, (0.3, 0.04, 0.04)).moved((0.15, 0.0, 0.0))
    arm = system.add(sp.RigidBody("arm", inertia, points={"elbow": (0.3, 0.0, 0.0)}))
    link = sp.ReducedBody("link", shapes, arm.point("elbow"), anchor="foot", damping_ratio=DAMPING)
    link = system.add(link)
    joints = (("shoulder", system.ground, arm.point("origin"), (0.0, 0.0, 1.0), 0.5, 8.0),
              ("elbow", arm.point("elbow"), link.point("foot"), (0.0, 1.0, 0.0), 0.4, 12.0))  # fmt: skip
    for name, a, b, axis, amplitude, rate in joints:
        system.add(sp.RevoluteJoint(name, a, b, axis=axis))
        motion = mb.Harmonic(amplitude, rate)
        system.add(sp.PrescribedMotion(f"{name} drive", a, b, "angle", motion, axis=axis))
    return system


def main() -> None:
    write_mesh(FOLDER / "link.inp", 10, 2, 1)
    fine = FOLDER / "fine.inp"
    write_mesh(fine, 20, 4, 2)
    times = np.linspace(0.0, 0.6, 121)
    motion = mb.simulate(robot(fine, 24), times[-1], mb.RadauIIA(tolerance=1e-8), times=times)
    fine.unlink()
    tip = 1e3 * motion.channels([f"link.tip.{axis}" for axis in "xyz"])
    values = tip + np.random.default_rng(6).normal(scale=NOISE, size=tip.shape)
    rows = [
        ",".join([f"{time:.3f}", *(f"{entry:.2f}" for entry in row)]) for time, row in zip(times, values, strict=True)
    ]
    (FOLDER / "motion.csv").write_text("\n".join(["t,x,y,z", *rows]) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
