"""Structures as matrices: mass, stiffness and damping with named degrees of freedom."""

from dalembert.structure.dofs import Dofs
from dalembert.structure.lumped import lumped
from dalembert.structure.structure import Structure

__all__ = ["Dofs", "Structure", "lumped"]
