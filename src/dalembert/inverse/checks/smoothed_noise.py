"""Noise that local polynomials give to data without standard deviations."""

from collections.abc import Iterator

from dalembert.findings import Finding
from dalembert.inverse.identification.assess import Optimum


def smoothed_noise(optimum: Optimum) -> Iterator[Finding]:
    """Yield the finding that the noise of the data was estimated by local polynomials; none where it was not."""
    noise = optimum.posed.smooth_noise
    if noise is None or optimum.posed.noise is not None:
        return
    values = dict(zip(optimum.posed.whole.data.channels, map(float, noise), strict=True))
    listed = ", ".join(f"{name!r} {deviation:.3g}" for name, deviation in values.items())
    message = f"The data have no deviations. Their noise was estimated by local polynomials: {listed}."
    yield Finding("smoothed-noise", "note", values, message, "Give deviations if you know them.")
