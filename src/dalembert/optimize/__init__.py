"""Minimisers: swarms, fireflies, least squares, response sensitivity, SciPy's by name. They know no models or data."""

from dalembert.optimize.firefly import Firefly
from dalembert.optimize.improved_particle_swarm import ImprovedParticleSwarm
from dalembert.optimize.least_squares import LeastSquares
from dalembert.optimize.minimiser import Minimiser
from dalembert.optimize.minimum import Minimum, Objective, OnIteration, Progress, RegularisedStep
from dalembert.optimize.particle_swarm import ParticleSwarm
from dalembert.optimize.response_sensitivity import ResponseSensitivity, Squares
from dalembert.optimize.sum_of_squares import SquaresMinimiser
from dalembert.optimize.swarm import Swarm, SwarmState
from dalembert.optimize.tikhonov import Regularised

__all__ = [
    "Firefly",
    "ImprovedParticleSwarm",
    "LeastSquares",
    "Minimiser",
    "Minimum",
    "Objective",
    "OnIteration",
    "ParticleSwarm",
    "Progress",
    "Regularised",
    "RegularisedStep",
    "ResponseSensitivity",
    "Squares",
    "SquaresMinimiser",
    "Swarm",
    "SwarmState",
]
