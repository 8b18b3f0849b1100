"""Columns of the arrays of a file: vectors as they are, and matrices by their columns or rows."""

from collections.abc import Iterator, Mapping

import numpy as np


def spread(
    arrays: Mapping[str, np.ndarray], time: str | None, first: int = 0, brackets: str = "[]"
) -> dict[str, np.ndarray]:
    """Return the columns of arrays by name; a matrix with as many columns as the times gives its rows. ``time``: array
    of the times; ``first``: number of the first column; ``brackets``: around numbers of columns.

    >>> list(spread({"t": np.zeros(3), "q": np.zeros((2, 3))}, "t"))
    ['t', 'q[0,:]', 'q[1,:]']
    """
    samples = len(arrays[time]) if time is not None and time in arrays and arrays[time].ndim == 1 else 0
    return {label: part for name, array in arrays.items() for label, part in _of(name, array, samples, first, brackets)}


def parts(arrays: Mapping[str, np.ndarray], first: int = 0, brackets: str = "[]") -> dict[str, np.ndarray]:
    """Return the columns of arrays where no column of times is known: as many samples as the longest vector."""
    samples = max((array.size for array in arrays.values() if array.ndim == 1), default=0)
    return {label: part for name, array in arrays.items() for label, part in _of(name, array, samples, first, brackets)}


def _of(name: str, array: np.ndarray, samples: int, first: int, brackets: str) -> Iterator[tuple[str, np.ndarray]]:
    """A vector as it is; a matrix as its columns, or as its rows if those are as long as the times."""
    left, right = brackets
    if array.ndim != 2:
        yield name, array
    elif array.shape[1] == samples != array.shape[0]:
        yield from ((f"{name}{left}{row},:{right}", part) for row, part in enumerate(array, start=first))
    else:
        yield from ((f"{name}{left}:,{column}{right}", part) for column, part in enumerate(array.T, start=first))
