"""The decays of all records as one result."""

from dataclasses import replace

import numpy as np
from scipy.linalg import block_diag

import dalembert
from dalembert.data import Measurements
from dalembert.inverse.decays.equivalent_law import equivalent_law
from dalembert.inverse.decays.identified_decay import IdentifiedDecay
from dalembert.inverse.decays.ring_down_findings import record_findings, result_findings
from dalembert.inverse.decays.ring_down_result import RingDown
from dalembert.inverse.decays.sensors import Phasors

CLEAR = 0.1
"""Strength of a channel over that of the best from which it may be the reference."""
NEXT = 0.02
"""Relative step of the amplitude over which the change of the law is taken."""
ALIKE = 0.01
"""Relative difference of the frequencies of one mode in several records."""


def joined_decays(decays: list[IdentifiedDecay], records: list[Measurements], reference: str | None) -> RingDown:
    """The result of the decays of all records, with one law."""
    sensors = decays[0].decay.record.channels
    amplitudes: Phasors = np.concatenate([each.estimates.amplitudes for each in decays])
    column = _most_moving(decays, amplitudes) if reference is None else sensors.index(reference)
    slopes: Phasors = np.concatenate([each.estimates.slopes for each in decays])
    count = len(slopes)
    joint = np.asarray(block_diag(*(each.covariance.reshape(2 * len(each.estimates), -1) for each in decays)))
    deviations = np.sqrt(np.diag(joint)).reshape(count, 2)
    size = np.abs(amplitudes[:, column])
    bias = np.concatenate([each.bias for each in decays])
    law = equivalent_law(size, slopes, np.hypot(deviations, bias[:, None]))
    frequencies, damping = law.periodic(size, slopes)
    # From (−σ, ω) to (ω/2π, σ/ω) of the periodic motion; its small difference from the decay is taken as known.
    omega, sigma = slopes.imag, -slopes.real
    ratio = damping / (sigma / omega)
    transform = np.zeros((count, 2, 2))
    transform[:, 0, 1] = 1 / (2 * np.pi)
    transform[:, 1, 0] = -ratio / omega
    transform[:, 1, 1] = -ratio * sigma / omega**2
    covariance = np.einsum("iab,ibjc,jdc->iajd", transform, joint.reshape(count, 2, count, 2), transform)
    # The amplitude has an error, too: where the mode changes with it, the values at this amplitude are less certain.
    errors = np.concatenate([each.amplitude_deviations(column) for each in decays])
    change = (law.slopes(size * (1 + NEXT)) - law.slopes(size * (1 - NEXT))) / (2 * NEXT)
    slope = np.stack([change.imag / (2 * np.pi), -(change.real + sigma / omega * change.imag) / omega], axis=1)
    points = np.arange(count)
    for quantity in range(2):
        covariance[points, quantity, points, quantity] += (slope[:, quantity] * errors / size) ** 2
    spread = np.sqrt(np.einsum("iaia->ia", covariance))
    band: Phasors = np.concatenate([each.band for each in decays])
    shapes = amplitudes / amplitudes[:, [column]]
    # Each mode once, of those that the records share.
    modes = np.sort(np.concatenate([each.other_modes for each in decays]))
    result = RingDown(
        channels=sensors,
        reference=sensors[column],
        unit=decays[0].decay.record.units[column],
        record=np.concatenate([np.full(len(each.estimates), number) for number, each in enumerate(decays, 1)]),
        times=np.concatenate([each.estimates.times for each in decays]),
        amplitudes=size,
        amplitude_deviations=errors,
        frequencies=frequencies / (2 * np.pi),
        frequency_deviations=spread[:, 0],
        damping=damping,
        damping_deviations=spread[:, 1],
        covariance=covariance,
        decay_frequencies=omega / (2 * np.pi),
        decay_damping=sigma / omega,
        band_frequencies=band.imag / (2 * np.pi),
        band_damping=-band.real / band.imag,
        shapes=np.stack([shapes.real, shapes.imag], axis=2),
        noise=np.sqrt(np.mean([(each.noise / each.decay.record.passed) ** 2 for each in decays], axis=0)),
        periods=np.concatenate([each.estimates.halves for each in decays]) * omega / np.pi,
        degrees=np.array([fit.exponents.shape[1] - 1 for each in decays for fit in each.estimates.fits]),
        bias=bias,
        other_modes=modes[np.diff(modes, prepend=0.0) > ALIKE * modes],
        slips=law.slips,
        stiffnesses=law.stiffnesses,
        elastic=law.elastic,
        viscous=law.viscous,
        provenance={"version": dalembert.__version__, "data": [measured.fingerprint for measured in records]},
    )
    starts = [finding for number, each in enumerate(decays, 1) for finding in record_findings(each.decay, number)]
    return replace(result, findings=(*starts, *result_findings(result, law)))


def _most_moving(decays: list[IdentifiedDecay], amplitudes: Phasors) -> int:
    """The channel that moves most among those with little noise that measure what the best of them does."""
    strengths, units = np.mean([each.strengths for each in decays], axis=0), decays[0].decay.record.units
    best = int(np.argmax(strengths))
    alike = [
        strength > CLEAR * strengths[best] and unit == units[best]
        for strength, unit in zip(strengths, units, strict=True)
    ]
    return int(np.argmax(np.where(alike, np.abs(amplitudes).mean(axis=0), -1.0)))
