"""Inertial parameters of trees of rigid links from positions and torques of the joints, as matrices alone."""

from dalembert.inverse.inertial.base_estimate import BaseEstimate, identify_base
from dalembert.inverse.inertial.base_parameters import BaseParameters, base_parameters
from dalembert.inverse.inertial.consistent import identify_inertias
from dalembert.inverse.inertial.consistent_estimate import ConsistentInertias
from dalembert.inverse.inertial.excitation import ExcitingTrajectory, exciting_trajectory
from dalembert.inverse.inertial.fourier_motion import FourierMotion, JointLimits
from dalembert.inverse.inertial.log_cholesky import from_log_cholesky, log_cholesky
from dalembert.inverse.inertial.motion import FilteredMotion, filtered_motion, lowpass
from dalembert.inverse.inertial.pseudo_inertia import (
    ENTRIES,
    bregman_distances,
    inertial_parameters,
    parameter_names,
    pseudo_inertia,
    smallest_eigenvalues,
)
from dalembert.inverse.inertial.recovery import Recovery, simulated_recovery
from dalembert.inverse.inertial.torque_prediction import TorquePrediction

__all__ = [
    "ENTRIES",
    "BaseEstimate",
    "BaseParameters",
    "ConsistentInertias",
    "ExcitingTrajectory",
    "FilteredMotion",
    "FourierMotion",
    "JointLimits",
    "Recovery",
    "TorquePrediction",
    "base_parameters",
    "bregman_distances",
    "exciting_trajectory",
    "filtered_motion",
    "from_log_cholesky",
    "identify_base",
    "identify_inertias",
    "inertial_parameters",
    "log_cholesky",
    "lowpass",
    "parameter_names",
    "pseudo_inertia",
    "simulated_recovery",
    "smallest_eigenvalues",
]
