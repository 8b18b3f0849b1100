"""A model that remembers its responses as long as one method runs."""

from dataclasses import dataclass, field

import numpy as np

from dalembert.forward.responses import Responses
from dalembert.forward.wrapped import Wrapped


@dataclass(frozen=True)
class Remembered(Wrapped):
    """A forward model that simulates no vector twice.

    Examples
    --------
    >>> from dalembert.forward import PythonModel
    >>> model = PythonModel(lambda a: np.full(1, a), {"a": (0.0, 2.0)}, ["x"], np.zeros(1))
    >>> remembered = Remembered(model)
    >>> remembered.evaluate([[1.0], [1.0]]).values.ravel().tolist(), remembered.simulations
    ([1.0, 1.0], 1)
    """

    known: dict[bytes, tuple[np.ndarray, str | None]] = field(default_factory=dict, repr=False, compare=False)

    @property
    def simulations(self) -> int:
        """Number of vectors that were simulated."""
        return len(self.known)

    def evaluate(self, vectors: np.ndarray) -> Responses:
        """Responses of a batch; ``vectors`` (batch, parameters), values (batch, samples, channels)."""
        vectors = np.atleast_2d(np.asarray(vectors, dtype=float))
        keys = [vector.tobytes() for vector in vectors]
        missing = {key: row for row, key in enumerate(keys) if key not in self.known}
        if missing:
            found = self.model.evaluate(vectors[list(missing.values())])
            self.known.update(zip(missing, zip(found.values, found.failures, strict=True), strict=True))
        values, failures = zip(*(self.known[key] for key in keys), strict=True) if keys else ((), ())
        shape = len(self.coordinate.values), len(self.channels)
        return Responses(np.array(values).reshape(-1, *shape), tuple(failures))
