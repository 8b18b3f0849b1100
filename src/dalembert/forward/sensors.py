"""What sensors read of a response: late by a delay or a lag, scaled by a gain, shifted by an offset, all unknown."""

import hashlib
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import ArrayLike

from dalembert.argument_readers import check_model, samples_of
from dalembert.errors import InputError, require_known, shown
from dalembert.forward.adjoint import ADJOINT, Pull, pullback
from dalembert.forward.complex_steps import check_derivatives
from dalembert.forward.lag import lagged
from dalembert.forward.model import Channel, Coordinate, ForwardModel
from dalembert.forward.refinement import Refinement, refined
from dalembert.forward.responses import Responses
from dalembert.forward.wrapped import starting
from dalembert.parameter import Parameter
from dalembert.parameters import Parameters

START = "start time"  # parameter of the time stamp at which the motion begins
# What a sensor may have, and what it is for a perfect one.
QUANTITIES = {"delay": 0.0, "lag": 0.0, "gain": 1.0, "offset": 0.0}
DEGREE = 5  # of the splines between the samples of the model
Bounds = tuple[float, float] | Parameter


@dataclass(frozen=True)
class Sensor:
    """Bounds of what is not known of a sensor that reads gain · y(t − delay) + offset.

    With a lag, y follows the response R of the model: lag · dy/dt + y = R(t). Without, y is R.

    Parameters
    ----------
    delay : (lower, upper) or Parameter, optional
        s, or the unit of the model's coordinate; positive where the reading comes late. 0 if not given.
    lag : (lower, upper) or Parameter, optional
        Time constant of a first-order low-pass, in the unit of the delay; 0, no lag, if not given. The sensor is at
        rest at the first sample of the model: it begins with the response there.
    gain : (lower, upper) or Parameter, optional
        1 if not given.
    offset : (lower, upper) or Parameter, optional
        In the channel's unit; 0 if not given.
    at_rest : bool
        Whether the response before the first sample of the model equals its first value, so that delayed readings
        there can be computed. Otherwise such readings are an error.
    """

    delay: Bounds | None = None
    lag: Bounds | None = None
    gain: Bounds | None = None
    offset: Bounds | None = None
    at_rest: bool = False


@dataclass(frozen=True)
class Sensors:
    """A model as sensors see it: with a delay, a lag, a gain or an offset a channel as further parameters.

    Parameters
    ----------
    model : ForwardModel
        Its samples lie close enough to be interpolated, and reach as far as the delays ask.
    sensors : mapping of str to Sensor
        By channel; the others are read as they are. Or by component, such as ``"imu"`` or ``"AB.end"``: its channels
        share the unknowns, as those of one instrument share a delay.
    times : array, shape (samples,), optional
        Time stamps of the readings; the model's own samples if not given.
    start : (lower, upper) or Parameter, optional
        Time stamp at which the motion begins, in the unit of the model's coordinate, where it is not known: a parameter
        ``"start time"``, by which all channels come late. 0 if not given.

    Raises
    ------
    InputError
        For a channel that the model lacks, a sensor without unknowns, a quantity of a channel that is given twice, an
        offset that channels of different units share, times outside the model's.

    Notes
    -----
    The parameters are named ``"AB.end.x delay"``, ``"AB.end.x lag"``, ``"AB.end.x gain"`` and ``"AB.end.x offset"``, or
    ``"imu delay"``; a first guess is that of a perfect sensor where the bounds allow it.

    Between samples the response is a spline of degree 5 through them, and its derivatives are those of that spline,
    exact for the response that is computed. The spline of a vibration errs by 7e-8 of its amplitude at 20 samples a
    period and by 1e-9 at 40; by 1e-5 and 2e-7 beside its ends. Stamps that are samples of the model are not
    interpolated in channels without a delay or a lag. A lagged reading is the exact solution for this spline.

    Examples
    --------
    >>> import numpy as np
    >>> from dalembert.forward import PythonModel
    >>> fine = np.linspace(0, 2, 201)
    >>> swing = PythonModel(lambda rate: np.cos(rate * fine), {"rate": (1.0, 9.0)}, ["x"], fine)
    >>> seen = Sensors(swing, {"x": Sensor(delay=(0.0, 0.1), gain=(0.5, 2.0))}, times=np.array([0.5, 1.0]))
    >>> seen.parameters.names
    ('rate', 'x delay', 'x gain')
    >>> seen.evaluate(np.array([[4.0, 0.05, 2.0]])).values.ravel().round(9).tolist()
    [-0.454404189, -1.581935424]
    >>> (2 * np.cos(4 * (seen.coordinate.values - 0.05))).round(9).tolist()
    [-0.454404189, -1.581935424]
    """

    model: ForwardModel
    sensors: Mapping[str, Sensor]
    parameters: Parameters
    coordinate: Coordinate
    start: Bounds | None

    def __init__(
        self,
        model: ForwardModel,
        sensors: Mapping[str, Sensor],
        times: ArrayLike | None = None,
        start: Bounds | None = None,
    ) -> None:
        check_model("Sensors", model)
        if not isinstance(sensors, Mapping) or not all(isinstance(sensor, Sensor) for sensor in sensors.values()):
            raise InputError(f"Sensors: sensors is {shown(sensors)}; expected a mapping from channels to Sensor")
        along = model.coordinate
        stamps = along.values if times is None else samples_of(times, "Sensors", "times")
        unknowns = [entry for name, sensor in sensors.items() for entry in _unknowns(model, name, sensor)]
        # Refuse a quantity that two sensors give of one channel.
        for channel in model.channels:
            for what in QUANTITIES:
                names = [name for name in owners(sensors, channel.name) if getattr(sensors[name], what) is not None]
                if len(names) > 1:
                    givers = " and by ".join(map(repr, names))
                    raise InputError(f"Sensors: the {what} of {channel.name!r} is given by {givers}; expected one")
        unknowns += [] if start is None else [reading_parameter(START, start, along.unit, 0.0)]
        parameters = Parameters((*model.parameters.declared, *unknowns))
        entries = model, dict(sensors), parameters, Coordinate(along.name, along.unit, stamps), start
        vars(self).update(zip(self.__dataclass_fields__, entries, strict=True))
        self._check_reach()

    @property
    def channels(self) -> tuple[Channel, ...]:
        return self.model.channels

    @property
    def scaled(self) -> frozenset[str]:
        """Channels with a gain, whose readings may be in another unit than the channel."""
        givers = [name for name, sensor in self.sensors.items() if sensor.gain is not None]
        return frozenset(channel.name for channel in self.channels if owners(givers, channel.name))

    @property
    def fingerprint(self) -> str:
        """Hash of the model, the sensors and the time stamps."""
        at_rest = sorted(name for name, sensor in self.sensors.items() if sensor.at_rest)
        text = repr((self.model.fingerprint, self.parameters.identity, at_rest))
        return hashlib.sha256(text.encode() + self.coordinate.values.tobytes()).hexdigest()

    def evaluate(self, vectors: np.ndarray) -> Responses:
        """Readings of a batch; ``vectors`` (batch, parameters), values (batch, samples, channels)."""
        vectors = np.atleast_2d(np.asarray(vectors, dtype=float))
        inner = self.model.evaluate(vectors[:, : len(self.model.parameters)])
        values = np.full((len(vectors), len(self.coordinate.values), len(self.channels)), np.nan)
        for row in np.flatnonzero(inner.ok):
            values[row], _ = self._read(vectors[row], inner.values[row][:, :, None])
        return Responses(values, inner.failures)

    def jacobian(self, vector: np.ndarray) -> np.ndarray:
        """Derivative of the readings, shape (samples, channels, parameters)."""
        return self.linearise(vector)[1]

    def linearise(self, vector: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Readings (samples, channels) and their jacobian (samples, channels, parameters)."""
        vector = np.asarray(vector, dtype=float)
        response, slopes = self.model.linearise(vector[: len(self.model.parameters)])
        return self._read(vector, np.concatenate([response[:, :, None], slopes], axis=2))

    @property
    def adjoint_from(self) -> int | None:
        """Number of parameters from which the adjoint is cheaper than the Jacobian; None without an adjoint."""
        least = getattr(self.model, "adjoint_from", None)
        return None if least is None else least + len(self.parameters) - len(self.model.parameters)

    def pullback(self, vector: np.ndarray) -> tuple[np.ndarray, Pull]:
        """Readings (samples, channels), and a function from weights, shaped alike, to the gradient of their sum."""
        vector, inner = np.asarray(vector, dtype=float), len(self.model.parameters)
        response, pull_model = pullback(self.model, vector[:inner], ADJOINT)
        read, slopes = self._read(vector, response[:, :, None])

        def pull(cotangent: np.ndarray) -> np.ndarray:
            cotangent = np.asarray(cotangent, dtype=float)
            model_cotangent = np.zeros_like(response)
            for column, channel in enumerate(self.channels):
                gain = self._value(vector, self._named(channel.name, "gain"), 1.0)
                of_samples, _, _ = self._seen(vector, channel.name, np.eye(len(response)))
                model_cotangent[:, column] = gain * (cotangent[:, column] @ of_samples)
            gradient = np.einsum("sc,scp->p", cotangent, slopes)
            gradient[:inner] += pull_model(model_cotangent)
            return gradient

        return read, pull

    def check_derivatives(self, vector: np.ndarray) -> None:
        """Compare the complex step of the model with differences at a vector (parameters,)."""
        check_derivatives(self.model, vector[: len(self.model.parameters)])

    def starting(self, values: Mapping[str, float]) -> "Sensors":
        """A copy of these readings whose model starts from the one built at these values of its parameters."""
        return Sensors(starting(self.model, values), self.sensors, self.coordinate.values, self.start)

    def first(self, samples: int) -> "Sensors":
        """The same readings, cut to their first ``samples`` samples; the model is cut where they no longer need it."""
        stamps, model_samples = self.coordinate.values[:samples], self.model.coordinate.values
        earliest = min((0.0, *(self._bounds(channel.name)[0] for channel in self.channels)))
        needed = int(np.searchsorted(model_samples, stamps[-1] - earliest, side="left")) + 1
        kept = min(len(model_samples), needed + DEGREE)
        inner = self.model if kept == len(model_samples) else self.model.first(kept)
        return Sensors(inner, self.sensors, stamps, self.start)

    def refined(self) -> Refinement | None:
        """Return the same readings of a more exact model, or None."""
        finer = refined(self.model)
        if finer is None:
            return None
        return replace(finer, model=Sensors(finer.model, self.sensors, self.coordinate.values, self.start))

    def _read(self, vector: np.ndarray, table: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Readings (samples, channels) and their jacobian (samples, channels, parameters).

        ``table`` (model's samples, channels, -) is a response of the model, then its derivatives where they are needed.
        """
        names = self.parameters.names
        read = np.empty((len(self.coordinate.values), len(self.channels)))
        jacobian = np.zeros((*read.shape, len(vector)))
        for column, channel in enumerate(self.channels):
            seen, rate, by_lag = self._seen(vector, channel.name, table[:, column])
            gain = self._value(vector, self._named(channel.name, "gain"), 1.0)
            read[:, column] = gain * seen[:, 0] + self._value(vector, self._named(channel.name, "offset"))
            jacobian[:, column, : seen.shape[1] - 1] = gain * seen[:, 1:]
            slopes = {"delay": -gain * rate, "lag": gain * by_lag, "gain": seen[:, 0], "offset": 1.0}
            by_name = {START: slopes["delay"]} | {
                self._named(channel.name, what): slope for what, slope in slopes.items()
            }
            for name in by_name.keys() & set(names):
                jacobian[:, column, names.index(name)] = by_name[name]
        return read, jacobian

    def _seen(self, vector: np.ndarray, channel: str, table: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Columns (model's samples, columns) of a channel, late; derivatives of the first by time and by the lag."""
        samples, stamps = self.model.coordinate.values, self.coordinate.values
        if not self._is_late(channel) and (rows := _rows(samples, stamps)) is not None:
            return table[rows], np.zeros(len(stamps)), np.zeros(len(stamps))
        from scipy.interpolate import make_interp_spline  # models without late sensors start without it

        spline = make_interp_spline(samples, table, k=min(DEGREE, len(samples) - 1))
        wanted = stamps - self._delay(vector, channel)
        before = wanted < samples[0]
        at = np.clip(wanted, samples[0], samples[-1])  # what lies beyond by rounding
        seen, rate, by_lag = lagged(spline, samples, at, self._value(vector, self._named(channel, "lag")))
        rate, by_lag = (np.where(before, 0.0, column[:, 0]) for column in (rate, by_lag))
        return np.where(before[:, None], table[0], seen), rate, by_lag

    def _named(self, channel: str, what: str) -> str:
        """Name of the parameter of a quantity of a channel: its own, or that of the component."""
        sensors_of = (name for name in owners(self.sensors, channel) if getattr(self.sensors[name], what) is not None)
        return f"{next(sensors_of, channel)} {what}"

    def _value(self, values: np.ndarray, name: str, perfect: float = 0.0) -> float:
        """A quantity by its name, of parameters (parameters,); that of a perfect sensor where it is no parameter."""
        if name in self.parameters.names:
            return float(values[self.parameters.names.index(name)])
        return next((float(item.lower) for item in self.parameters.fixed if item.name == name), perfect)

    def _delay(self, values: np.ndarray, channel: str) -> float:
        """Delay of a channel, with the time stamp at which the motion begins."""
        return self._value(values, self._named(channel, "delay")) + self._value(values, START)

    def _is_late(self, channel: str) -> bool:
        lag = self._named(channel, "lag")
        lags = lag in self.parameters.names or self._value(self.parameters.lower, lag) != 0
        return lags or self._bounds(channel) != (0.0, 0.0)

    def _bounds(self, channel: str) -> tuple[float, float]:
        """Least and largest delay of a channel."""
        return self._delay(self.parameters.lower, channel), self._delay(self.parameters.upper, channel)

    def _check_reach(self) -> None:
        """Refuse readings of times at which the model says nothing."""
        samples, stamps, along = self.model.coordinate.values, self.coordinate.values, self.coordinate
        slack = 1e-9 * max(1.0, float(np.max(np.abs(samples))))
        for name in (channel.name for channel in self.channels):
            least, most = self._bounds(name)
            begins, ends = stamps[0] - most, stamps[-1] - least
            sensors_here = owners(self.sensors, name)
            at_rest = (
                all(self.sensors[sensor].at_rest for sensor in sensors_here) if sensors_here else self.start is not None
            )
            if begins < samples[0] - slack and not at_rest:
                raise InputError(
                    f"Sensors: the first reading of {name!r}, at {along.name} {stamps[0]:.6g} {along.unit}, may show "
                    f"the motion at {begins:.6g} {along.unit}, and the model begins at {samples[0]:.6g} {along.unit}; "
                    "leave out the first readings, lower the delay's upper bound, or give at_rest=True if nothing "
                    "moves before"
                )
            if ends > samples[-1] + slack:
                raise InputError(
                    f"Sensors: the last reading of {name!r}, at {along.name} {stamps[-1]:.6g} {along.unit}, may show "
                    f"the motion at {ends:.6g} {along.unit}, and the model ends at {samples[-1]:.6g} {along.unit}; "
                    "build the model with samples until then"
                )


def _unknowns(model: ForwardModel, name: str, sensor: Sensor) -> list[Parameter]:
    units = {channel.name: channel.unit for channel in model.channels if name in owners([name], channel.name)}
    if not units:
        require_known("channel", name, [channel.name for channel in model.channels], "Sensors")
    values = {what: getattr(sensor, what) for what in QUANTITIES if getattr(sensor, what) is not None}
    if not values:
        raise InputError(
            f"Sensors: the sensor of {name!r} has no delay, lag, gain or offset; give bounds of at least one of them, "
            "or remove the sensor"
        )
    channel_units = list(dict.fromkeys(units.values()))
    if sensor.offset is not None and len(channel_units) > 1:
        raise InputError(
            f"Sensors: the channels of {name!r} have the units {', '.join(map(repr, channel_units))}, and no offset in "
            "common; give the offsets by channel"
        )
    unit = {"delay": model.coordinate.unit, "lag": model.coordinate.unit, "gain": "", "offset": channel_units[0]}
    unknowns = [
        reading_parameter(f"{name} {what}", bounds, unit[what], QUANTITIES[what]) for what, bounds in values.items()
    ]
    for item in unknowns:
        if item.name == f"{name} lag" and item.lower < 0:
            raise InputError(f"Sensors: the lag of {name!r} may be {item.lower:g}; expected bounds of zero or more")
    return unknowns


def owners(sensors: Iterable[str], channel: str) -> list[str]:
    """Names of the sensors of a channel: its own, and those of its component."""
    return [name for name in sensors if channel == name or channel.startswith(f"{name}.")]


def reading_parameter(name: str, bounds: Bounds, unit: str, perfect: float) -> Parameter:
    """Return the parameter of a reading; its first guess is that of a perfect sensor where the bounds allow it."""
    (item,) = Parameters.of({name: replace(bounds, name=name) if isinstance(bounds, Parameter) else bounds}).declared
    usual = perfect if item.lower <= perfect <= item.upper else None
    return replace(item, unit=item.unit or unit, start=usual if item.start is None else item.start)


def _rows(samples: np.ndarray, stamps: np.ndarray) -> np.ndarray | None:
    """Numbers of the samples that the stamps are, or None where one is not a sample."""
    rows = np.clip(np.searchsorted(samples, stamps), 0, len(samples) - 1)
    before = np.maximum(rows - 1, 0)
    rows = np.where(np.abs(samples[before] - stamps) < np.abs(samples[rows] - stamps), before, rows)
    return rows if np.all(np.abs(samples[rows] - stamps) <= 1e-9 * max(1.0, float(np.max(np.abs(samples))))) else None
