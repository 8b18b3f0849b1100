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
from dalembert.inverse.comparison.compare_models import compare_models
from dalembert.inverse.comparison.cross_validate import cross_validate
from dalembert.inverse.comparison.cross_validation import CrossValidation
from dalembert.inverse.comparison.model_comparison import ModelComparison
from dalembert.inverse.decays.ring_down import ring_down
from dalembert.inverse.decays.ring_down_result import RingDown
from dalembert.inverse.diagnostics.findings import Outlier
from dalembert.inverse.diagnostics.influence import Influence
from dalembert.inverse.diagnostics.residual_diagnostics import ResidualDiagnostics
from dalembert.inverse.diagnostics.series_residuals import SeriesResiduals
from dalembert.inverse.events import (
    Checked,
    Drawn,
    Event,
    Finished,
    Paved,
    Profiled,
    Sampled,
    Screened,
    SearchIteration,
    StartBegan,
    StartEnd,
    as_record,
)
from dalembert.inverse.experiments.experiment import Experiment, ExperimentFit
from dalembert.inverse.fit.fit import Fit
from dalembert.inverse.identify import identify
from dalembert.inverse.least_squares.estimate import Identifiability
from dalembert.inverse.noise.correlation.correlated_residuals import CorrelatedResiduals, NoiseProcess
from dalembert.inverse.noise.input_errors import InputErrors, input_errors
from dalembert.inverse.noise.likelihood.estimated_noise import EstimatedNoise
from dalembert.inverse.noise.likelihood.likelihood import Likelihood, likelihood
from dalembert.inverse.noise.models.correlated_noise import AutoregressiveNoise, OrnsteinUhlenbeckNoise
from dalembert.inverse.noise.models.independent_noise import ConstantNoise, KnownNoise, MixedNoise, ProportionalNoise
from dalembert.inverse.noise.models.noise_model import NoiseModel
from dalembert.inverse.posterior.posterior import Posterior
from dalembert.inverse.posterior.sample import sample
from dalembert.inverse.posterior.samplers.affine_invariant import AffineInvariant
from dalembert.inverse.posterior.samplers.delayed_acceptance import DelayedAcceptance
from dalembert.inverse.posterior.samplers.nuts import NUTS
from dalembert.inverse.problem.nodes import Nodes
from dalembert.inverse.regularised.regularise import regularise
from dalembert.inverse.regularised.regularised_fit import RegularisedFit
from dalembert.inverse.sets.identify_set import identify_set
from dalembert.inverse.sets.parameter_set import ParameterSet
from dalembert.inverse.shooting.segments import ShootingState
from dalembert.inverse.shooting.shooting import MultipleShooting
from dalembert.inverse.specimens.estimate_population import population
from dalembert.inverse.specimens.population import Population
from dalembert.inverse.validation.validation import Validation

__all__ = [
    "NUTS",
    "AffineInvariant",
    "AutoregressiveNoise",
    "BandFit",
    "Checked",
    "ConstantNoise",
    "CorrelatedResiduals",
    "CrossValidation",
    "DelayedAcceptance",
    "Designs",
    "Drawn",
    "EstimatedNoise",
    "Event",
    "Experiment",
    "ExperimentFit",
    "Finished",
    "Fit",
    "GlobalSurrogate",
    "Identifiability",
    "Influence",
    "InputErrors",
    "KnownNoise",
    "Likelihood",
    "MixedNoise",
    "ModelComparison",
    "MultipleShooting",
    "Nested",
    "Nodes",
    "NoiseModel",
    "NoiseProcess",
    "OrnsteinUhlenbeckNoise",
    "Outlier",
    "ParameterSet",
    "Paved",
    "Population",
    "Posterior",
    "Prediction",
    "Profile",
    "Profiled",
    "Profiles",
    "ProportionalNoise",
    "RegularisedFit",
    "ResidualDiagnostics",
    "RingDown",
    "Sampled",
    "Screened",
    "SearchIteration",
    "SeriesResiduals",
    "ShootingState",
    "StartBegan",
    "StartEnd",
    "Validation",
    "as_record",
    "compare_models",
    "cross_validate",
    "design",
    "identifiability",
    "identify",
    "identify_bands",
    "identify_set",
    "input_errors",
    "likelihood",
    "population",
    "predict",
    "profile",
    "regularise",
    "ring_down",
    "sample",
]
