"""One function a figure, in a file by its subject; they are imported where they are first used."""

from dalembert.lazy import lazy_names

_NAMES = {
    "bounds.bands": "bands",
    "bounds.methods": "differences methods",
    "bounds.sensitivity": "effects indices shares",
    "frequency.backbone": "backbone",
    "frequency.contacts": "contact_shares contact_states dissipation hysteresis",
    "frequency.curve_family": "curve_family family_peaks resonance_track",
    "frequency.frequency_curve": "frequency_curve harmonic_content load_factors points_found",
    "frequency.interface_map": "interface_map",
    "frequency.linear_modes": "campbell reduction_errors",
    "frequency.ring_down": "decay ring_down",
    "frequency.shapes": "deformation mode_shapes",
    "frequency.static_contact": "normal_forces",
    "frequency.time_domain": "loops_in_time periodic_motion time_comparison",
    "identification.assessment": "horizons prediction profile ranking",
    "identification.identifiability": "correlation singular_values",
    "identification.inertial": "exciting_motion torques",
    "identification.intervals": "intervals residual_bands",
    "identification.model_comparison": "difference_by_group model_differences",
    "identification.parameters": "parameters",
    "identification.paving": "paving",
    "identification.posterior": "marginal pair_plots predictive traces",
    "identification.regularisation": "l_curve penalty_curve smooth_parameters steps",
    "identification.residual_diagnostics": "residual_diagnostics",
    "identification.responses": "gaps measured responses",
    "identification.search": "convergence starts",
    "identification.specimens": "specimens",
    "motion.diagnostics": "energies newton violations work_precision",
    "motion.equilibria": "equilibria equilibrium_path",
    "motion.outputs": "outputs sweep",
}
__getattr__, __dir__ = lazy_names(
    __name__, {name: f"{__name__}.{module}" for module, names in _NAMES.items() for name in names.split()}
)
