"""Energy and constraint errors of the arm over 20 s beside the published ones, as tables and a figure.

``python compare.py`` prints the tables and writes ``runs/two-link-arm-errors.html``; ``fireflies`` adds them (minutes).
"""

import sys
import time
from pathlib import Path

import numpy as np
import plotly.graph_objects as go

import dalembert as da
from dalembert.study import load

FOLDER = Path(__file__).parent
END = 20.0
#: Zhang and Ding (2021): largest and mean relative energy error, largest violations of the constraints, run time in s.
PUBLISHED = {
    "fireflies, 2 ms": (2.88e-4, 3.28e-5, 1.1e-16, 8.9e-16, 2.8e-14, 2.9e4),
    "fireflies, 5 ms": (1.82e-3, 3.73e-4, 1.1e-16, 8.9e-16, 2.8e-14, 1.2e4),
    "fireflies, 10 ms": (7.45e-3, 1.40e-3, 1.1e-16, 8.9e-16, 2.8e-14, 8.8e3),
    "RK4 of index 1, 10 ms": (9.08e-2, 2.85e-2, 4.0e-2, 4.2e-3, 7.8e-14, 0.52),
}
OURS = {
    **{f"Gauss-Newton, {1e3 * h:g} ms": da.Collocation(step=h) for h in (0.002, 0.005, 0.01)},
    "order 4, 10 ms": da.Collocation(step=0.01, degree=3, gauss_points=2),
    "order 6, 10 ms": da.Collocation(step=0.01, degree=4, gauss_points=3),
    "order 8, 10 ms": da.Collocation(step=0.01, degree=5, gauss_points=4),
    "generalized-alpha, 10 ms": da.GeneralizedAlpha(step=0.01),
}
FIREFLIES = {"fireflies, 10 ms": da.Collocation(step=0.01, minimiser=da.Firefly())}


def run(solver) -> tuple[da.Trajectory, tuple[float, ...]]:
    """A motion and its row of the table; the clock runs after a first step has compiled what it needs."""
    system = load(FOLDER / "simulate.toml").system()
    da.simulate(system, solver.step, solver=solver)
    begin = time.perf_counter()
    motion = da.simulate(system, END, solver=solver)
    taken = time.perf_counter() - begin
    violations = (float(np.max(motion.violations[level])) for level in ("position", "velocity", "acceleration"))
    error = energy_error(motion)
    return motion, (float(error.max()), float(error.mean()), *violations, taken)


def energy_error(motion: da.Trajectory) -> np.ndarray:
    """Relative error of the energy against the first one, (samples,)."""
    total = motion.energies["total"]
    return np.abs(total - total[0]) / np.abs(total[0])


def table(rows: dict[str, tuple[float, ...]]) -> str:
    """Markdown."""
    head = "| method, step | eps(H) | mean | eps(Phi) | eps(Phi') | eps(Phi'') | run time / s |\n" + "|---" * 7 + "|\n"
    return head + "\n".join(f"| {name} | {' | '.join(f'{value:.2e}' for value in row)} |" for name, row in rows.items())


def main(chosen: dict[str, da.Collocation | da.GeneralizedAlpha]) -> None:
    """Print the tables, write the figure."""
    figure, rows = go.Figure(), {}
    for name, solver in chosen.items():
        motion, rows[name] = run(solver)
        figure.add_scatter(x=motion.times, y=np.maximum(energy_error(motion), 1e-16), name=name)
    figure.update_layout(title="Two-link arm: relative error of the energy", xaxis_title="t in s")
    figure.update_yaxes(title="|H − H(0)| / H(0)", type="log")
    Path("runs").mkdir(exist_ok=True)
    figure.write_html("runs/two-link-arm-errors.html")
    print(f"published\n\n{table(PUBLISHED)}\n\nours\n\n{table(rows)}")


if __name__ == "__main__":
    main({**OURS, **(FIREFLIES if "fireflies" in sys.argv[1:] else {})})
