"""What a ring-down shows that its numbers do not say."""

from collections.abc import Iterator

import numpy as np

from dalembert.findings import Finding
from dalembert.inverse.decays.equivalent_law import EquivalentLaw
from dalembert.inverse.decays.free_decay import FreeDecay
from dalembert.inverse.decays.ring_down_result import RingDown

BIASED = 0.5
"""Bias in deviations from which it is stated."""
DIFFERENT = 4.0
"""Median difference of the two methods, in deviations, that is no chance."""
SMALL = 5e-3
"""Relative difference of the two methods that is their own accuracy."""
MISFIT = 4.0
"""Median distance of decay rates from the equivalent law, in deviations, that one mode does not have."""


def record_findings(decay: FreeDecay, number: int) -> Iterator[Finding]:
    """Yield what one record shows. ``number``: of the record, from 1."""
    if not decay.clean:
        yield Finding(
            "start-not-free",
            "warning",
            {"start": decay.record.start, "record": number},
            f"No window behind the largest amplitude of record {number} fits a free decay; the first one begins at "
            f"{decay.record.start:.6g} s.",
            "Give the time at which the hammer has left the structure, start=..., or the channel of its force.",
        )


def result_findings(result: RingDown, law: EquivalentLaw) -> Iterator[Finding]:
    """Yield what all records together show."""
    if len(result.other_modes):
        frequency = float(np.median(result.frequencies))
        nearest = float(result.other_modes[np.argmin(np.abs(result.other_modes - frequency))])
        text = ", ".join(f"{mode:.5g} Hz" for mode in result.other_modes)
        yield Finding(
            "other-modes",
            "note",
            {"modes": result.other_modes.tolist(), "nearest": nearest},
            f"Other modes vibrate in the decay and are fitted with it: {text}.",
            "",
        )
    sizes = result.bias / (2 * np.pi * result.frequency_deviations)
    if np.max(sizes) > BIASED:
        worst = int(np.argmax(sizes))
        yield Finding(
            "window-bias",
            "note",
            {"bias": float(result.bias[worst]), "amplitude": float(result.amplitudes[worst])},
            f"Frequency or damping change within the shortest windows: at {result.amplitudes[worst]:.4g} {result.unit} "
            f"that changes the frequency by about {result.bias[worst] / (2 * np.pi):.2g} Hz, and the damping ratio by "
            f"{100 * result.bias[worst] / (2 * np.pi * result.frequencies[worst]):.2g} %.",
            "",
        )
    known = np.isfinite(result.band_damping)
    if known.any():
        relative = np.abs(result.band_damping / result.decay_damping - 1)[known]
        deviations = (result.damping_deviations / result.damping)[known]
        excess = float(np.median(relative / np.maximum(deviations, SMALL)))
        if excess > DIFFERENT:
            yield Finding(
                "methods-differ",
                "warning",
                {"difference": float(np.median(relative))},
                f"Damping ratios by the band-pass filter differ from those of the windows by "
                f"{100 * np.median(relative):.2g} % in the median.",
                "Look for another mode within the band, and give a longer record if there is one.",
            )
    misfit = float(np.median(np.abs(law.misfits[:, 1])))
    if misfit > MISFIT:
        yield Finding(
            "not-one-mode",
            "warning",
            {"misfit": misfit},
            "The decay rate does not depend on the amplitude alone: it varies along the decay as the beat of two modes "
            "does.",
            "Measure where only one of the modes moves, or excite it alone.",
        )
