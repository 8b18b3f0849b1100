"""Samples over time as a text file with columns."""

from collections.abc import Sequence
from pathlib import Path

import numpy as np

from dalembert.files import write_text


def write_samples(path: Path, names: Sequence[str], times: np.ndarray, values: np.ndarray) -> None:
    """Write times (samples,) and values (samples, channels) in SI units as CSV, whole or not at all.

    >>> from tempfile import TemporaryDirectory
    >>> with TemporaryDirectory() as folder:
    ...     write_samples(Path(folder) / "a.csv", ["bar.end.x"], np.array([0.0, 0.1]), np.array([[1.0], [0.5]]))
    ...     (Path(folder) / "a.csv").read_text()
    't,bar.end.x\\n0,1\\n0.1,0.5\\n'
    """
    rows = np.column_stack([times, values])
    lines = [",".join(["t", *names]), *(",".join(f"{value:.9g}" for value in row) for row in rows)]
    write_text(path, "\n".join(lines) + "\n")
