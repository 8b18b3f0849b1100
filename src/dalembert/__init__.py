"""Simulate mechanical systems, identify their parameters from measured motion, and bound what is uncertain.

The public names are imported where they are first used, so that ``import dalembert`` costs almost nothing;
``__init__.pyi``, which ``make names`` writes, says the same to type checkers and editors.
"""

from dalembert.component_index import KINDS
from dalembert.lazy import lazy_names

__version__ = "0.1.0"

_MODULES = (
    "errors",
    "parameters",
    "priors",
    "intervals",
    "findings",
    "elementary",
    "forward",
    "optimize",
    "surrogate",
    "structure",
    "data",
    "inverse",
    "multibody",
    "export",
    "report",
    "study",
    "uncertainty",
    "vibration",
    "signals",
)

_NAMES = {
    "errors": "DalembertError InputError ModelError SolveError ClusterError DataError StorageError",
    "parameter": "Parameter",
    "parameters": "Parameters",
    "priors": "CorrelatedNormal HalfNormal LogNormal LogUniform Normal Uniform",
    "intervals": "Box Interval",
    "findings": "Finding",
    "elementary": "absolute atan2 hypot norm",
    "forward": """
        Channel Checkpoint Coordinate Distributed ForwardModel PythonModel Recorded Responses Sensor Sensors on_cluster
    """,
    "optimize": "Firefly ImprovedParticleSwarm LeastSquares Minimiser ParticleSwarm ResponseSensitivity",
    "surrogate": "Adaptive ChebyshevPolynomial Surrogate Tensor TotalDegree",
    "structure": """
        Campbell Dofs EigenModes Material Modal ModeShapes Nodes Patch Rayleigh ReducedStructure ReductionErrors
        Structure box combine craig_bampton eigenmodes foot_pairs lumped mode_shapes node_motion pairs
        patched_plate plate read_structure similarity solid tie write_structure
    """,
    "data": """
        Bands Measurements derivative merged read read_bands read_trials
    """,
    "inverse": """
        AffineInvariant AutoregressiveNoise BandFit ConstantNoise CrossValidation DelayedAcceptance Designs
        EstimatedNoise Experiment Fit GlobalSurrogate InputErrors KnownNoise Likelihood MixedNoise
        ModelComparison MultipleShooting NUTS Nested NoiseModel OrnsteinUhlenbeckNoise ParameterSet Population
        Posterior Prediction Profiles ProportionalNoise ResidualDiagnostics ShootingState compare_models
        cross_validate design identifiability identify identify_bands identify_set input_errors likelihood
        population predict profile sample
        RegularisedFit RingDown regularise ring_down
    """,
    "multibody": """
        System Point TimeResponse Trajectory WorkPrecision simulate campbell equilibrium modes work_precision
        Augmented Baumgarte GaussNewton Partitioning Projection
    """,
    "export": "export_vtk",
    "uncertainty": """
        Comparison Propagation Screening SensitivityIndices compare global_sensitivity propagate screen
        Chebyshev LatinHypercube MonteCarlo Optimise Scan Taylor Vertex
    """,
    "vibration": """
        VibrationSystem HarmonicForce StaticForce Unbalance TabulatedForce BaseExcitation
        FrictionContact ElasticSlider Iwan Rigid
        CubicSpring Gap BilinearStop BoucWen FourParameterIwan LawElement UserElement UserLaw law
        HarmonicBalance FrequencyCurve FrequencyResponse HeldAmplitude frequency_response
        coexisting_motions follow_branch isolated_branches
        Backbone BackboneResponse ResonanceTrack backbone floquet_multipliers track_resonance
        CurveFamily frequency_responses
        Deformation deformation StaticContact static_contact
        Newmark PeriodicMotion TimeComparison compare_in_time steady_state
    """,
}
_HOMES = {name: f"{__name__}.{module}" for module, names in _NAMES.items() for name in names.split()}
_HOMES |= {
    name: f"{__name__}.multibody" for base, names in KINDS.items() if base != "Signal" for name in names
}  # signals are in `dalembert.signals`

__getattr__, _names = lazy_names(__name__, _HOMES, _MODULES)


def __dir__() -> list[str]:
    return ["__version__", *_names()]
