"""Which kinds a study file may name: those of the packages that define them."""

import dataclasses
import inspect
from collections.abc import Iterator
from functools import cache
from importlib.metadata import entry_points
from typing import Any, get_args

from dalembert.component_index import KINDS
from dalembert.study.components import settings_of
from dalembert.study.structure_parts import LinearSpring, LumpedMass

ROLES = {"Body": "body", "Joint": "joint", "Load": "load", "Signal": "signal", "Integrator": "solver"}


COMPONENTS = "dalembert.components"
"""Group of entry points: modules of other packages that define components, signals or integrators."""


@cache
def catalogue() -> dict[str, tuple[type, ...]]:
    """Dataclasses by their role: body, joint, load, signal and solver.

    The role is that of the base class: what derives from ``Body`` stands in ``[[model.body]]``. Those of the package
    are in its index; those of others are all that have been imported, or that an entry point names.
    """
    from dalembert import multibody

    for entry in entry_points(group=COMPONENTS):
        entry.load()
    found = {}
    for base, role in ROLES.items():
        kinds = [*(getattr(multibody, name) for name in KINDS[base]), *_of_others(getattr(multibody, base))]
        found[role] = tuple(sorted(kinds, key=lambda kind: kind.__name__))
    return found


def _of_others(base: type) -> Iterator[type]:
    """Dataclasses of other packages that derive from a base."""
    for kind in base.__subclasses__():
        yield from _of_others(kind)
        foreign = kind.__module__.partition(".")[0] != __name__.partition(".")[0] and not kind.__name__.startswith("_")
        if foreign and dataclasses.is_dataclass(kind) and not inspect.isabstract(kind):
            yield kind


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
