"""Tables of the study file made from dataclasses, so that a new component, signal, solver or method has one by itself.

The arguments of a dataclass's constructor become keys. ``field(metadata={"unit": "m"})`` makes a key a number with that
unit, which an expression of parameters may give.
"""

import dataclasses
import inspect
import types
import typing
from abc import ABC, abstractmethod
from collections.abc import Callable, Iterable, Mapping
from functools import reduce
from operator import or_
from types import MappingProxyType
from typing import Annotated, Any, ClassVar, Literal

from pydantic import (
    AfterValidator,
    Discriminator,
    Field,
    GetCoreSchemaHandler,
    GetJsonSchemaHandler,
    Tag,
    ValidationInfo,
    create_model,
)
from pydantic_core import CoreSchema, core_schema

from dalembert.study.text.docstrings import explained, meanings
from dalembert.study.text.functions import FunctionName
from dalembert.study.text.numbers import fixed, number
from dalembert.study.text.places import JOINT_KEY
from dalembert.study.text.places import place as planar_place
from dalembert.study.text.table import Context, Name, StudyTable, alternative, checked, problem

FORM = "form"  # the key for an argument that is called kind, since the key kind names the dataclass
_PLACES = {"Point", "GroundPoint", "Ground"}
_NONE = type(None)


class KindTable(StudyTable):
    """A table made from a dataclass, and the dataclass that it is for."""

    target_type: ClassVar[type]  # no dataclass has an argument of this name

    def given(self) -> dict[str, Any]:
        """The arguments that the study file gives; the dataclass has defaults for the others."""
        names = [name for name in type(self).model_fields if name in self.model_fields_set and name != "kind"]
        return {"kind" if name == FORM else name: getattr(self, name) for name in names}

    def settings(self) -> Any:
        """The dataclass itself, where no number depends on parameters."""
        return checked(lambda: self.target_type(**{name: _settled(value) for name, value in self.given().items()}))


class Written(ABC):
    """What a table writes of an object that Python makes by other functions than its constructor."""

    @property
    @abstractmethod
    def value(self) -> Any:
        """The object."""


def table_of(
    target: type,
    kind: str = "",
    *,
    signal: Any = None,
    default: bool = False,
    varying: bool = True,
    part: Callable[[str], Any] = lambda name: None,
    place: Callable[[bool], Any] = planar_place,
    units: Mapping[str, str] = MappingProxyType({}),
    prefix: str = "",
) -> type[KindTable]:
    """Table with the constructor's arguments of a dataclass as keys, and ``kind`` to distinguish it from others.

    Parameters
    ----------
    target : dataclass
    kind : str
        The dataclass's name if empty.
    signal : type, optional
        Type of the tables that a key may take where the dataclass takes a signal.
    default : bool
        Whether this kind is meant when none is given.
    varying : bool
        Whether a number may be an expression of parameters.
    part : callable, optional
        From the name of an argument's type, or the metadata ``table`` of its field, to the type of its key, where the
        argument is a dataclass itself; else None.
    place : callable, optional
        Type of a key that takes a point, from whether it takes the ground without a position.
    units : mapping of str to str
        Units in place of those that the fields have.
    prefix : str
        Of the table's name in the schema, where another table has this kind.
    """
    kind = kind or target.__name__
    hints = typing.get_type_hints(target.__init__)
    fields = target.__dataclass_fields__  # dataclasses.fields leaves out the arguments that are no fields
    meanings_here = meanings(target)
    keys: dict[str, Any] = {"kind": (Literal[kind], kind if default else ...)}  # pyright: ignore[reportInvalidTypeForm]
    for name, argument in inspect.signature(target).parameters.items():
        if not fields[name].metadata.get("key", True):  # for Python only
            continue
        unit = fields[name].metadata.get("unit")
        numeric = (number if varying else fixed)(units.get(unit, unit))
        part_table = part(fields[name].metadata.get("table", ""))
        key = part_table or _key(name, _bare(hints[name]), numeric, signal, part, place)
        meaning = explained(meanings_here.get(name, ""))
        keys[FORM if name == "kind" else name] = (key, Field(_default(argument), json_schema_extra=meaning))
    table = create_model(
        prefix + kind, __base__=KindTable, __doc__=(target.__doc__ or kind).strip().split("\n")[0], **keys
    )
    table.target_type = target
    return table


def any_of(tables: Iterable[type[StudyTable]], default: str = "") -> Any:
    """Type of a key that takes one of several tables, selected by ``kind`` or by the default kind."""
    tables = list(tables)
    if not default:
        union = reduce(or_, tables)
        return Annotated[union, Field(discriminator="kind")] if len(tables) > 1 else union
    tagged = [Annotated[table, Tag(typing.get_args(table.model_fields["kind"].annotation)[0])] for table in tables]
    return Annotated[reduce(or_, tagged), Discriminator(lambda value: _kind(value, default))]


def settings_of(
    kinds: Mapping[str, type], part: Callable[[str], Any] = lambda name: None, *, varying: bool = False
) -> Any:
    """Type of a key that takes the settings of one of several kinds: a name, or a table with ``kind`` and settings.

    Parameters
    ----------
    kinds : mapping of str to dataclass
        By the names that a study file gives them.
    part : callable, optional
        As in :func:`table_of`.
    varying : bool
        Whether a number may be an expression of parameters; if not, the settings are checked by building them.
    """
    tables = {name: table_of(target, name, varying=varying, part=part) for name, target in kinds.items()}
    usual = AfterValidator(lambda name: tables[name].model_validate({"kind": name}))
    name = Annotated[Literal[tuple(kinds)], usual]  # pyright: ignore[reportInvalidTypeForm]
    key = alternative(lambda value: isinstance(value, str), name, any_of(tables.values()))
    return key if varying else Annotated[key, AfterValidator(buildable)]


def chosen(
    kinds: Mapping[str, type], more: str, part: Callable[[str], Any] = lambda name: None, *, varying: bool = False
) -> tuple[Any, Any]:
    """Key that takes settings of one of several kinds as :func:`settings_of` does, or none; ``more`` follows names."""
    names = ", ".join(f"'{name}'" for name in kinds)
    return settings_of(kinds, part, varying=varying) | None, Field(None, description=f"{names}, {more}")


def buildable_table(target: type) -> Any:
    """Type of a key that takes the settings of one kind, which need not be named, checked by building them."""
    return Annotated[table_of(target, default=True, varying=False), AfterValidator(buildable)]


def buildable(table: KindTable) -> KindTable:
    """The table itself, once its dataclass has been built from it."""
    table.settings()
    return table


def _kind(value: Any, default: str) -> str:
    return value.get("kind", default) if isinstance(value, dict) else getattr(value, "kind", default)


def _key(
    name: str, hint: Any, numeric: Any, signal: Any, part: Callable[[str], Any], place: Callable[[bool], Any]
) -> Any:
    leaves = _leaves(hint)
    if name == "name":
        return Name if hint is str else hint
    names = {getattr(leaf, "__name__", "") for leaf in leaves}
    if names & _PLACES:
        point = place("Ground" in names)
        return point | None if _NONE in leaves else point
    if "Joint" in names:
        return JOINT_KEY
    if not any(map(_is_mapping, leaves)):
        for part_table in filter(None, map(part, sorted(names))):
            return part_table
    if signal is not None and "Signal" in names:
        return alternative(lambda value: isinstance(value, dict | KindTable), signal, numeric)
    if Callable in leaves:
        return FunctionName
    return _plain(hint, numeric, part)


def _plain(hint: Any, numeric: Any, part: Callable[[str], Any]) -> Any:
    """Type in which TOML gives what a hint takes: numbers with units, lists for tuples, tables for mappings."""
    origin, arguments = typing.get_origin(hint), typing.get_args(hint)
    if hint in (float, complex):
        return numeric
    if origin in (typing.Union, types.UnionType):
        kinds = [argument for argument in arguments if argument not in (_NONE, float, complex)]
        plain = (
            _either([_plain(kind, numeric, part) for kind in kinds], list(map(_is_list, kinds))) if kinds else numeric
        )
        if kinds and {float, complex} & set(arguments):
            plain = alternative(lambda value: isinstance(value, list | KindTable), plain, numeric)
        return plain | None if _NONE in arguments else plain
    if origin is tuple and Ellipsis not in arguments:
        entry = _plain(arguments[0], numeric, part)
        return Annotated[list[entry], Field(min_length=len(arguments), max_length=len(arguments))]
    if _is_mapping(origin):
        return dict[str, _plain(arguments[1], numeric, part)]
    if _is_list(hint):
        entry = _plain(arguments[0], numeric, part)
        return Annotated[list[entry], _OrSeries()] if entry is numeric else list[entry]
    return part(getattr(hint, "__name__", "")) or hint


class _OrSeries:
    """A list of numbers may also be the name of a series of parameters."""

    def __get_pydantic_core_schema__(self, source: Any, handler: GetCoreSchemaHandler) -> CoreSchema:
        def read(value: Any, info: ValidationInfo) -> Any:
            series = info.context.series if isinstance(info.context, Context) else {}
            if isinstance(value, str) and value not in series:
                raise problem(
                    f"{value!r} was given; expected a list of numbers, or the name of a series: a parameter with count"
                )
            return list(series[value]) if isinstance(value, str) else value

        return core_schema.with_info_before_validator_function(read, handler(source))

    def __get_pydantic_json_schema__(self, schema: CoreSchema, handler: GetJsonSchemaHandler) -> dict[str, Any]:
        return {"anyOf": [handler(schema), {"type": "string"}]}


def _either(kinds: list[Any], lists: list[bool]) -> Any:
    """Type of a key that takes one of several types, for example a list or a table."""
    if len(kinds) == 2 and lists == [True, False]:
        return alternative(lambda value: isinstance(value, list), *kinds)
    return reduce(or_, kinds)


def _is_mapping(kind: Any) -> bool:
    return isinstance(kind, type) and issubclass(kind, Mapping)


def _is_list(hint: Any) -> bool:
    origin = typing.get_origin(hint)
    return isinstance(origin, type) and issubclass(origin, Iterable) and not _is_mapping(origin)


def _settled(value: Any) -> Any:
    if isinstance(value, KindTable):
        return value.settings()
    return tuple(map(_settled, value)) if isinstance(value, list) else value


def _bare(hint: Any) -> Any:
    return hint.type if isinstance(hint, dataclasses.InitVar) else hint


def _leaves(hint: Any) -> set[Any]:
    """Types that a hint is made of, without their arrangement.

    >>> sorted(leaf.__name__ for leaf in _leaves(tuple[float, int]))
    ['float', 'int', 'tuple']
    """
    origin = typing.get_origin(hint)
    if origin is None or origin is Literal:
        return {hint}
    parts = [part for part in typing.get_args(hint) if part is not Ellipsis and not isinstance(part, list)]
    return {origin}.union(*map(_leaves, parts))


def _default(argument: inspect.Parameter) -> Any:
    """Default of a key: the argument's where JSON can hold it, else none, since it is the dataclass's to give."""
    if argument.default is inspect.Parameter.empty:
        return ...
    return argument.default if isinstance(argument.default, (int, float, str)) else None
