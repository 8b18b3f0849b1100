"""The tables of a study file that describe a structure and what acts on it."""

from functools import cache
from typing import Annotated, Any, Literal

from pydantic import Field

from dalembert.errors import repeated, unknown
from dalembert.structure.read_structure import ROLES
from dalembert.study.tables.catalogue import dampings, laws, structure_parts
from dalembert.study.tables.data_table import DataFile
from dalembert.study.tables.dataclass_tables import any_of, chosen, settings_of, table_of
from dalembert.study.text.functions import FunctionName
from dalembert.study.text.numbers import number
from dalembert.study.text.table import Read, StudyTable, alternative, completed, problem

SYNCHRONOUS = "synchronous"
PARTS = ("mass", "spring", "rotor", "force", "contact")


class ReductionTable(StudyTable):
    """Reduction by Craig and Bampton."""

    modes: int = Field(50, ge=0, description="with held masters")
    masters: list[str] = Field(
        [], description="kept beside those with forces, contacts and springs, and those whose motion is watched"
    )


class StructureTable(StudyTable):
    """Where the matrices of a structure come from, what holds it, and its damping."""

    file: DataFile | None = Field(None, description="with all its matrices, as another program wrote it")
    files: dict[str, DataFile] | None = Field(None, description="one for each matrix: { mass = 'm.mtx', ... }")
    names: dict[str, str] = Field({}, description="of the matrices in the file: { mass = 'MXX' }")
    dofs: list[str] | None = Field(None, description="names of the rows, where the file has none")
    directions: list[str] = Field(["x"], description="of each node, where neither has any")
    function: FunctionName | None = Field(None, description="a Python function that returns a Structure")
    arguments: dict[str, Any] = Field({}, description="of the function")
    sets: dict[str, list[str]] = Field({}, description="named lists of nodes: { feet = ['12', '13'] }")
    fixed: list[str] = Field([], description="degrees of freedom, nodes or sets that are clamped")
    damping: Any = None
    loss_factor: Annotated[Any, Read(number(""))] | None = Field(
        None, description="of the matrices: hysteretic damping D = loss_factor K"
    )
    reduction: ReductionTable | None = Field(None, description="to few coordinates, by Craig and Bampton")

    @property
    def source(self) -> bool:
        """Whether the matrices come from here."""
        return any(source is not None for source in (self.file, self.files, self.function))

    def _wrong(self) -> list[str]:
        stated = [key for key in ("file", "files", "function") if getattr(self, key) is not None]
        if len(stated) > 1:
            raise problem(f"{' and '.join(stated)} are given; expected one of them")
        wrong = [unknown("matrix", name, ROLES, key) for key in ("files", "names") for name in getattr(self, key) or {}
                 if name not in ROLES]  # fmt: skip
        if self.files is not None and not {"mass", "stiffness"} <= set(self.files):
            wrong.append("files: expected one for the mass and one for the stiffness")
        if self.arguments and self.function is None:
            wrong.append("arguments are for a function, and there is none")
        if not stated:
            if self.loss_factor is not None:
                wrong.append("loss_factor: there are no matrices here for it; give springs a loss_factor each")
            wrong += [
                f"{key}: there are no matrices here for it; give file, files or function"
                for key in ("names", "dofs", "sets", "fixed", "reduction")
                if getattr(self, key)
            ]
        return wrong


def rotor_speed() -> Any:
    """Type of the key of a rotor's speed: rad/s, or the word for that of the excitation."""
    return alternative(lambda value: value == SYNCHRONOUS, Literal["synchronous"], number("rad/s"))


@cache
def structure_table() -> Any:
    """The table with all kinds of damping that there are."""
    return completed(StructureTable, damping=chosen(dampings(), "with settings", varying=True))


@cache
def part_tables() -> dict[str, Any]:
    """Types of the lists of masses, springs, forces and contacts, by the names of their tables."""
    law = settings_of(laws(), varying=True)
    law_table = dict.fromkeys(laws(), law).get
    result = {}
    for name, (first, *more) in structure_parts().items():
        tables = [table_of(first, default=True, part=law_table), *(table_of(kind, part=law_table) for kind in more)]
        result[name] = list[any_of(tables, first.__name__)]  # pyright: ignore[reportInvalidTypeForm]
    return result


def wrong_structure(model: Any) -> list[str]:
    """Sentences about masses, springs, forces and contacts that do not fit together."""
    named = [part.name for name in ("spring", "contact") for part in getattr(model, name) if hasattr(part, "name")]
    nodes = [mass.name for mass in model.mass]
    wrong = [
        f"{count} {what} are called {name!r}; expected different names"
        for what, names in (("masses", nodes), ("springs and contacts", named))
        for name, count in repeated(names).items()
    ]
    if model.mass and model.structure is not None and model.structure.source:
        wrong.append("[[model.mass]] and the matrices of [model.structure] are both given; expected one of them")
    return wrong
