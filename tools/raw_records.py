"""Four records of a driven pendulum as instruments write them: ``python tools/raw_records.py FOLDER``.

They are the files of the template ``records``. A motor of which the current was recorded turns a bar on a pin. The
equations are integrated by SciPy, apart from the package. Each file has the habits of another instrument; all angles
come 15 ms late and have 0.2 degrees of noise.
"""

import sys
from pathlib import Path

import numpy as np
from scipy.integrate import solve_ivp

from dalembert.files import write_text

MASS, LENGTH, GRAVITY = 0.5, 0.4, 9.81  # kg, m, m/s^2
TORQUE_CONSTANT, FRICTION, DELAY = 0.25, 8e-3, 0.015  # N m/A, N m s, s
NOISE = 0.2  # degrees
TIMES = np.arange(601) * 0.01  # s


def chirp(times: np.ndarray) -> np.ndarray:
    """A sine of 1 A from 0.4 to 2.2 Hz."""
    return np.sin(2 * np.pi * (0.4 + 0.15 * times) * times)


def steps(times: np.ndarray) -> np.ndarray:
    """Smoothed steps between -1.5 and 1.5 A."""
    return 1.5 * np.tanh(4.0 * np.sin(2 * np.pi * 0.45 * times))


def burst(times: np.ndarray) -> np.ndarray:
    """A sine of 2.5 A that dies away, and then a free swing."""
    return 2.5 * np.sin(2 * np.pi * 0.9 * times) * np.exp(-times)


def mixed(times: np.ndarray) -> np.ndarray:
    """Two sines."""
    return np.sin(2 * np.pi * 0.7 * times) + 1.2 * np.sin(2 * np.pi * 1.3 * times)


def angles(current: np.ndarray) -> np.ndarray:
    """Measured angles in degrees; the bar hangs at rest before the record begins."""
    inertia, weight = MASS * LENGTH**2 / 3, MASS * GRAVITY * LENGTH / 2

    def rates(time: float, state: np.ndarray) -> list[float]:
        torque = TORQUE_CONSTANT * np.interp(time, TIMES, current) - FRICTION * state[1] - weight * np.cos(state[0])
        return [state[1], torque / inertia]

    asked = np.maximum(TIMES - DELAY, 0.0)
    solution = solve_ivp(rates, (0.0, TIMES[-1]), [-np.pi / 2, 0.0], dense_output=True, rtol=1e-9, atol=1e-10)
    return np.rad2deg(solution.sol(asked)[0])


def records() -> dict[str, str]:
    """Text of each file by its name."""
    draw = np.random.default_rng(7)
    files: dict[str, str] = {}
    currents = [np.round(course(TIMES), 3) for course in (chirp, steps, burst, mixed)]
    first, second, third, fourth = (angles(one) + NOISE * draw.standard_normal(TIMES.size) for one in currents)

    lost = (TIMES >= 2.0) & (TIMES <= 2.35)  # the sensor dropped out
    cells = np.where(lost, "", [f"{a:.2f}" for a in first])
    rows = [f"{48210 + 1000 * t:.0f}\t{i:.3f}\t{cell}" for t, i, cell in zip(TIMES, currents[0], cells, strict=True)]
    head = ["% Rig 7, chirp", "% angle of the bar above the horizontal", "time\tcurrent\tangle", "ms\tA\tdeg"]
    files["chirp.txt"] = "\n".join([*head, *rows]) + "\n"

    rows = [
        f"{12.5 + t:.2f};{i:.3f};{a:.2f}".replace(".", ",") for t, i, a in zip(TIMES, currents[1], second, strict=True)
    ]
    files["steps.csv"] = "\n".join(["time;current;angle", "s;A;deg", *rows]) + "\n"

    third[217] += 40.0  # a reading that is plain wrong
    rows = [f"{t:8.3f} {i:8.3f} {a:9.2f}" for t, i, a in zip(TIMES, currents[2], third, strict=True)]
    files["burst.dat"] = "\n".join(["# burst and free swing", *rows]) + "\n"

    rows = [f"{t:.2f},{i:.3f},{a:.2f}" for t, i, a in zip(TIMES, currents[3], fourth, strict=True)]
    files["mixed.csv"] = "\n".join(["time,current,angle", *rows]) + "\n"
    return files


def main(folder: Path) -> None:
    """Write the files into a folder."""
    for name, text in records().items():
        write_text(folder / name, text)


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "."))
