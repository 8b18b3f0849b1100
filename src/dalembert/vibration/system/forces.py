"""All kinds of forces on a vibrating system."""

from dalembert.vibration.system.base_excitation import BaseExcitation
from dalembert.vibration.system.harmonic_force import HarmonicForce, StaticForce
from dalembert.vibration.system.tabulated_force import TabulatedForce
from dalembert.vibration.system.unbalance import Unbalance

Force = HarmonicForce | StaticForce | Unbalance | TabulatedForce | BaseExcitation
