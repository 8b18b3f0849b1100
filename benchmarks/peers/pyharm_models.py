"""The peer in pyHarm: harmonic balance with the same slider, harmonics, samples and tolerance."""

import logging
import time
from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True)
class Slider:
    """Matrices, a unit force cos ωt on a mass, and a slider from a mass to the ground."""

    mass: np.ndarray
    damping: np.ndarray
    stiffness: np.ndarray
    forced: int
    rubbing: int
    contact: float
    friction: float
    load: float


def curve(
    slider: Slider, ends: tuple[float, float], harmonics: int, samples: int, step: float
) -> tuple[float, np.ndarray, np.ndarray]:
    """Seconds, frequencies (rad/s) and first harmonics of the rubbing mass along the path by arc length."""
    from pyHarm.Maestro import Maestro

    logging.disable(logging.CRITICAL)
    size = len(slider.mass)
    matrices = {"M": slider.mass, "C": slider.damping, "K": slider.stiffness, "G": 0 * slider.mass}
    rubbing = {"mu": slider.friction, "N0": slider.load, "k": slider.contact, "dirs": [0]}
    maestro = Maestro(
        {
            "analysis": {
                "curve": {
                    "study": "frf", "puls_inf": ends[0], "puls_sup": ends[1], "ds0": step, "ds_max": step,
                    "stepsizer": "constant", "solver": "scipyroot", "verbose": False,
                    "solver_options": {"root": {"method": "hybr", "options": {"xtol": 1e-10}}},
                }
            },
            "system": {"type": "Base", "nh": harmonics, "nti": samples},
            "substructures": {"s": {"matrix": matrices, "nnodes": size, "ndofs": 1, "nmodes": 0, "matching": [0]}},
            "connectors": {
                "force": {"type": "CosinusForcing", "connect": {"s": [slider.forced]}, "dirs": [0], "amp": 1.0},
                "slider": {"type": "Jenkins", "connect": {"s": [slider.rubbing]}, **rubbing},
            },
            "kinematics": {},
        }
    )  # fmt: skip
    before = time.perf_counter()
    maestro.operate()
    seconds = time.perf_counter() - before
    logging.disable(logging.NOTSET)
    solutions = maestro.nls["curve"].SolList
    places = size + slider.rubbing, 2 * size + slider.rubbing  # after the mean: cosine and sine of the first harmonic
    sizes = [float(np.hypot(*(one.x[place] for place in places))) for one in solutions]
    return seconds, np.array([one.x[-1] for one in solutions]), np.array(sizes)
