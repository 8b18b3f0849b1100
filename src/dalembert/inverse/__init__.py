"""Parameters from measurements."""

from dalembert.inverse.assessment.design import design
from dalembert.inverse.assessment.designs import Designs
from dalembert.inverse.assessment.identifiability import identifiability
from dalembert.inverse.assessment.predict import predict
from dalembert.inverse.assessment.prediction import Prediction
from dalembert.inverse.assessment.profile import profile
from dalembert.inverse.assessment.profiles import Profile, Profiles
from dalembert.inverse.bands.band_fit import BandFit
from dalembert.inverse.bands.global_surrogate import GlobalSurrogate
from dalembert.inverse.bands.identify_bands import identify_bands
from dalembert.inverse.bands.nested import Nested
from dalembert.inverse.correlation.correlated import CorrelatedResiduals, NoiseProcess
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
from dalembert.inverse.sets.identify_set import identify_set
from dalembert.inverse.sets.parameter_set import ParameterSet
from dalembert.inverse.shooting.nodes import Nodes
from dalembert.inverse.shooting.segments import ShootingState
from dalembert.inverse.shooting.shooting import MultipleShooting
from dalembert.inverse.specimens.estimate import population
from dalembert.inverse.specimens.population import Population

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
    "Population",
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
    "population",
    "predict",
    "profile",
]
