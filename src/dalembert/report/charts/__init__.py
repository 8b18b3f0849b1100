"""One function a figure, in a file by its subject; they are imported where they are first used."""

from dalembert.lazy import lazy_names

_NAMES = {
    "bounds.bands": "bands",
    "bounds.methods": "differences methods",
    "frequency.backbone": "backbone",
    "frequency.contact_states": "contact_shares contact_states",
    "frequency.curve_family": "curve_family",
    "frequency.deformation": "deformation",
    "frequency.dissipation": "dissipation",
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
    "identification.convergence": "convergence",
    "identification.correlation": "correlation",
    "identification.designs": "horizons ranking",
    "identification.gaps": "gaps",
    "identification.intervals": "intervals",
    "identification.l_curve": "l_curve",
    "identification.measured": "measured",
    "identification.parameters": "parameters",
    "identification.paving": "paving",
    "identification.prediction": "prediction",
    "identification.profile": "profile",
    "identification.residual_bands": "residual_bands",
    "identification.responses": "responses",
    "identification.singular_values": "singular_values",
    "identification.starts": "starts",
    "identification.steps": "steps",
    "motion.energies": "energies",
    "motion.mechanism": "mechanism",
    "motion.newton": "newton",
    "motion.sweep": "sweep",
    "motion.violations": "violations",
    "motion.work_precision": "work_precision",
}
__getattr__, __dir__ = lazy_names(
    __name__, {name: f"{__name__}.{module}" for module, names in _NAMES.items() for name in names.split()}
)
