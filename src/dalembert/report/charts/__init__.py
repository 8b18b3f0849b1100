"""One function a figure, each in a file of its own."""

from dalembert.report.charts.backbone import backbone
from dalembert.report.charts.bands import bands
from dalembert.report.charts.contact_states import contact_shares, contact_states
from dalembert.report.charts.convergence import convergence
from dalembert.report.charts.correlation import correlation
from dalembert.report.charts.curve_family import curve_family
from dalembert.report.charts.deformation import deformation
from dalembert.report.charts.designs import horizons, ranking
from dalembert.report.charts.dissipation import dissipation
from dalembert.report.charts.energies import energies
from dalembert.report.charts.frequency_curve import frequency_curve
from dalembert.report.charts.gaps import gaps
from dalembert.report.charts.harmonic_content import harmonic_content
from dalembert.report.charts.hysteresis import hysteresis
from dalembert.report.charts.interface_map import interface_map
from dalembert.report.charts.intervals import intervals
from dalembert.report.charts.l_curve import l_curve
from dalembert.report.charts.measured import measured
from dalembert.report.charts.mechanism import mechanism
from dalembert.report.charts.methods import differences, methods
from dalembert.report.charts.mode_shapes import mode_shapes
from dalembert.report.charts.newton import newton
from dalembert.report.charts.parameters import parameters
from dalembert.report.charts.paving import paving
from dalembert.report.charts.periodic_motion import loops_in_time, periodic_motion
from dalembert.report.charts.points_found import points_found
from dalembert.report.charts.prediction import prediction
from dalembert.report.charts.profile import profile
from dalembert.report.charts.reduction_errors import reduction_errors
from dalembert.report.charts.residual_bands import residual_bands
from dalembert.report.charts.resonance_peaks import family_peaks, resonance_track
from dalembert.report.charts.responses import responses
from dalembert.report.charts.singular_values import singular_values
from dalembert.report.charts.starts import starts
from dalembert.report.charts.steps import steps
from dalembert.report.charts.sweep import sweep
from dalembert.report.charts.time_comparison import time_comparison
from dalembert.report.charts.violations import violations
from dalembert.report.charts.work_precision import work_precision

__all__ = [
    "backbone",
    "bands",
    "contact_shares",
    "contact_states",
    "convergence",
    "correlation",
    "curve_family",
    "deformation",
    "differences",
    "dissipation",
    "energies",
    "family_peaks",
    "frequency_curve",
    "gaps",
    "harmonic_content",
    "horizons",
    "hysteresis",
    "interface_map",
    "intervals",
    "l_curve",
    "loops_in_time",
    "measured",
    "mechanism",
    "methods",
    "mode_shapes",
    "newton",
    "parameters",
    "paving",
    "periodic_motion",
    "points_found",
    "prediction",
    "profile",
    "ranking",
    "reduction_errors",
    "residual_bands",
    "resonance_track",
    "responses",
    "singular_values",
    "starts",
    "steps",
    "sweep",
    "time_comparison",
    "violations",
    "work_precision",
]
