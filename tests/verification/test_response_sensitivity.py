"""Response sensitivity beside SciPy's trf and lm: the inertias of an engine's crank and rod, from 100 random starts."""

from dataclasses import dataclass, field

import numpy as np
import pytest
from scipy.optimize import least_squares

import dalembert as da

CRANK, ROD = 0.045, 0.15  # m
TRUTH = np.array([4e-3, 2.5e-3])  # kg m²
TIMES = np.linspace(0, 0.2, 41)
SETTINGS = {"xtol": 1e-10, "ftol": 1e-8, "max_nfev": 100}
TOPIC = "Response sensitivity"


def engine(crank_inertia, rod_inertia):
    """A single-cylinder engine, its crank balanced, turned by a constant torque from 60° on under gravity."""
    system = da.System(gravity=(0.0, -9.81))
    crank = system.add(da.RigidBody("crank", 2.0, crank_inertia, angle=np.pi / 3, points={"pin": (CRANK, 0.0)}))
    tilt = np.arcsin(-CRANK / ROD * np.sin(np.pi / 3))
    ends = {"big": (-ROD / 3, 0.0), "small": (2 * ROD / 3, 0.0)}
    rod = system.add(da.RigidBody("rod", 0.65, rod_inertia, crank.point("pin"), angle=tilt, anchor="big", points=ends))
    piston = system.add(da.PointMass("piston", 0.55, rod.point("small")))
    system.add(da.RevoluteJoint("main", system.ground, crank.centre))
    system.add(da.RevoluteJoint("crank-pin", crank.point("pin"), rod.point("big")))
    system.add(da.RevoluteJoint("wrist-pin", rod.point("small"), piston.centre))
    bore = system.ground.point(0.0, 0.0), piston.centre
    system.add(da.PrescribedMotion("cylinder", *bore, coordinate="y", motion=0.0))
    system.add(da.Torque("gas", crank.centre, 2.0))
    return system


def model(ratio):
    """200 steps over some revolutions of the crank; inertias between 1/ratio and ratio times the true ones."""
    names = ("crank_inertia", "rod_inertia")
    parameters = {name: (value / ratio, value * ratio) for name, value in zip(names, TRUTH, strict=True)}
    solver = da.GeneralizedAlpha(step=1e-3, spectral_radius=0.9)
    return da.TimeResponse(engine, parameters, ["crank.pin.angle", "piston.centre.x"], TIMES, solver=solver, workers=1)


@dataclass
class Counted:
    """Weighted residual and jacobian as each minimiser calls them, over u = p/truth or its logarithm.

    A residual counts as one simulation and a jacobian as one a parameter, since its response is known by then; what
    was simulated is remembered, so that the minimisers can begin at the same points in little time.
    """

    model: da.TimeResponse
    logarithm: bool
    simulations: int = 0
    _known: dict = field(default_factory=dict)

    def __post_init__(self):
        self.data = self.model.evaluate(TRUTH[None]).only()[0]
        self.weight = 1 / self.data.std(axis=0)

    def vector(self, u):
        with np.errstate(over="ignore"):  # lm knows no bounds
            return TRUTH * (np.exp(u) if self.logarithm else u)

    def residual(self, u):
        self.simulations += 1
        if ("r", key := u.tobytes()) not in self._known:
            values = self.model.evaluate(self.vector(u)[None]).values[0]
            self._known["r", key] = ((values - self.data) * self.weight).ravel()
        return self._known["r", key]

    def jacobian(self, u):
        self.simulations += 2
        if ("j", key := u.tobytes()) not in self._known:
            p = self.vector(u)
            slopes = self.model.linearise(p)[1] * (p if self.logarithm else TRUTH)
            self._known["j", key] = (slopes * self.weight[:, None]).reshape(-1, 2)
        return self._known["j", key]


def trf(problem, low, high, start):
    return least_squares(problem.residual, start, problem.jacobian, (low, high), "trf", gtol=None, **SETTINGS).x


def lm(problem, low, high, start):
    return least_squares(problem.residual, start, problem.jacobian, method="lm", gtol=1e-15, **SETTINGS).x


def ours(problem, low, high, start):
    return da.ResponseSensitivity().minimise(problem.residual, problem.jacobian, low, high, start).x


def compared(ratio, logarithm, number=100):
    """Share of the starts that end within 1e-6 of the truth, and mean simulations, of each minimiser."""
    problem = Counted(model(ratio), logarithm)
    low, high = np.full(2, 1 / ratio), np.full(2, float(ratio))
    if logarithm:
        low, high = np.log(low), np.log(high)
    starts = low + (high - low) * np.random.default_rng(1).random((number, 2))
    told = {}
    for minimise in (ours, trf, lm):
        reached, spent = 0, []
        for start in starts:
            problem.simulations = 0
            try:
                values = problem.vector(minimise(problem, low, high, start))
            except ValueError:  # lm goes where the engine cannot be simulated
                values = np.full(2, np.nan)
            reached += bool(np.all(np.abs(values / TRUTH - 1) < 1e-6))
            spent.append(problem.simulations)
        told[minimise.__name__] = reached / number, float(np.mean(spent))
    return told


@pytest.mark.slow
@pytest.mark.parametrize("ratio", [5, 10])
@pytest.mark.parametrize("logarithm", [False, True], ids=["inertias", "their logarithms"])
def test_success_is_no_rarer_and_simulations_are_no_more_than_by_trf_and_lm(ratio, logarithm, record_evidence):
    told = compared(ratio, logarithm)
    success, spent = told.pop("ours")
    what = f"{'logarithms of two inertias' if logarithm else 'two inertias'}, 100 starts within a factor {ratio}"
    for name, (reached, cost) in told.items():
        source = f"scipy.optimize.least_squares, {name}"
        assert success >= reached
        assert spent <= cost or reached < success
        common = {"topic": TOPIC, "kind": "other code", "source": source}
        record_evidence(f"{what}: share that reaches the truth", reached, success, tolerance=None, **common)
        record_evidence(f"{what}: simulations a start", cost, spent, tolerance=None, **common)


def test_both_inertias_come_back_to_a_millionth_through_identify(record_evidence):
    exact = model(5)
    response = exact.evaluate(TRUTH[None]).only()[0]
    data = da.Measurements.of(TIMES, dict(zip(exact.channel_names, response.T, strict=True)))
    fit = da.identify(exact, data, method=da.ResponseSensitivity())
    record_evidence(
        "inertias of crank and rod", TRUTH, fit.values, unit="kg m²", tolerance=1e-6, relative=True, noisy=True,
        topic=TOPIC, kind="known truth", source="the model's own response",
    )  # fmt: skip
    assert fit.simulations < 60
