"""A mechanism for each kind of component."""

from collections.abc import Callable
from functools import cache

import mechanisms
from dalembert.multibody.kernels.kind import Kind
from dalembert.multibody.model.lowered import Lowered
from dalembert.multibody.model.lowering import lower
from spatial_scenes import SCENES


@cache
def planar() -> Lowered:
    """All components in the plane without functions of users."""
    pieces = [piece for piece in mechanisms.PIECES if not lower(mechanisms.mechanism(piece)).callbacks]
    return lower(mechanisms.mechanism(*pieces))


@cache
def spatial(scene: str) -> Lowered:
    """A scene in space."""
    build, fields = SCENES[scene]
    return lower(build(**fields))


HOMES: dict[Kind, Callable[[], Lowered]] = dict.fromkeys(planar().data, planar)
HOMES |= {kind: lambda scene=scene: spatial(scene) for scene in SCENES for kind in spatial(scene).data}
