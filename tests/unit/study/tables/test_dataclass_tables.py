"""Tables made from dataclasses: keys, units, places, signals and defaults come from the constructor."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import InitVar, dataclass, field

import pytest
from pydantic import TypeAdapter, ValidationError

from dalembert.errors import InputError
from dalembert.study.tables.dataclass_tables import any_of, settings_of, table_of
from dalembert.study.text.expressions import Expression
from dalembert.study.text.places import Place


@dataclass(frozen=True)
class Point:
    name: str


@dataclass(frozen=True)
class Ground:
    pass


@dataclass(frozen=True)
class Signal:
    pass


@dataclass(frozen=True)
class Wave(Signal):
    """A wave.

    More about it.
    """

    height: float
    rate: float = field(metadata={"unit": "rad/s"})
    kind: str = "sine"


@dataclass(frozen=True)
class Bar:
    name: str
    length: float | complex = field(metadata={"unit": "m"})
    elements: int
    place: InitVar[Point | tuple[float, float]] = field(default=(0.0, 0.0), metadata={"unit": "m"})
    velocity: tuple[float, float] = field(default=(0.0, 0.0), metadata={"unit": "m/s"})
    points: Mapping[str, tuple[float, float]] = field(default_factory=dict, metadata={"unit": "m"})
    free: float | None = field(default=None, metadata={"unit": "m"})
    knots: Sequence[float] = ()
    groups: tuple[int, int] | None = None
    inertia: float | tuple[float, float] = 0.9
    law: str = "linear"


@dataclass(frozen=True)
class Push:
    name: str
    at: Point | Ground
    force: float | Signal = field(metadata={"unit": "N"})
    function: Callable[[float], float] | None = None
    against: Point | Ground | None = None


BAR = table_of(Bar)
PUSH = table_of(Push, signal=any_of([table_of(Wave)]))
EITHER = TypeAdapter(any_of([BAR, PUSH]))


def test_every_kind_of_key():
    bar = EITHER.validate_python(
        {
            "kind": "Bar",
            "name": "OA",
            "length": "400 mm",
            "elements": 2,
            "place": "ground(1, 2)",
            "velocity": [0, "36 km/h"],
            "points": {"tip": [1, "2 mm"]},
            "free": "1 cm",
            "knots": [1, 2],
            "groups": [3, 4],
            "inertia": [0.8, 0.1],
        }
    )
    assert bar.given() == {
        "name": "OA",
        "length": 0.4,
        "elements": 2,
        "place": Place(position=(1.0, 2.0)),
        "velocity": [0.0, 10.0],
        "points": {"tip": [1.0, 0.002]},
        "free": 0.01,
        "knots": [1.0, 2.0],
        "groups": [3, 4],
        "inertia": [0.8, 0.1],
    }


def test_keys_that_are_not_given_are_left_to_the_dataclass():
    bar = BAR.model_validate({"kind": "Bar", "name": "OA", "length": 1.0, "elements": 1})
    assert set(bar.given()) == {"name", "length", "elements"}
    assert bar.settings().inertia == 0.9


def test_lists_become_tuples():
    given = {"kind": "Bar", "name": "OA", "length": 1.0, "elements": 1, "groups": [3, 4], "inertia": 0.5}
    bar = BAR.model_validate(given).settings()
    assert (bar.groups, bar.inertia) == ((3, 4), 0.5)


def test_a_number_may_be_a_signal_or_an_expression():
    wave = {"kind": "Wave", "height": "2*F", "rate": "60 rpm", "form": "square"}
    push = EITHER.validate_python({"kind": "Push", "name": "P", "at": "OA.end", "force": wave})
    assert push.force.given() == {
        "height": Expression.of("2*F"),
        "rate": pytest.approx(6.283185307179586),
        "kind": "square",
    }
    plain = EITHER.validate_python({"kind": "Push", "name": "P", "at": "ground", "force": "-F"})
    assert (plain.force, plain.at) == (Expression.of("-F"), Place())


@pytest.mark.parametrize(
    ("change", "where", "message"),
    [
        ({"length": "3 kg"}, ("Bar", "length"), "'3 kg' was given; expected a length such as '400 mm' or 0.4 in m"),
        ({"place": "ground"}, ("Bar", "place"), "'ground' was given; expected a point such as 'OA.end', "),
        (
            {"velocity": [0, "1 m"]},
            ("Bar", "velocity", 1),
            "'1 m' was given; expected a speed such as '36 km/h' or 10 in",
        ),
        (
            {"name": "O.A"},
            ("Bar", "name"),
            "'O.A' was given; expected a name of letters, digits, _ and -, a letter first",
        ),
        ({"elements": 2.0}, ("Bar", "elements"), "Input should be a valid integer"),
    ],
)
def test_a_wrong_value_is_placed(change, where, message):
    given = {"kind": "Bar", "name": "OA", "length": 1.0, "elements": 1} | change
    with pytest.raises(ValidationError) as caught:
        EITHER.validate_python(given)
    (error,) = caught.value.errors()
    assert error["loc"] == where
    assert error["msg"].startswith(message)


def test_the_schema_tells_units_and_kinds():
    schema = EITHER.json_schema()
    assert schema["discriminator"]["mapping"].keys() == {"Bar", "Push"}
    assert schema["$defs"]["Bar"]["properties"]["length"]["description"] == "a length such as '400 mm' or 0.4 in m"
    assert schema["$defs"]["Bar"]["required"] == ["kind", "name", "length", "elements"]
    assert schema["$defs"]["Wave"]["description"] == "A wave."


def test_the_default_kind_need_not_be_named():
    adapter = TypeAdapter(any_of([table_of(Wave, default=True)], "Wave"))
    assert adapter.validate_python({"height": 1, "rate": 2}).settings() == Wave(1.0, 2.0)


@dataclass(frozen=True)
class Coarse:
    points: int = 3

    def __post_init__(self) -> None:
        if self.points < 2:
            raise InputError(f"Coarse: points is {self.points}; expected at least 2")


@dataclass(frozen=True)
class Fine:
    knots: tuple[float, ...] = ()


@dataclass(frozen=True)
class Method:
    grid: Coarse | Fine = Fine()
    pair: tuple[int, int] = (1, 2)


GRID = settings_of({"coarse": Coarse, "fine": Fine})
METHOD = TypeAdapter(settings_of({"method": Method}, {"Coarse": GRID}.get))


@pytest.mark.parametrize(
    ("given", "settings"),
    [
        ("method", Method()),
        ({"kind": "method", "grid": "coarse"}, Method(Coarse())),
        (
            {"kind": "method", "grid": {"kind": "fine", "knots": [1, "1/2"]}, "pair": [3, 4]},
            Method(Fine((1.0, 0.5)), (3, 4)),
        ),
    ],
)
def test_settings_are_a_name_or_a_table_and_hold_others(given, settings):
    assert METHOD.validate_python(given).settings() == settings


def test_settings_that_cannot_be_are_refused_where_they_stand():
    with pytest.raises(ValidationError) as caught:
        METHOD.validate_python({"kind": "method", "grid": {"kind": "coarse", "points": 1}})
    (error,) = caught.value.errors()
    assert [step for step in error["loc"] if step in ("method", "grid")] == ["grid"]
    assert error["msg"] == "Coarse: points is 1; expected at least 2"


def test_the_schema_of_settings_tells_names_and_tables():
    schema = METHOD.json_schema()
    assert {"coarse", "fine", "method"} <= schema["$defs"].keys()
    assert {"enum": ["coarse", "fine"], "type": "string"} in schema["$defs"]["method"]["properties"]["grid"]["oneOf"]


@dataclass(frozen=True)
class Law:
    viscous: float = field(default=0.0, metadata={"unit": "N*m*s"})


@dataclass(frozen=True)
class Slide:
    name: str
    law: Law | None = None
    other: float = field(default=0.0, metadata={"unit": "m", "table": "Rows"})
    marks: Mapping[str, tuple[float, float] | Law] = field(default_factory=dict, metadata={"unit": "m"})


def part(name: str) -> object:
    match name:
        case "Law":
            return table_of(Law, default=True, units={"N*m*s": "N*s/m"}, prefix="Sliding")
        case "Rows":
            return list[list[int]]
    return None


SLIDE = table_of(Slide, part=part)


def test_parts_have_tables_by_their_type_or_by_the_name_in_the_metadata():
    given = {"kind": "Slide", "name": "s", "law": {"viscous": "2 N*s/mm"}, "other": [[1], [2]]}
    slide = SLIDE.model_validate({**given, "marks": {"a": [1, "2 mm"], "b": {"viscous": 3}}})
    assert slide.law.given() == {"viscous": 2000.0}
    assert slide.other == [[1], [2]]
    assert slide.marks["a"] == [1.0, 0.002]
    assert slide.marks["b"].settings() == Law(3.0)
    assert {"Slide", "SlidingLaw"} <= {SLIDE.__name__, *SLIDE.model_json_schema()["$defs"]}


def test_units_of_a_part_may_differ():
    with pytest.raises(ValidationError, match="'2 N\\*m\\*s' was given; expected a damping coefficient such as"):
        SLIDE.model_validate({"kind": "Slide", "name": "s", "law": {"viscous": "2 N*m*s"}})
