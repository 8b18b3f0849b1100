"""Reference numbers from the closed form of the damped oscillation, by Gaussian quadrature; nothing of dalembert."""

from itertools import product

import numpy as np
from numpy.polynomial.hermite_e import hermegauss
from numpy.polynomial.legendre import leggauss

TIMES = np.linspace(0.0, 1.0, 21)
NODES = 16


def displacement(mass, release, stiffness, damping):
    """Displacement over time of a mass that is released at rest."""
    decay = damping / (2 * mass)
    frequency = np.sqrt(stiffness / mass - decay**2)
    return (
        release * np.exp(-decay * TIMES) * (np.cos(frequency * TIMES) + decay / frequency * np.sin(frequency * TIMES))
    )


def uniform(lower, upper):
    nodes, weights = leggauss(NODES)
    return lower + (upper - lower) * (1 + nodes) / 2, weights / 2


def normal():
    nodes, weights = hermegauss(NODES)
    return nodes, weights / weights.sum()


def indices():
    """First-order and total indices of the whole channel."""
    (mass, a), (release, b), (nodes, c) = uniform(0.9, 1.1), uniform(0.09, 0.11), normal()
    axes = [mass, release, 100 + 5 * nodes, 2 * np.exp(0.3 * nodes)]
    weights = [a, b, c, c]
    values = np.array([displacement(*point) for point in product(*axes)]).reshape(*[NODES] * 4, len(TIMES))

    def mean(table, along):
        for k in sorted(along, reverse=True):
            table = np.tensordot(table, weights[k], axes=(k, 0))
        return table

    def mean_of_squares(table, axes_left):
        for k in reversed(range(len(axes_left))):
            table = np.tensordot(table, weights[axes_left[k]], axes=(k, 0))
        return table

    centre = mean(values, range(4))
    variance = (mean_of_squares(values**2, range(4)) - centre**2).sum()
    for k, name in enumerate(("mass", "release", "stiffness", "damping")):
        others = [j for j in range(4) if j != k]
        alone = (mean_of_squares(mean(values, others) ** 2, [k]) - centre**2).sum()
        without = (mean_of_squares(mean(values, [k]) ** 2, others) - centre**2).sum()
        print(f"{name}: first-order index {alone / variance:.5f}, total index {1 - without / variance:.5f}")


def effects():
    """Mean over four levels of each value of the root mean square of the effects over time."""
    ends = np.array([[0.9, 1.1], [0.09, 0.11], [85.0, 115.0], [1.0, 4.0]])
    levels = np.array([0.0, 1 / 3, 2 / 3, 1.0])
    for k, name in enumerate(("mass", "release", "stiffness", "damping")):
        sizes = []
        for point in product(levels, levels, levels, levels):
            if point[k] > 0.5:
                continue
            both = np.array([point, point])
            both[1, k] += 2 / 3
            low, high = (displacement(*(ends[:, 0] + part * (ends[:, 1] - ends[:, 0]))) for part in both)
            sizes.append(np.sqrt(np.mean(((high - low) / (2 / 3)) ** 2)))
        print(f"{name}: effect {1e3 * np.mean(sizes):.4f} mm")


if __name__ == "__main__":
    indices()
    effects()
