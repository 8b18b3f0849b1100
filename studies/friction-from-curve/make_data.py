"""Write low.csv and high.csv: first harmonics of the block at forces of 4 and 8 N, with noise of 4 and 16 µm."""

from pathlib import Path

import numpy as np

from dalembert.study import load
from dalembert.vibration import frequency_responses

FOLDER = Path(__file__).parent
LEVELS = {"low": (4.0, 4e-6), "high": (8.0, 16e-6)}  # force in N, deviation in m


def main() -> None:
    """Write the files."""
    study, draw = load(FOLDER / "truth.toml"), np.random.default_rng(0)
    frequencies = np.linspace(26.0, 46.0, 41)
    forces = [force for force, _ in LEVELS.values()]
    family = frequency_responses(study.builder, "force", forces, frequencies, study.balance)
    for (name, (_, noise)), curve in zip(LEVELS.items(), family.curves, strict=True):
        assert curve is not None
        sizes = curve.amplitude("block.x", "harmonic 1") + noise * draw.standard_normal(len(frequencies))
        rows = np.column_stack([frequencies, 1e6 * sizes])
        np.savetxt(FOLDER / f"{name}.csv", rows, fmt=["%.1f", "%.2f"], delimiter=",", header="f,x", comments="")


if __name__ == "__main__":
    main()
