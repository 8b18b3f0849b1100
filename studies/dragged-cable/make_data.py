"""Write motion.csv: three points of a dragged cable (mm), with noise.

The data are those of twice as many elements, by another integrator than that of the study.
"""

from pathlib import Path

import numpy as np

import dalembert.multibody as mb
import dalembert.multibody.spatial as sp

FOLDER = Path(__file__).parent
BENDING, DAMPING, DRAG = 0.02, 0.03, 0.4  # N m^2, s, 1/s
NOISE = 1.0  # mm


def dragged(elements: int) -> sp.SpatialSystem:
    """The cable of the study."""
    system = sp.SpatialSystem(start="equilibrium")
    down = sp.Orientation.by_axes((1.0, 0.0, 0.0), (0.0, 0.0, -1.0))
    fields = {"axial_stiffness": 2e4, "mass_per_length": 0.15, "bending_stiffness": BENDING, "orientation": down}
    cable = system.add(sp.Cable("cable", 1.2, elements, damping=DAMPING, mass_damping=DRAG, **fields))
    courses = {
        "x": ((1.0, 0.0, 0.0), mb.Harmonic(0.2, 7.0, -np.pi / 2, 0.2)),
        "y": ((0.0, 1.0, 0.0), mb.Harmonic(0.1, 11.0, -np.pi / 2, 0.1)),
        "z": ((0.0, 0.0, 1.0), 0.0),
    }
    for name, (axis, course) in courses.items():
        system.add(
            sp.PrescribedMotion(
                name, system.ground.point((0.0, 0.0, 0.0)), cable.start, "displacement", course, axis=axis
            )
        )
    return system


def main() -> None:
    times = np.linspace(0.0, 1.5, 151)
    motion = mb.simulate(dragged(12), times[-1], mb.RadauIIA(tolerance=1e-8), times=times)
    places = 1e3 * motion.channels([f"cable.{node}.{axis}" for node in ("node4", "node8", "end") for axis in "xyz"])
    values = places + np.random.default_rng(8).normal(scale=NOISE, size=places.shape)
    header = ["t", *(f"{axis}{k}" for k in (1, 2, 3) for axis in "xyz")]
    rows = [
        ",".join([f"{time:.3f}", *(f"{entry:.1f}" for entry in row)]) for time, row in zip(times, values, strict=True)
    ]
    (FOLDER / "motion.csv").write_text("\n".join([",".join(header), *rows]) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
