"""The parameters of a tree in which its torques are linear: ten a link, three a joint."""

__all__ = ["parameter_names", "parameters_of", "with_parameters"]

from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from dalembert.errors import InputError
from dalembert.multibody.components.spatial.inertia import Inertia
from dalembert.multibody.trees.frames import pseudo_of, ten_of
from dalembert.multibody.trees.tree import ENTRIES, JOINT_NUMBERS, Link, Tree, TreeJoint

TEN = ("mass", *(f"first_{axis}" for axis in "xyz"), *(f"second_{entry}" for entry in ENTRIES))


def heavy(tree: Tree) -> list[Link]:
    """The links with inertia."""
    return [link for link in tree.links if link.inertia is not None]


def turning(tree: Tree) -> list[TreeJoint]:
    """The joints that move, those that follow another one included."""
    return [joint for joint in tree.joints if joint.moves]


def parameter_names(tree: Tree) -> tuple[str, ...]:
    """Names of the parameters, in the order of :func:`parameters_of` and of the columns of the regressor.

    For each link with inertia ``<link>.mass`` (kg), ``<link>.first_x`` to ``_z`` (mass x centre, kg m), and
    ``<link>.second_xx``, ``_yy``, ``_zz``, ``_xy``, ``_xz``, ``_yz`` (inertia tensor about the origin of the link,
    kg m^2, J_xy = -integral of x y dm). Then for each joint that moves ``<joint>.damping``, ``<joint>.friction`` and
    ``<joint>.armature``. Links and joints are in the order of the tree.
    """
    links = [f"{link.name}.{name}" for link in heavy(tree) for name in TEN]
    return (*links, *(f"{joint.name}.{name}" for joint in turning(tree) for name in JOINT_NUMBERS))


def parameters_of(tree: Tree) -> np.ndarray:
    """The parameters in which the torques are linear, (parameters,), in the order of :func:`parameter_names`.

    Examples
    --------
    >>> from dalembert.multibody.spatial import Inertia
    >>> from dalembert.multibody.trees.tree import Link, Tree, TreeJoint
    >>> rod = Inertia(2.0, (0.1, 0.1, 0.01), centre=(0.0, 0.0, 0.5))
    >>> tree = Tree("pendulum", "base", (Link("rod", "base", TreeJoint("pin", axis=(0.0, 1.0, 0.0)), rod),))
    >>> dict(zip(parameter_names(tree), parameters_of(tree).tolist()))["rod.second_xx"]
    0.6
    """
    links = [ten_of(link.inertia.pseudo) for link in heavy(tree) if link.inertia is not None]
    joints = [getattr(joint, name) for joint in turning(tree) for name in JOINT_NUMBERS]
    return np.concatenate([*links, np.array(joints, dtype=None if joints else float)])


def with_parameters(tree: Tree, parameters: Sequence[Any] | np.ndarray) -> Tree:
    """The tree with other parameters, in the order of :func:`parameter_names`.

    Raises
    ------
    InputError
        For another number of parameters, and for an inertia that no body can have.
    """
    values, count = np.asarray(parameters), len(parameter_names(tree))
    if values.shape != (count,):
        raise InputError(
            f"with_parameters: parameters has the shape {values.shape}; expected ({count},), the order of "
            "parameter_names(tree)"
        )
    first, names = 10 * len(heavy(tree)), [joint.name for joint in turning(tree)]
    tens = dict(zip((link.name for link in heavy(tree)), values[:first].reshape(-1, 10), strict=True))
    threes = dict(zip(names, values[first:].reshape(-1, 3).tolist(), strict=True))
    return replace(tree, links=tuple(_changed(link, tens, threes) for link in tree.links))


def _changed(link: Link, tens: dict[str, np.ndarray], threes: dict[str, list[Any]]) -> Link:
    """A link with other parameters."""
    joint, inertia = link.joint, link.inertia
    if joint.name in threes:
        joint = replace(joint, **dict(zip(JOINT_NUMBERS, threes[joint.name], strict=True)))
    if link.name in tens:
        own = tens[link.name]
        if not np.real(own[0]) > 0.0:
            raise InputError(f"link {link.name!r}: the mass is {own[0]:.6g} kg; expected a positive one")
        try:
            inertia = Inertia.of_pseudo(pseudo_of(own))
        except InputError as error:
            raise InputError(f"link {link.name!r}: {error}") from None
    return replace(link, joint=joint, inertia=inertia)
