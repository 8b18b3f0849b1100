"""The best preload of rigid and of elastic contacts: where the largest peak of the curve is least."""

from dataclasses import dataclass
from pathlib import Path

import numpy as np
from scipy.optimize import minimize_scalar

from dalembert.study import load
from dalembert.vibration import HarmonicBalance, Peak, frequency_response

HERE = Path(__file__).parent
FREQUENCIES = np.linspace(180.0, 300.0, 121)  # Hz
METHOD = HarmonicBalance(7)


@dataclass(frozen=True)
class Best:
    """The best preload in N, the peak with it, and the peak with 80 N."""

    preload: float
    peak: Peak
    at_80: Peak


def best(study: str) -> Best:
    """Return the best preload of a study's model."""
    build = load(HERE / study).along("preload")

    def peak(preload: float) -> Peak:
        return frequency_response(build(preload=preload), FREQUENCIES, METHOD, check=False).peak("upper1.x")

    # Golden sections, because two peaks of the curve are equal at the best preload: a parabola does not fit there.
    found = minimize_scalar(
        lambda preload: peak(preload).amplitude, bracket=(60.0, 80.0, 120.0), method="golden", tol=1e-3
    )
    return Best(float(found.x), peak(found.x), peak(80.0))


if __name__ == "__main__":
    for name in ("rigid.toml", "elastic.toml"):
        one = best(name)
        print(
            f"{name}: {one.preload:.1f} N, {1e6 * one.peak.amplitude:.1f} um at {one.peak.frequency:.1f} Hz; "
            f"with 80 N {1e6 * one.at_80.amplitude:.1f} um at {one.at_80.frequency:.1f} Hz"
        )
