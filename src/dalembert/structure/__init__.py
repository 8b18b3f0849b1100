"""Structures as matrices: mass, stiffness and damping with named degrees of freedom."""

from dalembert.structure.campbell import Campbell
from dalembert.structure.craig_bampton import ReducedStructure, ReductionErrors, craig_bampton
from dalembert.structure.damping import Modal, Rayleigh
from dalembert.structure.dofs import Dofs
from dalembert.structure.eigenmodes import EigenModes, eigenmodes, similarity
from dalembert.structure.free_body_modes import FreeBodyModes, free_body_modes, strain_between
from dalembert.structure.interface_nodes import InterfaceNode
from dalembert.structure.joining import combine, pairs, tie
from dalembert.structure.material import Material
from dalembert.structure.mode_shapes import ModeShapes, mode_shapes, node_motion
from dalembert.structure.nodes import Nodes
from dalembert.structure.patched_plate import Patch, foot_pairs, patched_plate
from dalembert.structure.plate import plate
from dalembert.structure.read_structure import read_structure, write_structure
from dalembert.structure.rotors import Disc, RotatingDamper, with_rotors
from dalembert.structure.solid import box, solid
from dalembert.structure.springs import lumped
from dalembert.structure.structure import Structure

__all__ = [
    "Campbell",
    "Disc",
    "Dofs",
    "EigenModes",
    "FreeBodyModes",
    "InterfaceNode",
    "Material",
    "Modal",
    "ModeShapes",
    "Nodes",
    "Patch",
    "Rayleigh",
    "ReducedStructure",
    "ReductionErrors",
    "RotatingDamper",
    "Structure",
    "box",
    "combine",
    "craig_bampton",
    "eigenmodes",
    "foot_pairs",
    "free_body_modes",
    "lumped",
    "mode_shapes",
    "node_motion",
    "pairs",
    "patched_plate",
    "plate",
    "read_structure",
    "similarity",
    "solid",
    "strain_between",
    "tie",
    "with_rotors",
    "write_structure",
]
