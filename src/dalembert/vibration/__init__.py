"""Structures with dry friction and other nonlinear elements, in frequency: harmonic balance and continuation."""

from dalembert.vibration.balance.harmonic_balance import HarmonicBalance
from dalembert.vibration.laws.bouc_wen import BoucWen
from dalembert.vibration.laws.contacts import ElasticSlider, FrictionContact, Iwan, Rigid
from dalembert.vibration.laws.cubic_spring import CubicSpring
from dalembert.vibration.laws.element import LawElement
from dalembert.vibration.laws.four_parameter_iwan import FourParameterIwan
from dalembert.vibration.laws.law import law
from dalembert.vibration.laws.stops import BilinearStop, Gap
from dalembert.vibration.laws.user_element import UserElement
from dalembert.vibration.laws.user_law import UserLaw
from dalembert.vibration.modes.nonlinear_modes import Backbone, backbone
from dalembert.vibration.paths.curve import FrequencyCurve, Peak
from dalembert.vibration.paths.deformation import Deformation, deformation
from dalembert.vibration.paths.forward_model import FrequencyResponse
from dalembert.vibration.paths.frequency_response import FollowedPoint, frequency_response
from dalembert.vibration.paths.frequency_responses import CurveFamily, Envelope, frequency_responses
from dalembert.vibration.paths.resonance import ResonanceTrack, track_resonance
from dalembert.vibration.stability.floquet import floquet_multipliers
from dalembert.vibration.system.system import HarmonicForce, StaticForce, VibrationSystem
from dalembert.vibration.time.comparison import TimeComparison, compare_in_time
from dalembert.vibration.time.newmark import Newmark
from dalembert.vibration.time.periodic_motion import PeriodicMotion
from dalembert.vibration.time.reference import steady_state

__all__ = [
    "Backbone",
    "BilinearStop",
    "BoucWen",
    "CubicSpring",
    "CurveFamily",
    "Deformation",
    "ElasticSlider",
    "Envelope",
    "FollowedPoint",
    "FourParameterIwan",
    "FrequencyCurve",
    "FrequencyResponse",
    "FrictionContact",
    "Gap",
    "HarmonicBalance",
    "HarmonicForce",
    "Iwan",
    "LawElement",
    "Newmark",
    "Peak",
    "PeriodicMotion",
    "ResonanceTrack",
    "Rigid",
    "StaticForce",
    "TimeComparison",
    "UserElement",
    "UserLaw",
    "VibrationSystem",
    "backbone",
    "compare_in_time",
    "deformation",
    "floquet_multipliers",
    "frequency_response",
    "frequency_responses",
    "law",
    "steady_state",
    "track_resonance",
]
