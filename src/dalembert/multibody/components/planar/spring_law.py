"""Kinds of springs with dampers in the plane."""

from collections.abc import Callable
from typing import Any

from dalembert.multibody.components.planar.pairs import pair_kind
from dalembert.multibody.components.spring_law import NUMBERS, law_functions
from dalembert.multibody.kernels.kind import Kind


def spring_kind(name: str, stretch: Callable[..., Any], residual: Callable[..., Any], **properties: Any) -> Kind:
    """Kind of a spring, from ``stretch(x, v, p, m)``, which returns elongation and rate, and its residual."""
    energy, observe = law_functions(stretch)
    return pair_kind(
        name,
        NUMBERS,
        residual=residual,
        energy=energy,
        outputs=(("elongation", "m"), ("force", "N")),
        observe=observe,
        dissipates="damping",
        holds=True,
        **properties,
    )
