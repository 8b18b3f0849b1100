"""Results as the report sees them, made of a pendulum in closed form: for tests of figures and pages."""

from dataclasses import dataclass, field
from types import SimpleNamespace
from typing import Any

import numpy as np

from dalembert.forward import Coordinate
from dalembert.inverse import BandFit, Fit, Identifiability, ParameterSet, ResidualDiagnostics
from dalembert.multibody import Trajectory
from dalembert.parameter import Parameter
from dalembert.parameters import Parameters
from dalembert.study.tasks.sweep import Sweep
from dalembert.uncertainty import Comparison, Propagation


def stand_in(kind: type, /, **values: Any) -> Any:
    """A result of a kind with given attributes in place of what its class computes; they may be changed."""
    members = {name: staticmethod(value) if callable(value) else value for name, value in values.items()}
    return type(kind.__name__, (kind,), {"__init__": object.__init__, "__setattr__": object.__setattr__, **members})()


@dataclass(frozen=True, eq=False)
class Motion(Trajectory):
    """Two bars that swing with given angles; its diagnostics are given, not computed."""

    system: Any = None
    lowered: Any = None
    solver: Any = None
    run: Any = None
    rows: Any = None
    findings: tuple = ()
    times: Any = None
    energies: Any = None
    violations: Any = None
    newton_iterations: Any = None
    channel_names: Any = ("AB.end.x", "AB.end.y")
    extra: dict[str, np.ndarray] = field(default_factory=dict)

    def drawing(self, points: int = 8) -> SimpleNamespace:
        along = np.linspace(0, 1, points)[None, :, None]
        elbow, tip = swing(self.times)
        first = along * elbow[:, None]
        second = elbow[:, None] + along * (tip - elbow)[:, None]
        joints = {"O": np.zeros((len(self.times), 2)), "A": elbow}
        return SimpleNamespace(times=self.times, lines={"OA": first, "AB": second, **self.extra}, joints=joints)

    def channels(self, names: list[str]) -> np.ndarray:
        tip = swing(self.times)[1]
        return np.stack([tip[:, self.channel_names.index(name)] for name in names], axis=1)


def swing(times: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Elbow and tip (samples, 2) of the two bars."""
    first, second = 0.8 * np.cos(3.1 * times), 1.1 * np.cos(2.3 * times + 0.4)
    elbow = np.stack([np.sin(first), -np.cos(first)], axis=1)
    return elbow, elbow + 2 * np.stack([np.sin(second), -np.cos(second)], axis=1)


def motion(samples: int = 401, end: float = 2.0) -> Motion:
    times = np.linspace(0, end, samples)
    kinetic = 40 * np.sin(3.1 * times) ** 2
    balance = 2e-6 * np.sin(9 * times) * times
    return Motion(
        times=times,
        energies={
            "kinetic": kinetic,
            "potential": -12 - kinetic + balance,
            "total": -12 + balance,
            "work": np.zeros(samples),
            "balance": balance,
        },
        violations={
            "position": 1e-13 * np.abs(np.sin(5 * times)),
            "velocity": 1e-8 * (1 + np.abs(np.sin(7 * times))),
            "acceleration": 3e-5 * (1 + np.abs(np.cos(7 * times))),
        },
        newton_iterations=np.where(np.arange(samples - 1) % 37 == 0, 5, 3),
        run=SimpleNamespace(counts=(samples - 1, 3 * (samples - 1), 0, 0)),
    )


def fit(
    names: tuple[str, str] = ("theta1", "theta2"), channels: tuple[str, ...] = ("AB.end.x", "AB.end.y"), starts: int = 6
):
    """A fit with known numbers; the second parameter sits on its upper bound."""
    random = np.random.default_rng(3)
    times = np.linspace(0, 2, 41)
    response = swing(times)[1]
    noise = 5e-3 * random.standard_normal(response.shape)
    parameters = Parameters((Parameter(names[0], 0.6, 1.0, unit="rad"), Parameter(names[1], 0.4, 0.65, unit="rad")))
    misfit = [1.9e-3 if start % 3 else 0.41 for start in range(starts)]
    history = tuple(
        SimpleNamespace(
            start=start, iteration=step, simulations=9 * start + step + 1, best=best, regularised=None, gap=None
        )
        for start in range(starts)
        for step, best in enumerate(misfit[start] + (8 + start) * 10.0 ** -np.arange(9))
    )
    ends = tuple(
        SimpleNamespace(
            start=random.uniform(parameters.lower, parameters.upper),
            end=np.array([0.7853, 0.65]) if start % 3 else np.array([0.61, 0.5]),
            misfit=misfit[start],
            success=start != 4,
            message="the gradient vanishes" if start != 4 else "too many iterations",
            simulations=9,
        )
        for start in range(starts)
    )
    return stand_in(
        Fit,
        doubts=(),
        experiments=(),
        weights=np.ones(response.shape),
        plain_deviations=np.array([2.1e-4, 3.3e-4]),
        integration_bias=np.full(2, np.nan),
        identifiability=lambda: Identifiability(np.array([120.0, 3.0]), np.eye(2), ()),
        diagnostics=lambda: ResidualDiagnostics(parameters.names, (), (), (), True),
        parameters=parameters,
        values=np.array([0.785312, 0.65]),
        deviations=np.array([2.1e-4, 3.3e-4]),
        correlation=np.array([[1.0, -0.83], [-0.83, 1.0]]),
        misfit=1.9e-3,
        response=response,
        data=SimpleNamespace(
            coordinate=Coordinate("time", "s", times),
            channels=channels,
            values=response + noise,
            deviations=np.array([5e-3, 5e-3]),
            taken=np.ones(response.shape, dtype=bool),
        ),
        residuals=response - (response + noise),
        history=history,
        starts=ends,
        success=True,
        status="The misfit no longer falls: 4 of 6 starts end in the same minimum. Widen the bounds of theta2.",
        method="least squares, 6 starts",
        simulations=54,
        provenance={"version": "0.1.0", "seed": 0, "model": "9f2c", "method": {"name": "least squares", "starts": 6}},
    )


def sweep() -> Any:
    angle = np.linspace(0.6, 1.0, 21)
    values = np.stack([np.sin(angle), -np.cos(angle)], axis=1)
    slopes = np.stack([np.cos(angle), np.sin(angle)], axis=1)
    channels = ("AB.end.x", "AB.end.y")
    first = SimpleNamespace(
        parameter="theta1",
        unit="rad",
        values=angle,
        channels=channels,
        units=("m", "m"),
        responses=values,
        sensitivities=slopes,
    )
    second = SimpleNamespace(
        parameter="theta2",
        unit="rad",
        values=angle,
        channels=channels,
        units=("m", "m"),
        responses=values,
        sensitivities=None,
    )
    return stand_in(
        Sweep, at="time 0.5 s", success=True, status="42 points along theta1, theta2.", curves=(first, second)
    )


def box(**ends: tuple[float, float]) -> SimpleNamespace:
    lower, upper = np.array(list(ends.values()), dtype=float).T
    return SimpleNamespace(names=tuple(ends), lower=lower, upper=upper)


def propagation(method: str = "optimise", kind: str = "estimate", shrink: float = 0.0, runs: int = 81):
    """Bounds of the pendulum's tip, each drawn in by ``shrink``; the first half of them taken at a corner."""
    times = np.linspace(0, 2, 41)
    tip, half = swing(times)[1], 0.02 + 0.1 * times[:, None] * [1.0, 0.6]
    angles = box(theta1=(0.746, 0.825), theta2=(0.497, 0.55))
    corner = np.broadcast_to(angles.upper, (41, 2, 2)).copy()
    corner[20:, :, 1] = 0.52
    return stand_in(
        Propagation,
        coordinate=Coordinate("time", "s", times),
        channels=("AB.end.x", "AB.end.y"),
        units=("m", "m"),
        lower=tip - half + shrink,
        upper=tip + half - shrink,
        box=angles,
        method=method,
        kind=kind,
        runs=runs,
        error=np.full((41, 2), 2.5e-6) if kind == "estimate" else None,
        at_lower=corner,
        at_upper=corner,
        failures=(),
        success=True,
        status="All bounds were found; the surrogate is wrong by 2.5e-06 at most.",
        seconds=2.25,
        provenance={"version": "0.1.0", "seed": 0},
    )


def comparison() -> Any:
    results = (
        propagation(),
        propagation("vertex", "inner bound", 3e-3, 4),
        propagation("scan", "inner bound", 4e-4, 441),
        propagation("bernstein", "enclosure of the surrogate", -2e-5, 81),
    )
    rows = tuple(
        SimpleNamespace(
            method=one.method,
            kind=one.kind,
            width=float((one.upper - one.lower).mean()),
            largest=float(np.abs(one.lower - results[0].lower).max()),
            rms=float(np.sqrt(np.mean((one.lower - results[0].lower) ** 2))),
            runs=one.runs,
            seconds=one.seconds,
        )
        for one in results
    )
    return stand_in(
        Comparison,
        results=results,
        reference="optimise",
        rows=rows,
        refused=(),
        success=True,
        status="Each is measured by its distance from optimise.",
    )


def band_fit(names: tuple[str, str] = ("theta1", "theta2")) -> Any:
    """Intervals identified from the bands above; the second parameter's radius is none."""
    like, given = fit(names), propagation()
    noise = 1e-3 * np.sin(40 * given.coordinate.values)[:, None] * [1.0, 0.5]
    unknowns = tuple(f"{name} {part}" for part in ("middle", "radius") for name in names)
    correlation = np.eye(4)
    correlation[0, 2] = correlation[2, 0] = -0.5
    for start in like.starts:
        start.end = np.array([*start.end, 0.04, 0.0])
    return stand_in(
        BandFit,
        doubts=(),
        identifiability=lambda: Identifiability(np.arange(4.0, 0, -1), np.eye(4), ()),
        parameters=like.parameters,
        box=box(**{names[0]: (0.7461, 0.8247), names[1]: (0.52, 0.52)}),
        intervals=names,
        unknowns=unknowns,
        middle=np.array([0.7854, 0.52]),
        radius=np.array([0.0393, 0.0]),
        middle_deviations=np.array([3e-4, 2e-4]),
        radius_deviations=np.array([4e-4, 1e-4]),
        correlation=correlation,
        misfit=3.3e-5,
        bands=given,
        lower=given.lower + 2 * noise,
        upper=given.upper - noise,
        checked_lower=given.lower + noise,
        checked_upper=given.upper - noise,
        checked_misfit=3.4e-5,
        history=like.history,
        starts=like.starts,
        success=True,
        status="The misfit no longer falls; the surrogate agrees with 12 true runs to 1e-06.",
        method="global surrogate",
        simulations=93,
        seconds=4.5,
        provenance=like.provenance,
    )


def parameter_set(names: tuple[str, ...] = ("theta1", "theta2"), cells: int = 12) -> Any:
    """A ball in the box of the parameters, paved by equal cubes."""
    items = tuple(Parameter(name, 0.5, 1.0, unit="rad") for name in names)
    grid = np.stack(np.meshgrid(*[np.arange(cells)] * len(names), indexing="ij"), axis=-1).reshape(-1, len(names))
    low, high = 2 * grid / cells - 1, 2 * (grid + 1) / cells - 1
    nearest = np.linalg.norm(np.clip(0, low, high), axis=1)
    farthest = np.linalg.norm(np.maximum(np.abs(low), np.abs(high)), axis=1)
    boxes = 0.75 + 0.25 * np.stack([low, high], axis=1)
    inside, touched = farthest <= 0.6, nearest <= 0.6
    size = (0.5 / cells) ** len(names)
    return stand_in(
        ParameterSet,
        parameters=Parameters(items),
        inside=boxes[inside],
        boundary=boxes[touched & ~inside],
        outer=box(**dict.fromkeys(names, (0.6, 0.9))),
        inner=box(**dict.fromkeys(names, (0.66, 0.84))),
        volume=(inside.sum() * size, touched.sum() * size),
        runs=81,
        seconds=4.5,
        success=True,
        status="The set is paved to 1/12 of what was searched.",
        provenance={"version": "0.1.0", "seed": 0},
    )
