"""Structures with dry friction and other nonlinear elements, in frequency: harmonic balance and continuation."""

from dalembert.vibration.balance.harmonic_balance import HarmonicBalance
from dalembert.vibration.laws.contacts import Elastic, FrictionContact, Iwan, Rigid
from dalembert.vibration.laws.springs import BilinearStop, CubicSpring, Gap, UserElement
from dalembert.vibration.modes.backbone import Backbone
from dalembert.vibration.modes.nonlinear_modes import backbone
from dalembert.vibration.paths.curve import FrequencyCurve, Peak
from dalembert.vibration.paths.curve_family import CurveFamily, Envelope
from dalembert.vibration.paths.deformation import Deformation, deformation
from dalembert.vibration.paths.forward_model import FrequencyResponse
from dalembert.vibration.paths.frequency_response import FollowedPoint, frequency_response
from dalembert.vibration.paths.frequency_responses import frequency_responses
from dalembert.vibration.paths.resonance import track_resonance
from dalembert.vibration.paths.resonance_track import ResonanceTrack
from dalembert.vibration.stability.floquet import floquet_multipliers
from dalembert.vibration.system.system import HarmonicForce, StaticForce, VibrationSystem
from dalembert.vibration.time.comparison import TimeComparison, compare_in_time
from dalembert.vibration.time.newmark import Newmark
from dalembert.vibration.time.periodic_motion import PeriodicMotion
from dalembert.vibration.time.reference import steady_state

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
