import pint
import pytest

from dalembert.decimal_units import SINGLE, decimal_unit, in_si
from dalembert.units import KNOWN, _tidy

REGISTRY = pint.UnitRegistry()
COMPOUND = [
    *(unit for unit in KNOWN if unit != "Hz"),
    *("N/mm", "kN*m", "g/cm^3", "g/cm**3", "1/ms", "kg * cm^2", "N·m", "N*mm*s/rad", "m/s/s", "J / kg", "MPa*mm^2"),
    *("mrad/s", "m^-1", "s^+2", "1 / m^3"),
]


@pytest.mark.parametrize("text", [*SINGLE, *COMPOUND])
def test_units_are_those_of_pint(text: str) -> None:
    theirs = REGISTRY.Quantity(1.0, text.replace("·", "*")).to_base_units()
    exponents = dict(theirs.unit_items())
    found = decimal_unit(text)
    assert found is not None
    assert 10.0 ** found[0] == pytest.approx(theirs.magnitude, rel=1e-14)
    assert found[1] == tuple(exponents.pop(name, 0) for name in ("kilogram", "meter", "second", "radian"))
    assert not exponents


@pytest.mark.parametrize("unit", ["mm", "g", "GPa", "g/cm^3"])
@pytest.mark.parametrize("number", ["400", "-3.5e2", "7.85", ".1", "1e-300", "20."])
def test_numbers_are_the_tidy_ones_of_pint(number: str, unit: str) -> None:
    assert in_si(number, unit, None) == _tidy(REGISTRY.Quantity(float(number), unit).to_base_units().magnitude)


@pytest.mark.parametrize(
    "text",
    ["deg", "rpm", "Hz", "%", "min", "m**9**9", "mm mm", "(m)", "m/", "/s", "m**99", "kkg", "°C", "2 m", "m^", "m^2^2"],
)
def test_other_units_are_left_to_pint(text: str) -> None:
    assert decimal_unit(text) is None
    assert in_si("1", text, None) is None


def test_a_number_in_another_kind_of_unit_is_left_to_pint() -> None:
    assert in_si("1", "mm", "s") is None
    assert in_si("1", "N*m", "N*m/rad") is None
    assert in_si("1", "m", "mm") is None
