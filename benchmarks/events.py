"""Harmonic balance with sums corrected at events beside plain sums of as many samples as give the same accuracy."""

from pathlib import Path

import numpy as np

from benchmarks import timing
from dalembert import (
    ElasticSlider,
    FrictionContact,
    HarmonicBalance,
    HarmonicForce,
    VibrationSystem,
    frequency_response,
)
from dalembert.structure import lumped
from dalembert.study import load

STUDIES = Path(__file__).parents[1] / "studies"
INTERFACES, PLATE = STUDIES / "two-interfaces" / "elastic.toml", STUDIES / "patched-plate" / "sweep.toml"
REFERENCE, MOST = 4096, 16_384
HARMONICS = 7


def slider(masses: int) -> tuple[VibrationSystem, np.ndarray, str]:
    """One mass, or two, with an elastic slider, frequencies in Hz, and the mass that is observed."""
    if masses == 1:
        own = VibrationSystem(lumped({"m1": 1.0}, [("m1", None, 1.0, 0.04)]))
        law, friction = ElasticSlider(0.8), 0.5
    else:
        springs = [("m1", None, 1.0, 0.02), ("m1", "m2", 1.0, 0.02), ("m2", None, 0.5, 0.01)]
        own = VibrationSystem(lumped({"m1": 1.0, "m2": 1.0}, springs))
        law, friction = ElasticSlider(1.5), 0.3
    own.add(HarmonicForce("m1", 1.0))
    own.add(FrictionContact("slider", f"m{masses}", friction=friction, preload=2.0, law=law))
    return own, np.linspace(0.5, 1.6, 100) / (2 * np.pi), f"m{masses}"


def interfaces() -> tuple[VibrationSystem, np.ndarray, str]:
    """The study of two interfaces with elastic contacts and a preload of 80 N."""
    build = load(INTERFACES).along("preload")
    return build(preload=80.0), np.linspace(200.0, 280.0, 81), "upper1.x"


def plate() -> tuple[VibrationSystem, np.ndarray, str]:
    """The study of a plate with patches, whose contacts slip in two directions, near its resonance."""
    return load(PLATE).along("preload")(preload=80.0), np.linspace(404.5, 407.0, 6), "left.z"


def main() -> list[dict[str, object]]:
    """Time a point of each; errors are of the amplitude, beside sums corrected with many samples."""
    cases = {"one mass": slider(1), "two masses": slider(2), "two interfaces": interfaces(), "patched plate": plate()}
    rows = [_row(name, *case) for name, case in cases.items()]
    timing.report("events", f"Friction in frequency: sums corrected at events, {HARMONICS} harmonics", rows)
    return rows


def _row(name: str, own: VibrationSystem, frequencies: np.ndarray, dof: str) -> dict[str, object]:
    def amplitudes(method: HarmonicBalance) -> np.ndarray:
        return frequency_response(own, frequencies, method, check=False).amplitude(dof)

    exact = amplitudes(HarmonicBalance(HARMONICS, samples=REFERENCE))

    def error(method: HarmonicBalance) -> float:
        return float(np.nanmax(np.abs(amplitudes(method) / exact - 1)))

    corrected = HarmonicBalance(HARMONICS)
    wanted, samples = error(corrected), 64
    while error(plain := HarmonicBalance(HARMONICS, samples=samples, events=False)) > wanted and samples < MOST:
        samples *= 2
    times = timing.interleaved(
        {"corrected": lambda: amplitudes(corrected), "plain": lambda: amplitudes(plain)}, repeats=5
    )
    return {
        "model": name,
        "corrected: milliseconds a point": 1e3 * times["corrected"] / len(frequencies),
        "corrected: error": wanted,
        "plain: samples": samples,
        "plain: milliseconds a point": 1e3 * times["plain"] / len(frequencies),
        "plain: error": error(plain),
        "ratio": times["plain"] / times["corrected"],
    }


if __name__ == "__main__":
    main()
