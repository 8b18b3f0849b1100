"""Summary of a study for pages; the study itself stays in the process that reads it."""

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from dalembert.errors import DalembertError
from dalembert.parameter import Parameter
from dalembert.parameters import Parameters

if TYPE_CHECKING:
    from dalembert.study.tables.study import Study


@dataclass(frozen=True)
class Outline:
    """A study without its model, which may be slow code of the user's. ``name``: of its runs; ``parts``: what to
    simulate: experiments, or one with an empty name, and the parameters that act on each, also of sensors;
    ``channels``: all of a mechanism, none of another model, or where it cannot be built; ``files``: other files named.
    """

    text: str
    name: str
    task: str
    parameters: Parameters
    parts: Mapping[str, tuple[Parameter, ...]]
    channels: tuple[str, ...]
    files: Mapping[str, Path]

    @classmethod
    def of(cls, study: "Study", text: str) -> "Outline":
        """The outline of a study that was read from a text."""
        from dalembert.studio.simulation.simulated_parts import parameters_of

        name = study.file.study.name or study.name
        return cls(text, name, study.task, study.parameters, parameters_of(study), channels_of(study), study.files)


def channels_of(study: "Study") -> tuple[str, ...]:
    """Return all channels of a study's mechanism; none of another model, or where it cannot be built."""
    if not study.has_system:
        return ()
    from dalembert.multibody.model.observe import channel_names

    try:
        return tuple(channel_names(study.system()))
    except DalembertError:
        return ()
