"""Parameters from measurements."""

from dalembert.inverse.assessment import (
    Designs,
    Prediction,
    Profile,
    Profiles,
    design,
    identifiability,
    predict,
    profile,
)
from dalembert.inverse.bands import BandFit, GlobalSurrogate, Nested, identify_bands
from dalembert.inverse.correlation import CorrelatedResiduals, NoiseProcess
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
from dalembert.inverse.experiments.experiment import Experiment, ExperimentFit
from dalembert.inverse.experiments.validation import Validation
from dalembert.inverse.fit.fit import Fit
from dalembert.inverse.identify import identify
from dalembert.inverse.least_squares.estimate import Identifiability
from dalembert.inverse.sets import ParameterSet, identify_set
from dalembert.inverse.shooting.nodes import Nodes
from dalembert.inverse.shooting.segments import ShootingState
from dalembert.inverse.shooting.shooting import MultipleShooting

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
    "ShootingState",
    "StartBegan",
    "StartEnd",
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
