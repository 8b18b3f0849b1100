"""Kinds of springs with dampers in the plane."""

from collections.abc import Callable
from typing import Any

from dalembert.multibody.components.laws.spring_law import NUMBERS, law_functions
from dalembert.multibody.components.planar.pairs import pair_kind
from dalembert.multibody.kernels.kind import Kind


def spring_kind(name: str, stretch: Callable[..., Any], residual: Callable[..., Any], **properties: Any) -> Kind:
    """Kind of a spring, from ``stretch(x, v, p, m)``, which returns elongation and rate, and its residual."""
    energy, observe = law_functions(stretch)
    law: dict[str, Any] = {"residual": residual, "energy": energy, "observe": observe}
    common: dict[str, Any] = {"outputs": (("elongation", "m"), ("force", "N")), "dissipates": "damping", "holds": True}
    return pair_kind(name, NUMBERS, **common | law | properties)
