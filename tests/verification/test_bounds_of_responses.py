"""Bounds of responses over boxes of parameters: closed forms, and the published tables of the flexible pendulum."""

import numpy as np
import pytest

import dalembert as da
from dalembert.surrogate import Adaptive, TotalDegree
from flexible_pendulum import table, tip, within

TOPIC = "Bounds of responses over intervals"
CLOSED = "closed form"
PAPER = 'Guo & Jin, "Inverse dynamical problem of flexible multibody systems with interval uncertainty" (2025), table '
TIMES = np.linspace(0, 20, 81)
ZERO = np.zeros(1)


def growing_phase(lower: float, upper: float) -> tuple[np.ndarray, np.ndarray]:
    """Bounds of sin(ω t), ω between lower and upper: ±1 once the phase passes a crest, else those at the ends."""
    first, last = lower * TIMES, upper * TIMES
    crest = np.ceil((first - np.pi / 2) / (2 * np.pi)) * 2 * np.pi + np.pi / 2 <= last
    trough = np.ceil((first + np.pi / 2) / (2 * np.pi)) * 2 * np.pi - np.pi / 2 <= last
    ends = np.sin(first), np.sin(last)
    return np.where(trough, -1.0, np.minimum(*ends)), np.where(crest, 1.0, np.maximum(*ends))


def model(function, names: str, samples: np.ndarray = ZERO) -> da.PythonModel:
    return da.PythonModel(function, dict.fromkeys(names.split(), (-10.0, 10.0)), ["response"], samples)


CASES = {
    "monotone, k exp(-c t)": (
        model(lambda k, c: k * np.exp(-c * TIMES / 10), "k c", TIMES),
        {"k": (1.0, 2.0), "c": (0.5, 1.0)},
        (np.exp(-TIMES / 10), 2 * np.exp(-TIMES / 20)),
    ),
    "extremum inside, 2 - (x - 0.3)² - (y + 0.1)²": (
        model(lambda x, y: np.array([2 - (x - 0.3) ** 2 - (y + 0.1) ** 2]), "x y"),
        {"x": (-1.0, 1.0), "y": (-0.5, 0.5)},
        (np.array([2 - 1.3**2 - 0.6**2]), np.array([2.0])),
    ),
    "product x y of intervals through zero": (
        model(lambda x, y: np.array([x * y]), "x y"),
        {"x": (-2.0, 3.0), "y": (-1.0, 4.0)},
        (np.array([-8.0]), np.array([12.0])),
    ),
    "growing phase, sin(ω t), ω in [1, 1.5], t to 20 s": (
        model(lambda w: np.sin(w * TIMES), "w", TIMES),
        {"w": (1.0, 1.5)},
        growing_phase(1.0, 1.5),
    ),
}


def compared(record_evidence, case: str, method: str, tolerance: float) -> None:
    """Bounds by a method beside those of the closed form."""
    forward, box, truth = CASES[case]
    bands = da.propagate(forward, box, method)
    record_evidence(
        f"{case}: lower and upper bounds by {method}",
        np.stack(truth),
        np.stack([bands.lower[:, 0], bands.upper[:, 0]]),
        tolerance=tolerance,
        noisy=True,
        topic=TOPIC,
        kind="closed form",
        source=CLOSED,
    )


@pytest.mark.parametrize("method", ["optimise", "chebyshev"])
@pytest.mark.parametrize("case", CASES)
def test_closed_forms(record_evidence, case: str, method: str) -> None:
    compared(record_evidence, case, method, tolerance=5e-6)


def test_the_vertices_are_exact_where_the_response_is_monotone_and_for_a_product(record_evidence) -> None:
    for case in ("monotone, k exp(-c t)", "product x y of intervals through zero"):
        compared(record_evidence, case, "vertex", tolerance=1e-14)


def test_an_enclosure_holds_the_growing_phase() -> None:
    forward, box, (lower, upper) = CASES["growing phase, sin(ω t), ω in [1, 1.5], t to 20 s"]
    bands = da.propagate(forward, box, da.Chebyshev(bounds="bernstein"))
    assert np.all((bands.lower[:, 0] <= lower) & (upper <= bands.upper[:, 0]))
    assert np.max(bands.width[:, 0] - (upper - lower)) < 1e-4


PUBLISHED = {
    "a2": (within(0.05, theta1=np.pi / 4, theta2=np.pi / 6), 7e-5, 4.5e-4),
    "a3": (within(0.05, theta1=np.pi / 2, theta2=np.pi / 3), 8e-4, 5.5e-3),
}
BOUNDS = {"theta1": (0.5, 2.0), "theta2": (0.3, 1.5)}


@pytest.fixture(scope="module", params=PUBLISHED, ids=["Table A2", "Table A3"])
def case(request) -> tuple[str, dict[str, da.Propagation]]:
    """Name of a table, and the bounds that it gives by both methods."""
    forward, box = tip(BOUNDS), PUBLISHED[request.param][0]
    return request.param, {name: da.propagate(forward, box, name) for name in ("optimise", "chebyshev")}


@pytest.mark.slow
@pytest.mark.parametrize("method", ["optimise", "chebyshev"])
def test_published_tables(record_evidence, case: tuple[str, dict[str, da.Propagation]], method: str) -> None:
    """The tables are themselves no more exact: a scan on a fine grid differs from them by as much."""
    name, found = case
    bands, published, (_, rms, largest) = found[method], table(name), PUBLISHED[name]
    apart = np.stack([bands.lower - published.lower, bands.upper - published.upper])
    what = f"flexible double pendulum, Table {name.upper()}, bounds of the tip by {method} ({bands.runs} runs)"
    source = PAPER + name.upper()
    record_evidence(
        f"{what}: rms difference",
        0.0,
        np.sqrt(np.mean(apart**2)),
        unit="m",
        tolerance=rms,
        topic=TOPIC,
        kind="published",
        source=source,
    )
    record_evidence(
        f"{what}: all bounds",
        np.stack([published.lower, published.upper]),
        np.stack([bands.lower, bands.upper]),
        unit="m",
        tolerance=largest,
        topic=TOPIC,
        kind="published",
        source=source,
    )
    assert bands.success
    assert bands.runs <= 250


@pytest.mark.slow
def test_a_surrogate_agrees_with_direct_optimisation(record_evidence, case) -> None:
    name, found = case
    direct, surrogate = found["optimise"], found["chebyshev"]
    record_evidence(
        f"flexible double pendulum, box of Table {name.upper()}: bounds by chebyshev against optimise",
        np.stack([direct.lower, direct.upper]),
        np.stack([surrogate.lower, surrogate.upper]),
        unit="m",
        tolerance=1e-5,
        topic=TOPIC,
        kind="other method",
        source="direct optimisation of the model",
        noisy=True,
    )
    assert np.all(direct.lower >= surrogate.lower - surrogate.error - 1e-9)
    assert np.all(direct.upper <= surrogate.upper + surrogate.error + 1e-9)


LONG = {"theta1": da.Interval.about(np.pi / 2, relative=0.05), "theta2": np.pi / 3}


def advised(refusal: da.SolveError) -> int:
    """The order that a refusal says would do."""
    return int(str(refusal).split("TotalDegree(order=")[1].split(")")[0])


def test_a_long_motion_is_refused_at_a_low_order() -> None:
    """One angle within 5 %, for 6 s: the phase drifts apart over the box, and order 4 no longer follows it."""
    with pytest.raises(da.SolveError) as error:
        da.propagate(tip(BOUNDS, end=6.0), LONG, da.Chebyshev(TotalDegree(4)))
    told = str(error.value)
    assert told.startswith("the surrogate of order 4 is wrong by about 0.0")
    assert " at channel 'AB.end.y', time 5." in told
    assert "more than the tolerance of 1.8e-05" in told
    assert told.endswith(
        f"take TotalDegree(order={advised(error.value)}), raise the tolerance, or make the box smaller"
    )


def settled(forward: da.TimeResponse, order: int) -> tuple[da.Propagation, list[int]]:
    """Bounds at the first order that is not refused, and the orders that the refusals led through."""
    orders = [order]
    while len(orders) <= 5:
        try:
            return da.propagate(forward, LONG, da.Chebyshev(TotalDegree(orders[-1]))), orders
        except da.SolveError as refusal:
            orders.append(advised(refusal))
    raise AssertionError(f"no end of refusals: {orders}")


@pytest.mark.slow
def test_refusals_lead_to_an_order_that_does(record_evidence) -> None:
    forward = tip(BOUNDS, end=6.0)
    bands, orders = settled(forward, 4)
    assert len(orders) > 1
    assert orders == sorted(set(orders))
    reference = da.propagate(forward, LONG, da.Chebyshev(Adaptive(basis="tensor")))
    record_evidence(
        "flexible double pendulum for 6 s, theta1 within 5 %: bounds at the order that refusals led to",
        np.stack([reference.lower, reference.upper]),
        np.stack([bands.lower, bands.upper]),
        unit="m",
        tolerance=2e-5,
        topic=TOPIC,
        kind="other method",
        source="adaptive surrogate, its error below 2e-6 m",
        noisy=True,
    )
