"""Frequency and damping of a mode over its amplitude, from measured free decays."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from scipy.linalg import block_diag

import dalembert
from dalembert.argument_readers import names_of
from dalembert.data import Measurements
from dalembert.errors import DataError, InputError, require_known
from dalembert.inverse.decays.band_pass import HALF_BAND, analytic_signal
from dalembert.inverse.decays.decay_record import decay_record
from dalembert.inverse.decays.equivalent_law import equivalent_law
from dalembert.inverse.decays.free_decay import FreeDecay, free_decay, mode_frequency
from dalembert.inverse.decays.noise_level import noise_at_mode
from dalembert.inverse.decays.record_windows import WindowEstimates, estimate, even_places
from dalembert.inverse.decays.ring_down_findings import record_findings, result_findings
from dalembert.inverse.decays.ring_down_result import RingDown
from dalembert.inverse.decays.window_choice import Suited, suited_windows
from dalembert.inverse.decays.window_fit import Phasors

BESIDE = 1.0
"""Half of the band of the filter, in parts of a window's frequency that separates the modes."""
UNCERTAIN = 0.3
"""Relative deviation of the decay rate from which a window says nothing on the damping."""
LOOK = (6.0, 2)
"""Periods and degree of the windows from which the first law comes."""
ROUNDS = 2
"""Times that windows are chosen, each time by the law of the windows before."""


def ring_down(
    data: Measurements | Sequence[Measurements],
    frequency: float | None = None,
    *,
    channels: Sequence[str] | None = None,
    quantity: str | Mapping[str, str] | None = None,
    force: str | None = None,
    start: float | None = None,
    reference: str | None = None,
) -> RingDown:
    r"""Frequency and damping of a mode over its amplitude, from one or several records of its free decay.

    Parameters
    ----------
    data : Measurements, or a sequence of them
        Even samples over time, of one or several sensors; a sequence: repetitions with the same channels.
    frequency : float, optional
        Hz, near that of the mode; the strongest line of the spectrum if not given.
    channels : sequence of str, optional
        Sensors; all if not given, but the hammer's force.
    quantity : str, or mapping of str to str, optional
        ``"displacement"``, ``"velocity"``, ``"acceleration"`` or ``"strain"``, for all channels or each by its name; by
        the unit of the channel in its file if not given.
    force : str, optional
        Channel of the hammer's force: the free decay begins where it ends. Without it the decay begins where windows
        behind the largest amplitude fit.
    start : float, optional
        Time, s, at which the free decay begins.
    reference : str, optional
        Channel by whose displacement the amplitude is measured; the one that moves most if not given.

    Returns
    -------
    RingDown

    Raises
    ------
    DataError
        For clipped or missing samples, a record that is too short for the damping, or that does not decay.
    InputError
        For an unknown channel, or one that measures an unknown quantity.

    Notes
    -----
    Windows of a few periods along the record, four over each sample: in each the logarithm of the amplitude and the
    phase are polynomials of time, fitted with harmonics, other modes and drift to all sensors at once. The number of
    periods is the largest whose bias is small against the noise. Standard deviations follow from the noise at the
    frequency of the mode, and state the covariance of windows that overlap. A band-pass filter with Hilbert transform
    repeats the estimates as a check. From the decay to the periodic motion: see
    :mod:`dalembert.inverse.decays.equivalent_law`.

    Examples
    --------
    >>> times = np.arange(6000) / 1000
    >>> signal = np.exp(-2 * np.pi * 10 * 0.01 * times) * np.cos(2 * np.pi * 10 * times)
    >>> noise = 1e-3 * np.random.default_rng(0).normal(size=len(times))
    >>> data = Measurements.of(times, {"tip": signal + noise})
    >>> mode = ring_down(data, quantity="displacement")
    >>> bool(np.abs(mode.frequencies / 10 - 1).max() < 0.01), bool(abs(mode.damping[0] / 0.01 - 1) < 0.01)
    (True, True)
    """
    records = [data] if isinstance(data, Measurements) else list(data)
    _require_alike(records)
    chosen_channels = None if channels is None else names_of(channels, "ring_down", "channels")
    decays = []
    for measured in records:
        record = decay_record(measured, chosen_channels, quantity, force)
        if frequency is None:
            frequency = mode_frequency(record, None)
        decays.append(_identified(free_decay(record, mode_frequency(record, frequency), start)))
    sensors = decays[0].decay.record.channels
    if reference is not None:
        require_known("channel", reference, sensors, "ring_down: reference")
    return _concluded(decays, records, sensors, reference)


def _require_alike(records: list[Measurements]) -> None:
    """Refuse no records, and records of other channels than the first."""
    if not records or not all(isinstance(measured, Measurements) for measured in records):
        raise InputError("ring_down: data must be Measurements, or a list of them. Read a file by dalembert.read")
    for number, measured in enumerate(records[1:], 2):
        if measured.channels != records[0].channels:
            raise InputError(
                f"ring_down: record {number} has the channels {', '.join(measured.channels)}; expected "
                f"{', '.join(records[0].channels)}, as in the first"
            )


@dataclass(frozen=True)
class IdentifiedDecay:
    """Estimates of a record with their bias (windows,), 1/s, the noise (channels,), and the covariance (windows, 2,
    windows, 2) of −σ and ω. ``band`` (windows,): −σ + iω by the band-pass filter.
    """

    decay: FreeDecay
    estimates: WindowEstimates
    bias: np.ndarray
    noise: np.ndarray
    covariance: np.ndarray
    band: Phasors


def _identified(decay: FreeDecay) -> IdentifiedDecay:
    """The windows of a free decay that suit its noise."""
    places = even_places(decay.record, decay.rates, max(LOOK[0], decay.shortest), LOOK[1], 0.5)
    first = estimate(decay.record, places, decay.rates, decay.sensors, decay.harmonics)
    suited = Suited(first, np.zeros(len(first)))
    for _ in range(ROUNDS):
        known = _sure(suited, decay.sensors.deviations, decay)
        deviations = np.sqrt(known.estimates.variances(decay.sensors.deviations))
        law = equivalent_law(
            np.abs(known.estimates.amplitudes).sum(axis=1),
            known.estimates.slopes,
            np.hypot(deviations, known.bias[:, None]),
        )
        suited = suited_windows(decay, law, known.estimates)
        decay = replace(
            decay, sensors=replace(decay.sensors, deviations=noise_at_mode(suited.estimates, decay.sensors))
        )
    noise = decay.sensors.deviations
    suited = _sure(suited, noise, decay)
    estimates = suited.estimates
    degree = max(fit.exponents.shape[1] - 1 for fit in estimates.fits)
    half_band = min(HALF_BAND, BESIDE / decay.shortest if decay.shortest else HALF_BAND)
    signal = decay.signal if half_band == HALF_BAND else analytic_signal(decay.record, decay.frequency, half_band)
    band = signal.slopes(estimates.middles, estimates.halves, degree, noise)
    return IdentifiedDecay(decay, estimates, suited.bias, noise, estimates.covariance(noise), band)


def _sure(suited: Suited, noise: np.ndarray, decay: FreeDecay) -> Suited:
    """The windows that know the decay rate."""
    estimates = suited.estimates
    rates = -estimates.slopes.real
    sure = (
        np.sqrt(estimates.variances(noise)[:, 0]) < UNCERTAIN * np.abs(rates) if len(estimates) else np.zeros(0, bool)
    )
    if not sure.any():
        fall = 1 - np.exp(-float(np.median(rates)) * decay.record.duration) if len(rates) else 0.0
        raise DataError(
            f"ring_down: the record is too short, or too noisy, for the damping: in its {decay.record.duration:.3g} s "
            f"the amplitude falls by {100 * fall:.2g} %. Record for longer, or hit harder"
        )
    if np.mean(rates[sure] < 0) > 0.5:
        raise DataError(
            "ring_down: the amplitude grows. Give the part of the record in which the mode decays, start=..., or look "
            "whether something excites it"
        )
    rows = sure & (rates > 0)
    return Suited(estimates.kept(rows), suited.bias[rows])


def _concluded(
    decays: list[IdentifiedDecay], records: list[Measurements], sensors: tuple[str, ...], reference: str | None
) -> RingDown:
    amplitudes: Phasors = np.concatenate([each.estimates.amplitudes for each in decays])
    column = int(np.argmax(np.abs(amplitudes).mean(axis=0))) if reference is None else sensors.index(reference)
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
    spread = np.sqrt(np.einsum("iaia->ia", covariance))
    band: Phasors = np.concatenate([each.band for each in decays])
    shapes = amplitudes / amplitudes[:, [column]]
    result = RingDown(
        channels=sensors,
        reference=sensors[column],
        unit=_unit(records[0], sensors[column], decays[0].decay.record.orders[column]),
        record=np.concatenate([np.full(len(each.estimates), number) for number, each in enumerate(decays, 1)]),
        times=np.concatenate([each.estimates.times for each in decays]),
        amplitudes=size,
        amplitude_deviations=np.concatenate([_amplitude_deviations(each, column) for each in decays]),
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
        noise=np.sqrt(np.mean([each.noise**2 for each in decays], axis=0)),
        periods=np.concatenate([each.estimates.halves for each in decays]) * omega / np.pi,
        degrees=np.array([fit.exponents.shape[1] - 1 for each in decays for fit in each.estimates.fits]),
        bias=bias,
        other_modes=_other_modes(decays[0]),
        slips=law.slips,
        stiffnesses=law.stiffnesses,
        elastic=law.elastic,
        viscous=law.viscous,
        provenance={"version": dalembert.__version__, "data": [measured.fingerprint for measured in records]},
    )
    findings = [finding for each in decays for finding in record_findings(each.decay)]
    return replace(result, findings=(*findings, *result_findings(result, law)))


def _other_modes(each: IdentifiedDecay) -> np.ndarray:
    """Frequencies, Hz, of the other modes of a decay, from the longest window with each."""
    result = []
    for mode in range(1, len(each.decay.rates.slopes)):
        fits = [fit for fit in each.estimates.fits if len(fit.amplitudes) > mode]
        longest = max(fits, key=lambda fit: fit.window.half, default=None)
        slope = each.decay.rates.slopes[mode, 0] if longest is None else longest.slope(0.0, mode)
        result.append(slope.imag / (2 * np.pi))
    return np.array(result)


def _unit(measured: Measurements, channel: str, order: int) -> str:
    """Unit of a channel's displacement."""
    text = measured.source_units.get(channel, "")
    return "rad" if any(word in text for word in ("rad", "deg")) else "m"


def _amplitude_deviations(each: IdentifiedDecay, column: int) -> np.ndarray:
    """Standard deviations of the amplitudes of a channel: that of a wave of known frequency in white noise."""
    order = each.decay.record.orders[column]
    deviations = []
    for fit, slope in zip(each.estimates.fits, each.estimates.slopes, strict=True):
        # Energy of the fitted wave for unit amplitude of the displacement, at the middle of the window.
        growth = np.exp(-2 * -slope.real * fit.window.times)
        deviations.append(each.noise[column] / np.sqrt(np.sum(growth) * abs(slope) ** (2 * order) / 2))
    return np.array(deviations)
