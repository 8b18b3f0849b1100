"""Robots and other trees of rigid bodies: description, import, inverse dynamics, linear regressor."""

__all__ = [
    "Link",
    "Poses",
    "Shape",
    "Tree",
    "TreeJoint",
    "bias_forces",
    "inverse_dynamics",
    "mass_matrix",
    "parameter_names",
    "parameters_of",
    "poses",
    "read_mjcf",
    "read_urdf",
    "regressor",
    "with_parameters",
    "write_urdf",
]

from dalembert.multibody.trees.dynamics import Poses as Poses
from dalembert.multibody.trees.dynamics import bias_forces as bias_forces
from dalembert.multibody.trees.dynamics import inverse_dynamics as inverse_dynamics
from dalembert.multibody.trees.dynamics import mass_matrix as mass_matrix
from dalembert.multibody.trees.dynamics import poses as poses
from dalembert.multibody.trees.dynamics import regressor as regressor
from dalembert.multibody.trees.mjcf_reader import read_mjcf as read_mjcf
from dalembert.multibody.trees.parameters import parameter_names as parameter_names
from dalembert.multibody.trees.parameters import parameters_of as parameters_of
from dalembert.multibody.trees.parameters import with_parameters as with_parameters
from dalembert.multibody.trees.tree import Link as Link
from dalembert.multibody.trees.tree import Shape as Shape
from dalembert.multibody.trees.tree import Tree as Tree
from dalembert.multibody.trees.tree import TreeJoint as TreeJoint
from dalembert.multibody.trees.urdf_reader import read_urdf as read_urdf
from dalembert.multibody.trees.urdf_writer import write_urdf as write_urdf
