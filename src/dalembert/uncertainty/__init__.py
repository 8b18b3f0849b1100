"""Bounds of a response while parameters are anywhere in their intervals."""

from dalembert.uncertainty.chebyshev import Chebyshev
from dalembert.uncertainty.comparison import ComparedMethod, Comparison, compare
from dalembert.uncertainty.events import Began, Ended, Event, Ran, as_record
from dalembert.uncertainty.methods import methods_by_name
from dalembert.uncertainty.morris import screen
from dalembert.uncertainty.optimise import Optimise
from dalembert.uncertainty.propagate import propagate
from dalembert.uncertainty.propagation import Propagation
from dalembert.uncertainty.samplings import LatinHypercube, MonteCarlo, Sampling, Scan, Vertex
from dalembert.uncertainty.screening import Screening
from dalembert.uncertainty.sensitivity_indices import SensitivityIndices
from dalembert.uncertainty.sobol import global_sensitivity
from dalembert.uncertainty.taylor import Taylor

__all__ = [
    "Began",
    "Chebyshev",
    "ComparedMethod",
    "Comparison",
    "Ended",
    "Event",
    "LatinHypercube",
    "MonteCarlo",
    "Optimise",
    "Propagation",
    "Ran",
    "Sampling",
    "Scan",
    "Screening",
    "SensitivityIndices",
    "Taylor",
    "Vertex",
    "as_record",
    "compare",
    "global_sensitivity",
    "methods_by_name",
    "propagate",
    "screen",
]
