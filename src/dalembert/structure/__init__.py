"""Structures as matrices: mass, stiffness and damping with named degrees of freedom."""

from dalembert.structure.damping import Modal, Rayleigh
from dalembert.structure.dofs import Dofs
from dalembert.structure.eigenmodes import EigenModes, eigenmodes, similarity
from dalembert.structure.lumped import lumped
from dalembert.structure.material import Material
from dalembert.structure.nodes import Nodes
from dalembert.structure.plate import plate
from dalembert.structure.solid import box, solid
from dalembert.structure.structure import Structure

__all__ = [
    "Dofs",
    "EigenModes",
    "Material",
    "Modal",
    "Nodes",
    "Rayleigh",
    "Structure",
    "box",
    "eigenmodes",
    "lumped",
    "plate",
    "similarity",
    "solid",
]
