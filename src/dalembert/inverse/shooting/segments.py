"""A motion cut into segments that each begin anew, and must meet: what multiple shooting fits."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from dalembert.errors import InputError, SolveError
from dalembert.forward import ForwardModel
from dalembert.parameters import Parameters


@dataclass(frozen=True)
class ShootingState:
    """A parameter of the initial state, as it is later in the motion.

    Parameters
    ----------
    channel : str
        Channel of the model whose first value the parameter is.
    lower, upper : float
        Bounds that it keeps throughout the motion, in the channel's unit.
    rate_of : str, optional
        Measured channel whose rate of change it is, to begin with; for a state that is not measured itself.
    """

    channel: str
    lower: float
    upper: float
    rate_of: str | None = None

    def __post_init__(self) -> None:
        if not self.lower < self.upper:
            raise InputError(
                f"ShootingState {self.channel!r}: bounds are ({self.lower:g}, {self.upper:g}); expected lower < upper"
            )


@dataclass(frozen=True, eq=False)
class Piece:
    """One segment."""

    model: ForwardModel  # from the beginning of the segment to its end
    places: np.ndarray  # (parameters,): where its parameters stand among all unknowns
    # rows, columns: (samples,) and (channels,): the values of the data that it explains
    rows: np.ndarray
    columns: np.ndarray
    picked: np.ndarray  # (channels,): their channels among those of the model, whose last samples they are
    ends: np.ndarray  # (states,): the channels that are the state at the end; none in the last segment of a motion
    begins: np.ndarray  # (states,): where the same numbers of the next segment's beginning stand among all unknowns

    @property
    def block(self) -> tuple[np.ndarray, ...]:
        """Index of its values in a table of the data."""
        return np.ix_(self.rows, self.columns)


@dataclass(frozen=True, eq=False)
class Response:
    """What segments answer."""

    values: np.ndarray  # (samples, channels): in the layout of the data; 0 where no segment has a sample
    gaps: np.ndarray  # (gaps,): end of each segment less the beginning of the next one, in parts of the states' ranges


@dataclass(frozen=True, eq=False)
class Tangent:
    """A response of segments with its derivatives."""

    vector: np.ndarray  # (unknowns,)
    response: Response
    # blocks: (samples, channels, parameters): derivative of each segment's values by its own parameters
    blocks: tuple[np.ndarray, ...]
    ends: tuple[np.ndarray, ...]  # (states, parameters): derivative of the state at its end


@dataclass(frozen=True, eq=False)
class Segments:
    """Segments of one or several motions: their values, and by how much they miss each other."""

    pieces: tuple[Piece, ...]  # those of one motion after each other
    parameters: Parameters  # of the whole motions, then the states at the later beginnings
    # ranges: (gaps,): of the states, in the order of the gaps, which is that of the states among the parameters
    ranges: np.ndarray
    shape: tuple[int, int]  # of the data

    def evaluate(self, vector: np.ndarray) -> Response:
        """Response at a vector (unknowns,)."""

        def run(piece: Piece) -> np.ndarray:
            found = piece.model.evaluate(vector[piece.places][None])
            if found.failures[0] is not None:
                raise SolveError(found.failures[0])
            return found.values[0]

        return self._response(vector, [run(piece) for piece in self.pieces])

    def linearise(self, vector: np.ndarray) -> Tangent:
        """Response and derivatives at a vector (unknowns,)."""
        runs = [piece.model.linearise(vector[piece.places]) for piece in self.pieces]
        slopes = [(piece, own) for piece, (_, own) in zip(self.pieces, runs, strict=True)]
        blocks = tuple(own[-len(piece.rows) :][:, piece.picked] for piece, own in slopes)
        ends = tuple(own[-1, piece.ends] for piece, own in slopes)
        return Tangent(vector, self._response(vector, [values for values, _ in runs]), blocks, ends)

    def jacobian(self, at: Tangent) -> np.ndarray:
        """Derivative of the values by all unknowns, shape (samples, channels, unknowns)."""
        jacobian = np.zeros((*self.shape, len(at.vector)))
        for piece, block in zip(self.pieces, at.blocks, strict=True):
            jacobian[np.ix_(piece.rows, piece.columns, piece.places)] = block
        return jacobian

    def slopes_of_gaps(self, at: Tangent) -> np.ndarray:
        """Derivative of the gaps, relative to the ranges of the states, by all unknowns, shape (gaps, unknowns)."""
        slopes, first = np.zeros((len(self.ranges), len(at.vector))), 0
        for piece, ends in zip(self.pieces, at.ends, strict=True):
            rows = first + np.arange(len(piece.ends))
            slopes[np.ix_(rows, piece.places)] = ends
            slopes[rows, piece.begins] -= 1.0
            first += len(rows)
        return slopes / self.ranges[:, None]

    def _response(self, vector: np.ndarray, runs: Sequence[np.ndarray]) -> Response:
        values, gaps = np.zeros(self.shape), [np.zeros(0)]
        for piece, run in zip(self.pieces, runs, strict=True):
            values[piece.block] = run[-len(piece.rows) :][:, piece.picked]
            gaps.append(run[-1, piece.ends] - vector[piece.begins])
        gap = np.concatenate(gaps) / self.ranges
        if not (np.all(np.isfinite(values)) and np.all(np.isfinite(gap))):
            raise SolveError("the response of a segment is not finite")
        return Response(values, gap)
