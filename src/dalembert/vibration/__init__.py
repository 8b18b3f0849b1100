"""Structures with dry friction and other nonlinear elements, in frequency: harmonic balance and continuation."""

from dalembert.vibration.backbone import Backbone
from dalembert.vibration.contacts import Elastic, FrictionContact, Iwan, Rigid
from dalembert.vibration.curve import FrequencyCurve, Peak
from dalembert.vibration.curve_family import CurveFamily, Envelope
from dalembert.vibration.deformation import Deformation, deformation
from dalembert.vibration.floquet import floquet_multipliers
from dalembert.vibration.forward_model import FrequencyResponse
from dalembert.vibration.frequency_response import FollowedPoint, frequency_response
from dalembert.vibration.frequency_responses import frequency_responses
from dalembert.vibration.harmonic_balance import HarmonicBalance
from dalembert.vibration.newmark import Newmark
from dalembert.vibration.nonlinear_modes import backbone
from dalembert.vibration.periodic_motion import PeriodicMotion
from dalembert.vibration.resonance import track_resonance
from dalembert.vibration.resonance_track import ResonanceTrack
from dalembert.vibration.springs import BilinearStop, CubicSpring, Gap, UserElement
from dalembert.vibration.system import HarmonicForce, StaticForce, VibrationSystem
from dalembert.vibration.time_comparison import TimeComparison, compare_in_time
from dalembert.vibration.time_reference import steady_state

__all__ = [
    "Backbone",
    "BilinearStop",
    "CubicSpring",
    "CurveFamily",
    "Deformation",
    "Elastic",
    "Envelope",
    "FollowedPoint",
    "FrequencyCurve",
    "FrequencyResponse",
    "FrictionContact",
    "Gap",
    "HarmonicBalance",
    "HarmonicForce",
    "Iwan",
    "Newmark",
    "Peak",
    "PeriodicMotion",
    "ResonanceTrack",
    "Rigid",
    "StaticForce",
    "TimeComparison",
    "UserElement",
    "VibrationSystem",
    "backbone",
    "compare_in_time",
    "deformation",
    "floquet_multipliers",
    "frequency_response",
    "frequency_responses",
    "steady_state",
    "track_resonance",
]
