"""The result of a profile likelihood: how the misfit grows as one parameter after the other is held elsewhere."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Annotated, Any, ClassVar

import numpy as np

from dalembert.errors import listed
from dalembert.findings import Finding
from dalembert.results import EndedResult
from dalembert.stored_fields import Over, Source, Store, StoredParameters
from dalembert.tables import Table, cell, cells, counted, few_values, interval, marks, noted

ASYMMETRIC = 1.5  # ratio of an interval's two sides from which its standard deviation does not describe it
BETTER = 0.01  # variances of the noise by which a point must explain the data better for the fit to be no minimum


@dataclass(frozen=True, eq=False)
class Profile:
    """Least misfit over all other parameters, for values of one.

    Parameters
    ----------
    name : str
    values : array, shape (points,)
        Increasing.
    excess : array, shape (points,)
        Misfit above that of the fit, in variances of the noise.
    points : array, shape (points, parameters)
        Where it is taken.
    lower, upper : float
        The interval; a bound of the parameter on a side that is open.
    open : tuple of bool
        Whether the misfit stays below the threshold up to the bound, on the lower and on the upper side.
    broken : tuple of str
        Why a side ends before threshold and bound, "" where it does not.
    elsewhere : tuple of (float, float)
        Further intervals, apart from this one, that the data do not contradict either.
    """

    name: str
    values: np.ndarray
    excess: np.ndarray
    points: np.ndarray
    lower: float
    upper: float
    open: tuple[bool, bool]
    broken: tuple[str, str] = ("", "")
    elsewhere: tuple[tuple[float, float], ...] = ()


class _Curves:
    """Profiles as variables over ``profile`` and ``point``."""

    def store(self, to: Store, settings: dict[str, Any], name: str, value: Sequence[Profile]) -> None:
        to.variables.update(
            {
                "lower": ("profile", np.array([curve.lower for curve in value])),
                "upper": ("profile", np.array([curve.upper for curve in value])),
                "open": (("profile", "side"), np.array([curve.open for curve in value], dtype=np.int8)),
                "count": ("profile", np.array([len(curve.values) for curve in value], dtype=np.int64)),
                "along": ("point", np.concatenate([curve.values for curve in value])),
                "excess": ("point", np.concatenate([curve.excess for curve in value])),
                "points": (("point", "parameter"), np.concatenate([curve.points for curve in value])),
            }
        )
        to.coordinates["profile"] = ("profile", [curve.name for curve in value])
        settings |= {"broken": [c.broken for c in value], "elsewhere": [c.elsewhere for c in value]}

    def load(self, source: Source, settings: Mapping[str, Any], name: str) -> tuple[Profile, ...]:
        a = source.arrays
        ends = np.cumsum(a["count"])[:-1]
        along, excess, points = (np.split(a[part], ends) for part in ("along", "excess", "points"))
        elsewhere = settings.get("elsewhere", [()] * len(along))
        return tuple(
            Profile(
                name=str(parameter),
                values=along[n],
                excess=excess[n],
                points=points[n],
                lower=float(a["lower"][n]),
                upper=float(a["upper"][n]),
                open=(bool(a["open"][n, 0]), bool(a["open"][n, 1])),
                broken=(settings["broken"][n][0], settings["broken"][n][1]),
                elsewhere=tuple((lower, upper) for lower, upper in elsewhere[n]),
            )
            for n, parameter in enumerate(a["profile"])
        )


@dataclass(frozen=True, eq=False)
class Profiles(EndedResult):
    """Profile likelihoods of parameters, and the intervals where they stay below a threshold.

    Parameters
    ----------
    parameters : Parameters
    values : array, shape (parameters,)
        Identified values.
    deviations : array, shape (parameters,)
        Their standard deviations, from the linearised response.
    curves : tuple of Profile
    level : float
    threshold : float
        Quantile of chi-square with one degree of freedom where the noise is known, else of F(1, freedom).
    variance : float
        Of a weighted residual, without the factor of each parameter that allows for correlated residuals.
    known : bool
        Whether the noise is known, or estimated from the residuals.
    simulations : int
    provenance : mapping
    findings : tuple of Finding
        What the method concludes about the result.
    """

    FORMAT: ClassVar[str] = "dalembert profiles 1"
    TITLE: ClassVar[str] = "Profile likelihood"
    VERDICTS: ClassVar[tuple[str, str]] = ("profiled", "not settled")

    parameters: StoredParameters
    values: Annotated[np.ndarray, Over("parameter")]
    deviations: Annotated[np.ndarray, Over("parameter")]
    curves: Annotated[tuple[Profile, ...], _Curves()]
    level: float
    threshold: float
    variance: float
    known: bool
    simulations: int
    provenance: Mapping[str, Any]
    findings: tuple[Finding, ...] = ()

    def __getitem__(self, name: str) -> Profile:
        """The profile of a parameter."""
        return next(curve for curve in self.curves if curve.name == name)

    @property
    def intervals(self) -> dict[str, tuple[float, float]]:
        """Interval of each parameter by name."""
        return {curve.name: (curve.lower, curve.upper) for curve in self.curves}

    @property
    def better(self) -> dict[str, float] | None:
        """Parameters that explain the data better than the fit does, if some were met on the way."""
        curve = min(self.curves, key=lambda curve: np.min(curve.excess))
        place = int(np.argmin(curve.excess))
        return self.parameters.mapping(curve.points[place]) if curve.excess[place] < -BETTER else None

    @property
    def success(self) -> bool:
        """Whether every side ended at its threshold or at a bound, and no better point was met."""
        return self.better is None and not any(reason for curve in self.curves for reason in curve.broken)

    @property
    def outcome(self) -> tuple[Finding, ...]:
        """The level, better minima, and what each profile shows."""
        return tuple(self._outcome())

    def _outcome(self) -> Iterator[Finding]:
        names = listed([repr(curve.name) for curve in self.curves])
        source = "given standard deviations" if self.known else "residuals"
        message = f"{100 * self.level:g} % intervals of {names} from profile likelihoods, noise level from {source}."
        yield Finding("profile-level", "note", {"level": self.level, "noise_is_known": self.known}, message)
        if self.better is not None:
            values = ", ".join(f"{name} = {value:.6g}" for name, value in self.better.items())
            message = f"There is a better minimum near {values}."
            yield Finding("better-minimum", "error", self.better, message, "Identify again from there.")
        for curve in self.curves:
            yield from self._of_one(curve)

    def _of_one(self, curve: Profile) -> Iterator[Finding]:
        k = self.parameters.names.index(curve.name)
        item, value = self.parameters.items[k], self.values[k]
        for side, reason in zip(("lower", "upper"), curve.broken, strict=True):
            if reason:
                values = {"parameter": curve.name, "side": side, "reason": reason}
                message = f"The {side} side of the profile of {curve.name!r} is incomplete: {reason}."
                advice = "Increase points, or narrow the bounds to where the model can be run."
                yield Finding("incomplete-profile", "error", values, message, advice)
        if all(curve.open):
            message = (
                f"{curve.name!r} is not identifiable: all values between its bounds explain the data within their "
                "noise."
            )
            advice = "Fix it, or measure a quantity that depends on it."
            yield Finding("unidentifiable-parameter", "warning", {"parameter": curve.name}, message, advice)
        elif any(curve.open):
            side = "lower" if curve.open[0] else "upper"
            bound = float(getattr(item, side))
            message = (
                f"The data give no {side} limit of {curve.name!r}: all values up to its bound {bound:.6g} explain them "
                "within their noise."
            )
            values = {"parameter": curve.name, "side": side, "bound": bound}
            yield Finding("open-interval", "warning", values, message, "Measure a quantity that depends on it.")
        elif not any(curve.broken):
            below, above = value - curve.lower, curve.upper - value
            if max(below, above) > ASYMMETRIC * min(below, above):
                yield Finding(
                    "asymmetric-interval",
                    "note",
                    {"parameter": curve.name, "below": float(below), "above": float(above)},
                    f"The interval of {curve.name!r} is asymmetric, {below:.3g} below and {above:.3g} above its value: "
                    f"the standard deviation {self.deviations[k]:.3g} does not describe it.",
                )
        if curve.elsewhere:
            parts = listed([f"{lower:.6g} to {upper:.6g}" for lower, upper in curve.elsewhere])
            yield Finding(
                "further-intervals",
                "warning",
                {"parameter": curve.name, "intervals": len(curve.elsewhere)},
                f"The data also allow values of {curve.name!r} from {parts}.",
                "Measure a quantity that separates these minima, or narrow the bounds.",
            )

    def key_values(self) -> dict[str, str]:
        items = [self.parameters.items[self.parameters.names.index(curve.name)] for curve in self.curves]
        return few_values(items, [interval(curve.lower, curve.upper) for curve in self.curves])

    def facts(self) -> dict[str, str]:
        return {"level": f"{100 * self.level:g} %", "simulations": counted(self.simulations)}

    def tables(self) -> tuple[Table, ...]:
        """Return the interval of each profiled parameter."""
        places = [self.parameters.names.index(curve.name) for curve in self.curves]
        sides = [
            " and ".join(side for side, is_open in zip(("lower", "upper"), curve.open, strict=True) if is_open)
            for curve in self.curves
        ]
        columns = {
            "parameter": [curve.name for curve in self.curves],
            "value": self.values[places],
            "lower end": [cell(curve.lower, mark=curve.open[0]) for curve in self.curves],
            "upper end": [cell(curve.upper, mark=curve.open[1]) for curve in self.curves],
            "unit": [self.parameters.items[k].unit for k in places],
            "standard deviation": cells(self.deviations[places], 2),
            "note": marks(f"open: {side} bound" if side else "" for side in sides),
        }
        caption = f"{100 * self.level:g} % intervals from profile likelihoods"
        return (noted(Table.of("profiles", caption, columns)),)
