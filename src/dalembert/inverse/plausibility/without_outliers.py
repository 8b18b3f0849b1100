"""A channel without outliers, one of which would decide about its range."""

import numpy as np

from dalembert.data.problems import outliers


def without_outliers(data: np.ndarray, computed: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return the data and the response, (values,) each, without the samples at which the data have outliers."""
    far = outliers(data)
    return np.delete(data, far), np.delete(computed, far)
