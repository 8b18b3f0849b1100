"""Frequency and damping of a mode over its amplitude, from measured free decays."""

from collections.abc import Mapping, Sequence

from dalembert.argument_readers import names_of
from dalembert.data import Measurements
from dalembert.errors import InputError, require_known
from dalembert.inverse.decays.first_look import first_look
from dalembert.inverse.decays.identified_decay import identified_decay
from dalembert.inverse.decays.joined_decays import joined_decays
from dalembert.inverse.decays.measured_decay import measured_decay
from dalembert.inverse.decays.ring_down_result import RingDown
from dalembert.threads import single_thread


@single_thread()
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
    >>> import numpy as np
    >>> from dalembert.data import Measurements
    >>> from dalembert.inverse import ring_down
    >>> times = np.arange(6000) / 1000
    >>> signal = np.exp(-2 * np.pi * 10 * 0.01 * times) * np.cos(2 * np.pi * 10 * times)
    >>> noise = 1e-3 * np.random.default_rng(0).normal(size=len(times))
    >>> data = Measurements.of(times, {"tip": signal + noise})
    >>> mode = ring_down(data, quantity="displacement")
    >>> bool(np.abs(mode.frequencies / 10 - 1).max() < 0.01), bool(abs(mode.damping[0] / 0.01 - 1) < 0.01)
    (True, True)
    """
    records = [data] if isinstance(data, Measurements) else list(data)
    if not records or not all(isinstance(measured, Measurements) for measured in records):
        raise InputError("ring_down: data must be Measurements, or a list of them. Read a file by dalembert.read")
    for number, measured in enumerate(records[1:], 2):
        if measured.channels != records[0].channels:
            raise InputError(
                f"ring_down: record {number} has the channels {', '.join(measured.channels)}; expected "
                f"{', '.join(records[0].channels)}, as in the first"
            )
    chosen_channels = None if channels is None else names_of(channels, "ring_down", "channels")
    if reference is not None:
        require_known("channel", reference, chosen_channels or records[0].channels, "ring_down: reference")
    decays = []
    for measured in records:
        record = measured_decay(measured, chosen_channels, quantity, force)
        decays.append(identified_decay(first_look(record, frequency, start)))
        # Repetitions show the mode of the first record.
        frequency = frequency or decays[0].decay.frequency
    return joined_decays(decays, records, reference)
