"""Which kinds a study file may name: those of the packages that define them."""

import sys
from collections.abc import Iterator
from functools import cache, lru_cache
from importlib import import_module
from typing import Annotated, Any, get_args

from pydantic import AfterValidator

from dalembert.component_index import HOMES, KINDS, SPATIAL_HOMES, SPATIAL_KINDS
from dalembert.kinds import derived_dataclasses, distinct, load_modules, load_plugins, named
from dalembert.structure.rotors import Disc, RotatingDamper
from dalembert.study.tables.dataclass_tables import any_of, buildable, settings_of, table_of
from dalembert.study.tables.structure_parts import LinearSpring, LumpedMass

ROLES = {"body": "Body", "joint": "Joint", "load": "Load", "signal": "Signal", "solver": "Integrator"}
"""Base class of the kinds that a table names."""
DEFAULT_SOLVER = "GeneralizedAlpha"  # where a table names no kind


Words = frozenset[str] | None
"""Names that a document uses, so that a schema for it needs no others; None for all that there are."""


@lru_cache(maxsize=64)
def kinds_of(role: str, words: Words = None, *, space: bool = False) -> tuple[type, ...]:
    """Dataclasses of a role, in the order of their names; only those that words name, if given.

    The role is that of the base class: what derives from ``Body`` stands in ``[[model.body]]``. Those of the package
    are in its index; those of others are all that have been imported, or that an entry point names. ``space``: the
    kinds of mechanisms in space, not those in the plane.
    """
    base = ROLES[role]
    package = import_module("dalembert.multibody.spatial" if space else "dalembert.multibody")
    names = (SPATIAL_KINDS if space else KINDS)[base]
    built_in = [getattr(package, name) for name in names if words is None or name in words]
    registered = distinct(kind for kind in _registered(base, space) if words is None or kind.__name__ in words)
    return tuple(sorted([*built_in, *registered.values()], key=lambda kind: kind.__name__))


def kind_names() -> set[str]:
    """Names of all kinds; none of the package is imported for them."""
    load_plugins()
    names: set[str] = set()
    bases: list[type] = []
    for kinds, homes in ((KINDS, HOMES), (SPATIAL_KINDS, SPATIAL_HOMES)):
        names.update(*kinds.values())
        modules = {base: sys.modules.get(f"dalembert.multibody.{homes[base]}") for base in kinds}
        bases += [getattr(module, base) for base, module in modules.items() if module is not None]
    return names | {kind.__name__ for kind in derived_dataclasses(*bases)}


def _registered(base: str, space: bool) -> Iterator[type]:
    load_plugins()
    home = sys.modules.get(f"dalembert.multibody.{(SPATIAL_HOMES if space else HOMES)[base]}")
    kinds = derived_dataclasses(getattr(home, base)) if home is not None else ()  # without it nothing derives from it
    return (kind for kind in kinds if kind.__module__.partition(".")[0] != __name__.partition(".")[0])


@lru_cache(maxsize=16)
def solver(words: Words = None) -> Any:
    """Type of a key that takes any integrator, or one that words name, checked by building it."""
    kinds = kinds_of("solver", None if words is None else words | {DEFAULT_SOLVER})
    tables = [table_of(kind, default=kind.__name__ == DEFAULT_SOLVER, varying=False, part=part) for kind in kinds]
    return Annotated[any_of(tables, DEFAULT_SOLVER), AfterValidator(buildable)]


@cache
def structure_parts() -> dict[str, tuple[type, ...]]:
    """What a vibrating structure is made of beside its matrices, by the names of the tables, the usual kind first."""
    from dalembert import vibration

    load_plugins()
    load_modules("dalembert.vibration.laws")
    laws = sorted(distinct(derived_dataclasses(vibration.LawElement)).values(), key=lambda kind: kind.__name__)
    return {
        "mass": (LumpedMass,),
        "spring": (LinearSpring, *laws, vibration.UserElement),
        "rotor": (Disc, RotatingDamper),
        "force": (
            vibration.HarmonicForce,
            vibration.StaticForce,
            vibration.Unbalance,
            vibration.TabulatedForce,
            vibration.BaseExcitation,
        ),
        "contact": (vibration.FrictionContact,),
    }


def laws() -> dict[str, type]:
    """Laws of friction contacts, by the names that a study file gives them."""
    from dalembert.vibration.laws.contacts import Law

    return {kind.__name__: kind for kind in get_args(Law)}


def dampings() -> dict[str, type]:
    """Kinds of damping of a structure, by the names that a study file gives them."""
    from dalembert import structure

    return {kind.__name__: kind for kind in (structure.Modal, structure.Rayleigh)}


def propagation_methods() -> dict[str, type]:
    """Methods that bound a response, by the names that a study file gives them."""
    from dalembert import uncertainty

    return uncertainty.methods_by_name()


def schemes() -> dict[str, type]:
    """Schemes of surrogates, by the names that a study file gives them."""
    from dalembert import surrogate

    return {"total-degree": surrogate.TotalDegree, "tensor": surrogate.Tensor, "adaptive": surrogate.Adaptive}


def swarms() -> dict[str, type]:
    """Particle swarms, by the names that a study file gives them."""
    from dalembert import optimize

    return named("dalembert.optimize", optimize.Swarm)


def band_methods() -> dict[str, type]:
    """Methods that identify intervals from bands, by the names that a study file gives them."""
    from dalembert import inverse

    return {"global": inverse.GlobalSurrogate, "nested": inverse.Nested}


@cache
def part(name: str) -> Any:
    """Type of the key for settings that are chosen among several kinds themselves, by the name of their type."""
    from dalembert import multibody

    match name:
        case "Scheme":
            return settings_of(schemes())
        case "TotalDegree":
            return settings_of({"total-degree": schemes()["total-degree"]})
        case "ParticleSwarm":
            return settings_of(swarms())
        case "GaussNewton":
            return settings_of({"gauss-newton": multibody.GaussNewton, **methods()})
        case "Stabilisation":
            kinds = (multibody.Augmented, multibody.Baumgarte, multibody.Projection, multibody.Partitioning)
            return settings_of({kind.__name__.lower(): kind for kind in kinds})
    return None


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
