"""Parameters from measurements."""

from dalembert.inverse.bands import BandFit, GlobalSurrogate, Nested, identify_bands
from dalembert.inverse.estimate import Identifiability
from dalembert.inverse.events import (
    Checked,
    Event,
    Finished,
    Paved,
    Sampled,
    Screened,
    StartBegan,
    StartEnd,
    Step,
    as_record,
)
from dalembert.inverse.experiment_fit import ExperimentFit
from dalembert.inverse.experiments import Experiment
from dalembert.inverse.fit import Fit
from dalembert.inverse.identify import identify
from dalembert.inverse.sets import ParameterSet, identify_set
from dalembert.inverse.validation import Validation

__all__ = [
    "BandFit",
    "Checked",
    "Event",
    "Experiment",
    "ExperimentFit",
    "Finished",
    "Fit",
    "GlobalSurrogate",
    "Identifiability",
    "Nested",
    "ParameterSet",
    "Paved",
    "Sampled",
    "Screened",
    "StartBegan",
    "StartEnd",
    "Step",
    "Validation",
    "as_record",
    "identify",
    "identify_bands",
    "identify_set",
]
