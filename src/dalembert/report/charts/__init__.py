"""One function a figure, in a file by its subject; they are imported where they are first used."""

from dalembert.lazy import lazy_names

_NAMES = {
    "bounds.bands": "bands",
    "bounds.effects": "effects",
    "bounds.indices": "indices",
    "bounds.methods": "differences methods",
    "bounds.shares": "shares",
    "frequency.backbone": "backbone",
    "frequency.contacts": "contact_shares contact_states dissipation",
    "frequency.curve_family": "curve_family",
    "frequency.deformation": "deformation",
    "frequency.frequency_curve": "frequency_curve",
    "frequency.harmonic_content": "harmonic_content",
    "frequency.hysteresis": "hysteresis",
    "frequency.interface_map": "interface_map",
    "frequency.mode_shapes": "mode_shapes",
    "frequency.periodic_motion": "loops_in_time periodic_motion",
    "frequency.points_found": "points_found",
    "frequency.reduction_errors": "reduction_errors",
    "frequency.resonance_peaks": "family_peaks resonance_track",
    "frequency.time_comparison": "time_comparison",
    "identification.designs": "horizons ranking",
    "identification.exciting_motion": "exciting_motion",
    "identification.gaps": "gaps",
    "identification.identifiability": "correlation singular_values",
    "identification.intervals": "intervals",
    "identification.measured": "measured",
    "identification.parameters": "parameters",
    "identification.paving": "paving",
    "identification.prediction": "prediction",
    "identification.profile": "profile",
    "identification.regularisation": "l_curve steps",
    "identification.residual_bands": "residual_bands",
    "identification.residual_diagnostics": "residual_diagnostics",
    "identification.responses": "responses",
    "identification.search": "convergence starts",
    "identification.specimens": "specimens",
    "identification.torques": "torques",
    "motion.diagnostics": "energies newton violations",
    "motion.mechanism": "mechanism",
    "motion.sweep": "sweep",
    "motion.work_precision": "work_precision",
}
__getattr__, __dir__ = lazy_names(
    __name__, {name: f"{__name__}.{module}" for module, names in _NAMES.items() for name in names.split()}
)
