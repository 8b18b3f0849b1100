"""Parameters from measurements."""

from dalembert.inverse.bands import BandFit, GlobalSurrogate, Nested, identify_bands
from dalembert.inverse.correlation import CorrelatedResiduals, NoiseProcess
from dalembert.inverse.estimate import Identifiability
from dalembert.inverse.events import (
    Checked,
    Event,
    Finished,
    Paved,
    Profiled,
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
from dalembert.inverse.nodes import Nodes
from dalembert.inverse.segments import State
from dalembert.inverse.sets import ParameterSet, identify_set
from dalembert.inverse.shooting import MultipleShooting
from dalembert.inverse.telling import Designs, Prediction, Profile, Profiles, design, identifiability, predict, profile
from dalembert.inverse.validation import Validation

__all__ = [
    "BandFit",
    "Checked",
    "CorrelatedResiduals",
    "Designs",
    "Event",
    "Experiment",
    "ExperimentFit",
    "Finished",
    "Fit",
    "GlobalSurrogate",
    "Identifiability",
    "MultipleShooting",
    "Nested",
    "Nodes",
    "NoiseProcess",
    "ParameterSet",
    "Paved",
    "Prediction",
    "Profile",
    "Profiled",
    "Profiles",
    "Sampled",
    "Screened",
    "StartBegan",
    "StartEnd",
    "State",
    "Step",
    "Validation",
    "as_record",
    "design",
    "identifiability",
    "identify",
    "identify_bands",
    "identify_set",
    "predict",
    "profile",
]
