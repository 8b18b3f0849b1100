"""Draw the convergence of the beam elements on a thin strip: ``python docs/beam_convergence.py``."""

import sys
from pathlib import Path

import dalembert as da

HERE = Path(__file__).parent
sys.path.insert(0, str(HERE.parent))

from benchmarks.log_plot import log_plot  # noqa: E402 - from the benchmarks, which are no package of ours

ELEMENTS = (1, 2, 4, 8, 16, 32)
EXACT = 3.0234240  # Hz, of an elastica, by tests/verification/test_beam_locking.py
STRIP = {"length": 0.52, "youngs_modulus": 2e11, "density": 7870.0, "height": 1e-3, "width": 0.08}


def frequency(kind: type, elements: int, **options: object) -> float:
    """First frequency (Hz) of a steel strip, clamped level, about its sag under its weight."""
    system = da.System()
    bar = system.add(kind("bar", elements=elements, **STRIP, **options))
    system.add(da.FixedJoint("clamp", system.ground, bar.start))
    return float(da.modes(system, 1).frequencies[0])


def main() -> None:
    """Write ``pictures/beam-convergence.svg``."""
    kinds = {
        "AncfBeam, structural": (da.AncfBeam, {"poisson_ratio": 0.3}),
        "AncfBeam, continuum": (da.AncfBeam, {"poisson_ratio": 0.3, "formulation": "continuum"}),
        "AncfCable": (da.AncfCable, {}),
    }
    lines = {}
    for name, (kind, options) in kinds.items():
        errors = [abs(frequency(kind, count, **options) / EXACT - 1) for count in ELEMENTS]
        lines[name] = ELEMENTS, errors
        print(name, *(f"{error:.2g}" for error in errors))
    text = log_plot("Steel strip of 520 × 80 × 1 mm", "elements", "relative error of the first frequency", lines)
    (HERE / "pictures" / "beam-convergence.svg").write_text(text, encoding="utf-8")


if __name__ == "__main__":
    main()
