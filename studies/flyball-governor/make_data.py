"""Write speed.csv: the speed (rad/s) of the spindle of the governor, with noise.

Both arms have the same tilt b. The spindle and the arms turn at w = L / I(b), with the constant angular momentum L and
the inertia I about the vertical axis. With ' for d/db, 2 J d2b/dt2 = I' w^2 / 2 - V' - 2 c l'^2 db/dt; J is the moment
of an arm about its hinge, V the potential energy, l(b) the length of a spring, c its damping. SciPy integrates it,
apart from the package.
"""

from pathlib import Path

import numpy as np
from scipy.integrate import solve_ivp

FOLDER = Path(__file__).parent
ARM, BALL, MOMENT, AXIAL, SPINDLE = 0.5, 1.2, 0.35, 0.004, 0.08  # m, kg, kg m² (three)
HEIGHT, FREE, STIFFNESS, DAMPING = 0.3, 0.1, 400.0, 8.0  # m, m, N/m, N s/m
SPEED, TILT, GRAVITY = 7.0, 0.4, 9.81  # rad/s, rad, m/s²
TIMES, NOISE = np.arange(301) * 0.01, 0.05  # s, rad/s


def functions(tilt):
    """I, V and l, for a complex tilt too."""
    s, c = np.sin(tilt), np.cos(tilt)
    length = np.sqrt((ARM / 2 * s) ** 2 + (HEIGHT - ARM / 2 * c) ** 2)
    inertia = SPINDLE + 2 * (MOMENT * s * s + AXIAL * c * c)
    return inertia, -2 * BALL * GRAVITY * ARM * c + STIFFNESS * (length - FREE) ** 2, length


def motion() -> tuple[np.ndarray, np.ndarray]:
    """Speed of the spindle and tilt of the arms."""
    momentum = functions(TILT)[0] * SPEED

    def rates(time: float, state: np.ndarray) -> list[float]:
        tilt, rate = state
        speed = momentum / functions(tilt)[0]
        inertia, potential, length = (np.imag(value) / 1e-30 for value in functions(tilt + 1e-30j))
        force = 0.5 * inertia * speed**2 - potential - 2 * DAMPING * length**2 * rate
        return [rate, force / (2 * MOMENT)]

    tilt = solve_ivp(rates, (0, TIMES[-1]), [TILT, 0], "DOP853", TIMES, rtol=1e-12, atol=1e-12).y[0]
    return momentum / functions(tilt)[0], tilt


def main() -> None:
    """Write the file."""
    speed, tilt = motion()
    print("speed and tilt at 1 and 3 s:", np.column_stack([speed, tilt])[[100, 300]].round(9).tolist())
    rows = np.column_stack([TIMES, speed + NOISE * np.random.default_rng(0).standard_normal(len(TIMES))])
    form = ["%.2f", "%.3f"]
    np.savetxt(FOLDER / "speed.csv", rows, fmt=form, delimiter=",", header="t,speed", comments="")


if __name__ == "__main__":
    main()
