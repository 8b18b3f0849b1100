"""Three trials of a chaotic double pendulum, simulated with noise, and what ``shooting = true`` recovers of them.

As a command (``python tests/chaotic_trials.py``) it goes through five seeds with even and with uneven time stamps, and
writes the table tests/verification/references/chaotic_trials.csv.
"""

import runpy
import shutil
import sys
import tempfile
from dataclasses import dataclass
from pathlib import Path
from time import process_time

import numpy as np

from dalembert.inverse import Fit, identify
from dalembert.study import load
from dalembert.study.tables.posing import posed

STUDY = Path(__file__).parents[1] / "studies" / "chaotic-trials"
TABLE = Path(__file__).parent / "verification" / "references" / "chaotic_trials.csv"
SEEDS = 5
HEAD = "seed,stamps,parameters,largest error (deviations),of,misfit (of its expectation),growth,segments,simulations,s"


@dataclass(frozen=True)
class Recovered:
    """A fit of one seed, the errors of its parameters in standard deviations, and the processor's time in s."""

    fit: Fit
    errors: dict[str, float]
    seconds: float

    @property
    def misfit(self) -> float:
        """Weighted sum of squares in parts of its expectation, values less parameters."""
        return self.fit.misfit / (np.count_nonzero(self.fit.weights) - len(self.fit.values))

    def row(self, seed: int, even: bool) -> str:
        """The line of the table."""
        worst = max(self.errors, key=lambda name: abs(self.errors[name]))
        nodes = self.fit.nodes
        assert nodes is not None
        numbers = f"{abs(self.errors[worst]):.2f},{worst},{self.misfit:.4f},{nodes.growth:.1e},{nodes.segments}"
        stamps = "even" if even else "uneven"
        return f"{seed},{stamps},{len(self.errors)},{numbers},{self.fit.simulations},{self.seconds:.0f}"


def recovered(seed: int, *, even: bool) -> Recovered:
    """Return the fit of the study as it is, to records that are made with a seed."""
    made = runpy.run_path(str(STUDY / "make_data.py"))
    with tempfile.TemporaryDirectory() as place:
        folder = Path(place)
        for name in ("identify.toml", "pendulum.toml"):
            shutil.copy(STUDY / name, folder)
        made["write"](folder, seed, even=even)
        study = load(folder / "identify.toml")
        experiments, _ = posed(study)
        began = process_time()
        fit = identify(experiments, shooting=study.table.shooting.settings())
    truth = {
        name: made["TRIALS"][name.partition(".")[0]][name.partition(".")[2]] if "." in name else made["SHARED"][name]
        for name in fit.parameters.names
    }
    errors = {
        name: float((value - truth[name]) / deviation)
        for name, value, deviation in zip(fit.parameters.names, fit.values, fit.deviations, strict=True)
    }
    return Recovered(fit, errors, process_time() - began)


def main() -> None:
    """Write the table."""
    rows = []
    for seed in range(SEEDS):
        for even in (True, False):
            rows.append(recovered(seed, even=even).row(seed, even))
            sys.stdout.write(rows[-1] + "\n")
            sys.stdout.flush()
    TABLE.write_text("\n".join([HEAD, *rows]) + "\n", encoding="utf-8")


if __name__ == "__main__":
    sys.exit(main())
