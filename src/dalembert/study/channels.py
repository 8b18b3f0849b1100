"""The channels of a study's mechanism, grouped for people."""

from collections.abc import Iterable, Iterator
from itertools import groupby

from dalembert.study.tables.study import Study


def channel_lines(study: Study) -> Iterator[str]:
    """Yield lines on the channels of a study's mechanism, a body, joint or load each; none for another model."""
    if study.has_system:
        from dalembert.multibody.model.observe import channel_names

        yield from grouped(channel_names(study.system()))


def channel_units(study: Study) -> dict[str, str]:
    """Return the channels of a study's mechanism with their SI units; none for another model."""
    if not study.has_system:
        return {}
    from dalembert.multibody.model.observe import channel_units as units

    return units(study.system())


def grouped(names: Iterable[str]) -> Iterator[str]:
    """Yield lines on channels, one for each group of points or components with the same quantities.
    >>> print(*grouped(["OA.start.x", "OA.start.y", "OA.end.x", "OA.end.y", "A.gap", "system.energy"]), sep="\\n")
    6 channels, NAME.QUANTITY:
      OA.start, OA.end: x, y
      A: gap
      system: energy
    """
    names = list(names)
    quantities: dict[str, list[str]] = {}
    for name in names:
        owner, _, quantity = name.rpartition(".")
        quantities.setdefault(owner, []).append(quantity)
    yield f"{len(names)} channels, NAME.QUANTITY:"
    for (_, quantities_here), owners in groupby(
        quantities, key=lambda owner: (owner.partition(".")[0], quantities[owner])
    ):
        yield f"  {', '.join(owners)}: {', '.join(quantities_here)}"
