"""Powers of two by which numbers are scaled before they are squared; the scaling does not round."""

import numpy as np


def powers_of_two(*tables: np.ndarray) -> np.ndarray:
    """Return the exponent of the largest magnitude of each column of tables (rows, outputs), as integers (outputs,).

    Numbers x 2^-exponent are below 1, so that the sum of their squares is finite.

    >>> powers_of_two(np.array([[3.0, 0.0], [-1.0, 0.0]])), powers_of_two(np.array([[1e200]]))
    (array([2, 0]), array([665]))
    """
    largest = np.max([np.abs(table).max(axis=0, initial=0.0) for table in tables], axis=0)
    return np.frexp(largest)[1].astype(int)
