"""Structures with dry friction and other nonlinear elements, in frequency: harmonic balance and continuation.

The names are imported where they are first used; ``__init__.pyi``, which ``make names`` writes, says the same to type
checkers and editors.
"""

from dalembert.lazy import lazy_names

_NAMES = {
    "balance.harmonic_balance": "HarmonicBalance",
    "laws.bouc_wen": "BoucWen",
    "laws.contacts": "ElasticSlider FrictionContact Iwan Rigid",
    "laws.cubic_spring": "CubicSpring",
    "laws.element": "LawElement",
    "laws.four_parameter_iwan": "FourParameterIwan",
    "laws.law": "law",
    "laws.stops": "BilinearStop Gap",
    "laws.user_element": "UserElement",
    "laws.user_law": "UserLaw",
    "modes.backbone_response": "BackboneResponse",
    "modes.backbone_result": "Backbone",
    "modes.nonlinear_modes": "backbone",
    "paths.curve": "FrequencyCurve Peak",
    "paths.deformation": "Deformation deformation",
    "responses.control": "HeldAmplitude",
    "responses.forward_model": "FrequencyResponse",
    "responses.branch": "follow_branch",
    "responses.coexisting_motions": "coexisting_motions",
    "responses.isolated_branches": "isolated_branches",
    "responses.followed_curve": "FollowedPoint",
    "responses.frequency_response": "frequency_response",
    "responses.curve_family": "CurveFamily Envelope",
    "responses.frequency_responses": "frequency_responses",
    "responses.resonance": "track_resonance",
    "responses.resonance_track": "ResonanceTrack",
    "responses.static_contact": "StaticContact static_contact",
    "stability.floquet": "floquet_multipliers",
    "system.base_excitation": "BaseExcitation",
    "system.harmonic_force": "HarmonicForce StaticForce",
    "system.system": "VibrationSystem",
    "system.tabulated_force": "TabulatedForce",
    "system.unbalance": "Unbalance",
    "time.comparison": "TimeComparison compare_in_time",
    "time.newmark": "Newmark",
    "time.periodic_motion": "PeriodicMotion",
    "time.reference": "steady_state",
}
_HOMES = {name: f"{__name__}.{module}" for module, names in _NAMES.items() for name in names.split()}

__getattr__, __dir__ = lazy_names(__name__, _HOMES)
