"""Minimisers: particle swarms, least squares, and SciPy's by name. They know nothing of models or data."""

from dalembert.optimize.improved_particle_swarm import ImprovedParticleSwarm
from dalembert.optimize.least_squares import LeastSquares
from dalembert.optimize.minimiser import Minimiser
from dalembert.optimize.minimum import Minimum, Objective, OnIteration, Progress
from dalembert.optimize.particle_swarm import ParticleSwarm
from dalembert.optimize.swarm import Swarm, SwarmState

__all__ = [
    "ImprovedParticleSwarm",
    "LeastSquares",
    "Minimiser",
    "Minimum",
    "Objective",
    "OnIteration",
    "ParticleSwarm",
    "Progress",
    "Swarm",
    "SwarmState",
]
