"""Modes of a posterior that no chain connects."""

from collections.abc import Iterator

import numpy as np
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from dalembert.findings import Finding
from dalembert.inverse.posterior.modes import Modes
from dalembert.inverse.posterior.samplers.sampler import Sampler
from dalembert.inverse.problem.simulated import named


def separate_modes(modes: Modes, places: np.ndarray, sampler: Sampler) -> Iterator[Finding]:
    """Yield the finding on modes between which no chain moves.

    A chain visits a mode where one of its draws is within the distance √(number of parameters) of it, in standard
    deviations: about half of the draws of a normal mode are. Modes that one chain visits are connected.

    Parameters
    ----------
    places : array, shape (chains, draws, parameters)
        Draws, in the coordinates of the best mode.
    """
    if len(modes.targets) < 2:
        return
    points = modes.best.target.points(places)
    distances = np.stack([np.linalg.norm(target.places(points), axis=-1) for target in modes.targets])
    nearest = np.argmin(distances, axis=0)
    inside = distances <= np.sqrt(places.shape[-1])
    visits = np.any(inside, axis=2)  # modes, chains
    mode, chain = np.nonzero(visits)
    count, chains = visits.shape
    joined = coo_array((np.ones(len(mode)), (mode, count + chain)), shape=(count + chains, count + chains))
    _, group = connected_components(joined, directed=False)
    if len(set(group[:count])) == 1:
        return
    model = modes.best.target.problem.model
    vectors = [one.vector[: len(model.parameters)] for one in modes.centred]
    values: dict[str, float] = {"modes": count}
    for number, (vector, share) in enumerate(zip(vectors, modes.shares, strict=True), 1):
        values |= {f"mode_{number}.{name}": float(value) for name, value in model.parameters.mapping(vector).items()}
        values[f"mode_{number}.share"] = float(share)
        values[f"mode_{number}.draws"] = float(np.mean(nearest == number - 1))
    texts = [
        f"{named(model, vector)} (about {100 * share:.0f} % of the probability, "
        f"{100 * values[f'mode_{number}.draws']:.0f} % of the draws)"
        for number, (vector, share) in enumerate(zip(vectors, modes.shares, strict=True), 1)
    ]
    message = f"The posterior has {count} modes that no chain connects: {'; '.join(texts)}."
    jumps = "Increase draws" if sampler.jumps else "Use the sampler 'affine-invariant', which jumps between modes"
    yield Finding(
        "separate-modes",
        "error",
        values,
        message,
        f"{jumps}, measure another channel, or narrow the bounds to one mode.",
    )
