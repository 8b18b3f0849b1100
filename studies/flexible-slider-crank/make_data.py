"""Write motion.csv: the middle of the rod and the slider of a flexible slider-crank (mm), with noise.

The data are those of finer elements, by another integrator than that of the study.
"""

from pathlib import Path

import numpy as np

import dalembert.multibody as mb
import dalembert.multibody.spatial as sp

FOLDER = Path(__file__).parent
MODULUS, DAMPING, SPEED = 3e9, 2e-4, 25.0  # Pa, s, rad/s
NOISE = 0.05  # mm
CRANK, ROD, PIN = 0.08, 0.3, (0.0, 0.1, 0.12)  # m


def mechanism(elements: int, degree: int) -> sp.SpatialSystem:
    """The mechanism of the study, with other elements of its rod."""
    high = PIN[2] + CRANK
    way = np.sqrt(ROD**2 - PIN[1] ** 2 - high**2)
    system, along = sp.SpatialSystem(), (1.0, 0.0, 0.0)
    inertia = sp.Inertia(0.12, (1e-3, 1e-3, 1e-3))
    crank = system.add(sp.RigidBody("crank", inertia, PIN, points={"end": (0.0, 0.0, CRANK)}))
    section = sp.Section.rectangle(0.012, 0.005, youngs_modulus=MODULUS, poisson_ratio=0.4, density=1150.0)
    turn = sp.Orientation.by_axes((0.0, -high, PIN[1]), (way, -PIN[1], -high))
    rod = sp.Beam("rod", section, ROD, elements, degree, (0.0, PIN[1], high), turn, damping=DAMPING)
    rod = system.add(rod)
    slider = system.add(sp.RigidBody("slider", sp.Inertia.box(0.3, (0.05, 0.05, 0.05)), (way, 0.0, 0.0)))
    bearing, slide = system.ground.point(PIN), system.ground.point((0.0, 0.0, 0.0))
    course = mb.Polynomial([0.0, SPEED])
    for joint in (
        sp.RevoluteJoint("bearing", bearing, crank.point("origin"), axis=along),
        sp.PrescribedMotion("drive", bearing, crank.point("origin"), "angle", course, axis=along),
        sp.UniversalJoint("crank-pin", crank.point("end"), rod.start, axis_a=along, axis_b=(0.0, 0.0, 1.0)),
        sp.SphericalJoint("slider-pin", rod.end, slider.point("origin")),
        sp.PrismaticJoint("slide", slide, slider.point("origin"), axis=along),
    ):
        system.add(joint)
    return system


def main() -> None:
    times = np.linspace(0.0, 0.4, 161)
    motion = mb.simulate(mechanism(4, 3), times[-1], mb.RadauIIA(tolerance=1e-8), times=times)
    places = 1e3 * motion.channels([*(f"rod.node6.{axis}" for axis in "xyz"), "slider.origin.x"])
    values = places + np.random.default_rng(9).normal(scale=NOISE, size=places.shape)
    rows = [
        ",".join([f"{time:.4f}", *(f"{entry:.2f}" for entry in row)]) for time, row in zip(times, values, strict=True)
    ]
    (FOLDER / "motion.csv").write_text("\n".join(["t,x,y,z,way", *rows]) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
