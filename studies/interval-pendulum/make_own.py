"""Write own.csv: bands of the tip while theta1, theta2 and E_AB are each within 5 %, by direct optimisation."""

from pathlib import Path

import numpy as np

from dalembert import Interval, propagate
from dalembert.study import load

FOLDER = Path(__file__).parent
study = load(FOLDER / "propagate-a4.toml")
model = study.forward(study.table.channels, np.array(study.table.times))
box = {
    "theta1": Interval.about(np.pi / 4, relative=0.05),
    "theta2": Interval.about(np.pi / 6, relative=0.05),
    "E_AB": Interval.about(2e7, relative=0.05),
}
bands = propagate(model, box, "optimise")
columns = np.stack([bands.lower, bands.upper], axis=2).reshape(len(bands.lower), -1)
np.savetxt(
    FOLDER / "own.csv",
    np.column_stack([bands.coordinate.values, columns]),
    fmt="%.10g",
    delimiter=",",
    header="t,x_lower,x_upper,y_lower,y_upper",
    comments="",
)
