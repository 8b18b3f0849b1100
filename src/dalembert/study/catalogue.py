"""Which kinds a study file may name: found among the public names of the packages that define them."""

import dataclasses
import inspect
from functools import cache
from typing import Any, get_args

from dalembert.study.components import settings_of
from dalembert.study.structure_parts import LinearSpring, LumpedMass

ROLES = {"Body": "body", "Joint": "joint", "Load": "load", "Signal": "signal", "Integrator": "solver"}


@cache
def catalogue() -> dict[str, tuple[type, ...]]:
    """Public dataclasses of :mod:`dalembert.multibody` by their role: body, joint, load, signal and solver.

    The role is that of the base class: what derives from ``Body`` stands in ``[[model.body]]``.
    """
    from dalembert import multibody

    found: dict[str, list[type]] = {role: [] for role in ROLES.values()}
    for name in dir(multibody):
        kind = getattr(multibody, name)
        if dataclasses.is_dataclass(kind) and isinstance(kind, type) and not inspect.isabstract(kind):
            for role in (ROLES[base.__name__] for base in kind.__mro__[1:] if base.__name__ in ROLES):
                found[role].append(kind)
    return {role: tuple(kinds) for role, kinds in found.items()}


@cache
def structure_parts() -> dict[str, tuple[type, ...]]:
    """What a vibrating structure is made of beside its matrices, by the names of the tables, the usual kind first."""
    from dalembert import vibration
    from dalembert.vibration.system import Element

    return {
        "mass": (LumpedMass,),
        "spring": (LinearSpring, *(kind for kind in get_args(Element) if kind is not vibration.FrictionContact)),
        "force": (vibration.HarmonicForce, vibration.StaticForce),
        "contact": (vibration.FrictionContact,),
    }


@cache
def balance() -> type:
    """Settings of harmonic balance."""
    from dalembert.vibration import HarmonicBalance

    return HarmonicBalance


@cache
def laws() -> dict[str, type]:
    """Laws of friction contacts, by the names that a study file gives them."""
    from dalembert.vibration.contacts import Law

    return {kind.__name__: kind for kind in get_args(Law)}


@cache
def dampings() -> dict[str, type]:
    """Kinds of damping of a structure, by the names that a study file gives them."""
    from dalembert import structure

    return {kind.__name__: kind for kind in (structure.Modal, structure.Rayleigh)}


@cache
def propagation_methods() -> dict[str, type]:
    """Methods that bound a response, by the names that a study file gives them."""
    from dalembert import uncertainty

    return dict(uncertainty.METHODS)


@cache
def schemes() -> dict[str, type]:
    """Schemes of surrogates, by the names that a study file gives them."""
    from dalembert import surrogate

    return {"total-degree": surrogate.TotalDegree, "tensor": surrogate.Tensor, "adaptive": surrogate.Adaptive}


@cache
def swarms() -> dict[str, type]:
    """Particle swarms, by the names that a study file gives them."""
    from dalembert import optimize

    return {"standard-swarm": optimize.ParticleSwarm, "improved-swarm": optimize.ImprovedParticleSwarm}


@cache
def band_methods() -> dict[str, type]:
    """Methods that identify intervals from bands, by the names that a study file gives them."""
    from dalembert import inverse

    return {"global": inverse.GlobalSurrogate, "nested": inverse.Nested}


@cache
def step_minimisers() -> dict[str, type]:
    """Minimisers of a collocation step, by the names that a study file gives them."""
    from dalembert import multibody

    return {"gauss-newton": multibody.GaussNewton, **methods()}


@cache
def stabilisations() -> dict[str, type]:
    """How index-1 methods keep to the constraints, by the names that a study file gives them."""
    from dalembert import multibody

    kinds = (multibody.Augmented, multibody.Baumgarte, multibody.Projection, multibody.Partitioning)
    return {kind.__name__.lower(): kind for kind in kinds}


@cache
def parts() -> dict[str, Any]:
    """Keys for settings that are chosen among several kinds themselves, by the names of their types."""
    scheme, swarm = settings_of(schemes()), settings_of(swarms())
    only = settings_of({"total-degree": schemes()["total-degree"]})
    step = settings_of(step_minimisers())
    stabilisation = settings_of(stabilisations())
    return {
        "Scheme": scheme,
        "TotalDegree": only,
        "ParticleSwarm": swarm,
        "GaussNewton": step,
        "Stabilisation": stabilisation,
    }


@cache
def methods() -> dict[str, type]:
    """Methods of identification by the names that a study file gives them."""
    from dalembert import optimize

    return {
        "least-squares": optimize.LeastSquares,
        "response-sensitivity": optimize.ResponseSensitivity,
        **swarms(),
        "firefly": optimize.Firefly,
        "scipy": optimize.Minimiser,
    }
