"""Units as engineers spell them: in columns of data, and in quantities."""

import math

import numpy as np
import pytest

from dalembert.data import read
from dalembert.errors import DataError, InputError
from dalembert.unit_table import readings
from dalembert.units import factor_of, si, wrong_kind

DEG, RPM, G_N, LBF = 180 / math.pi, 30 / math.pi, 1 / 9.80665, 1 / 4.4482216152605
# How many of a unit are 1 in SI units.
TIMES = {
    "ms": 1e3, "s": 1, "sec": 1, "secs": 1, "seconds": 1, "Seconds": 1, "msec": 1e3, "milliseconds": 1e3, "us": 1e6,
    "µs": 1e6, "μs": 1e6, "min": 1 / 60, "ns": 1e9, "S": 1, "Sec": 1,
}  # fmt: skip
VALUES = {
    "rad": 1, "deg": DEG, "°": DEG, "º": DEG, "degrees": DEG, "Degree": DEG, "Grad": DEG, "g": G_N, "G": G_N, "m/s^2": 1,
    "m/s2": 1, "m/s²": 1, "m s^-2": 1, "m·s⁻²": 1, "mm/s²": 1e3, "mm": 1e3, "cm": 100, "in": 1 / 0.0254,
    "inch": 1 / 0.0254, "rpm": RPM, "RPM": RPM, "U/min": RPM, "rev/min": RPM, "rad/s": 1, "deg/s": DEG, "°/s": DEG,
    "dps": DEG, "N": 1, "kN": 1e-3, "lbf": LBF, "Pounds": LBF, "Nm": 1, "N·m": 1, "N*m": 1, "N-m": 1, "mNm": 1e3,
    "Nmm": 1e3, "kNm": 1e-3, "V": 1, "Volt": 1, "volts": 1, "mV": 1e3, "mA": 1e3, "A": 1, "px": 1, "counts": 1, "%": 100,
    "-": 1, "1": 1, "µε": 1e6, "um/m": 1e6, "bar": 1e-5, "kg": 1, "mbar": 1e-2,
}  # fmt: skip


@pytest.mark.parametrize("spelling", VALUES)
def test_a_spelling_of_a_columns_unit_is_read(spelling, tmp_path):
    (tmp_path / "run.csv").write_text(f"t;x ({spelling})\n" + "".join(f"{k};{k + 1}\n" for k in range(5)))
    data = read(tmp_path / "run.csv")
    assert data.values[0, 0] == pytest.approx(1 / VALUES[spelling], rel=1e-12)


@pytest.mark.parametrize("spelling", TIMES)
def test_a_spelling_of_the_unit_of_times_is_read(spelling, tmp_path):
    (tmp_path / "run.csv").write_text(f"t ({spelling});x\n" + "".join(f"{k};{k}\n" for k in range(5)))
    data = read(tmp_path / "run.csv", f"t ({spelling})")
    assert data.coordinate.values[1] == pytest.approx(1 / TIMES[spelling], rel=1e-12)


SUFFIXES = {
    "angle_deg": DEG, "Angle.Degrees": DEG, "x mm": 1e3, "x_um": 1e6, "rate_dps": DEG, "speed_RPM": RPM, "force_kN": 1e-3,
    "deg": DEG, "gyro_deg_s": DEG, "gyro rad s": 1, "a_mm_s2": 1e3, "x_cm": 1, "x_m": 1, "v_m_s": 1, "torque_nm": 1, "x_ms": 1, "degree_of_wear": 1,
}  # fmt: skip


@pytest.mark.parametrize("name", SUFFIXES)
def test_a_unit_at_the_end_of_a_name_is_read(name, tmp_path):
    (tmp_path / "run.csv").write_text(f"time_ms;{name}\n" + "".join(f"{k};{k + 1}\n" for k in range(5)))
    data = read(tmp_path / "run.csv", "time_ms")
    assert data.coordinate.values[1] == 1e-3
    assert data.values[0, 0] == pytest.approx(1 / SUFFIXES[name], rel=1e-12)
    assert read(tmp_path / "run.csv", "time_ms", units={name: "rad", "time_ms": "s"}).values[0, 0] == 1.0


def test_a_unit_at_the_end_of_a_name_is_read_for_the_number_of_its_column(tmp_path):
    (tmp_path / "run.csv").write_text("time_ms;angle_deg\n0;180\n1;90\n")
    data = read(tmp_path / "run.csv", 1, {"x": 2})
    assert (data.coordinate.values[1], data.values[0, 0]) == (1e-3, pytest.approx(math.pi))


def test_a_unit_that_the_file_names_comes_before_the_end_of_a_name(tmp_path):
    (tmp_path / "run.csv").write_text("t;angle_deg\ns;rad\n0;1\n1;2\n")
    assert read(tmp_path / "run.csv").values[0, 0] == 1.0


def test_dates_are_seconds_whatever_the_end_of_their_name(tmp_path):
    (tmp_path / "run.csv").write_text("time_ms;x\n12:00:00;1\n12:00:02;2\n")
    assert read(tmp_path / "run.csv", "time_ms").coordinate.values[1] == 2.0
    np.savez(tmp_path / "run.npz", time_ms=np.array(["2024-03-01T12:00:00", "2024-03-01T12:00:02"]), x_mm=np.ones(2))
    data = read(tmp_path / "run.npz", "time_ms")
    assert (data.coordinate.values[1], data.values[0, 0]) == (2.0, 1e-3)


# NIST Special Publication 811 (2008), appendix B.8: exact factors, and others with the digits printed there.
PUBLISHED = {
    "atm": ("Pa", 101325.0), "dyn": ("N", 1e-5), "ft": ("m", 0.3048), "ft*lbf": ("J", 1.355818), "hp": ("W", 745.6999),
    "in": ("m", 0.0254), "kgf": ("N", 9.80665), "kgf*m": ("N*m", 9.80665), "kip": ("N", 4448.222), "km/h": ("m/s", 0.2777778),
    "ksi": ("Pa", 6.894757e6), "kWh": ("J", 3.6e6), "lbf*in": ("N*m", 0.1129848), "lbf/in": ("N/m", 175.1268),
    "lbf/ft": ("N/m", 14.59390), "lb*in^2": ("kg*m^2", 2.926397e-4), "lb*ft^2": ("kg*m^2", 4.214011e-2),
    "lb/ft^3": ("kg/m^3", 16.01846), "lb/in^3": ("kg/m^3", 2.767990e4), "mi": ("m", 1609.344), "mph": ("m/s", 0.44704),
    "mmHg": ("Pa", 133.3224), "oz": ("kg", 2.834952e-2), "ozf*in": ("N*m", 7.061552e-3), "psi": ("Pa", 6894.757),
    "rpm": ("rad/s", 0.1047198), "slug": ("kg", 14.59390), "slug/ft^3": ("kg/m^3", 515.3788), "yd": ("m", 0.9144),
    "gon": ("rad", 1.570796e-2), "deg/s^2": ("rad/s^2", 0.01745329), "arcmin": ("rad", 2.908882e-4), "L": ("m^3", 1e-3),
    "lb": ("kg", 0.45359237), "knot": ("m/s", 0.5144444), "t": ("kg", 1000.0), "day": ("s", 86400.0), "PS": ("W", 735.4988),
}  # fmt: skip


@pytest.mark.parametrize("unit", PUBLISHED)
def test_factors_are_the_published_ones(unit):
    wanted, factor = PUBLISHED[unit]
    assert factor_of(unit.replace("ozf", "oz"), wanted) == pytest.approx(factor, rel=5e-7)


@pytest.mark.parametrize(
    ("unit", "wanted", "factor"),
    [
        *[("g", "kg", 1e-3), ("g", "m/s^2", 9.80665), ("mg", "kg", 1e-6), ("mg", "m/s^2", 9.80665e-3)],
        *[("lb", "N", 4.4482216152605), ("lb", "kg", 0.45359237), ("ft-lb", "N*m", 1.3558179483314004)],
        *[("oz-in", "N*m", 0.0070615518142260435), ("g/cm^3", "kg/m^3", 1000.0), ("gcm2", "kg*m^2", 1e-7)],
        *[("kgm²", "kg*m^2", 1.0), ("Nms/rad", "N*m*s/rad", 1.0), ("N*m/(rad/s)", "N*m*s/rad", 1.0)],
        *[("deg per sec", "rad/s", math.pi / 180), ("mSec", "s", 1e-3), ("KHz", "Hz", 1e3), ("Kg", "kg", 1.0)],
    ],
)
def test_the_expected_kind_decides_between_meanings(unit, wanted, factor):
    assert factor_of(unit, wanted) == pytest.approx(factor, rel=1e-14)


@pytest.mark.parametrize(
    "unit",
    [
        "potato",
        "filtered",
        "mhz",
        "MM",
        "Mpa",
        "NM",
        "kn",
        "U",
        "grad",
        "ton",
        "m^",
        "m**9**9",
        "m m)",
        "(m",
        "m +s",
        "m√kg",
    ],
)
def test_a_doubtful_or_unknown_unit_is_no_unit(unit):
    assert readings(unit) == ()
    with pytest.raises(InputError, match="is unknown"):
        factor_of(unit)


@pytest.mark.parametrize(
    ("given", "unit", "reason"),
    [
        ("5 rad/s", "Hz", "an angular velocity is no frequency: divide it by 2 pi, and write it in Hz"),
        ("60 1/min", "rad/s", "a rate without an angle is no angular velocity: write it in rpm or rad/s"),
        ("3 grad", "rad", "the unit 'grad' is unknown because it has several meanings; write 'deg' or 'gon'"),
    ],
)
def test_a_unit_that_only_looks_right_is_refused_with_its_reason(given, unit, reason):
    with pytest.raises(InputError) as caught:
        si(given, unit)
    assert reason in str(caught.value)


def test_a_temperature_has_an_offset_and_no_factor():
    assert si("20 degC", "K") == 293.15
    assert si("68 °F", "K") == 293.15
    with pytest.raises(InputError, match="has an offset"):
        factor_of("°C")


def test_degrees_keep_their_bits():
    assert si("45 deg", "rad") == math.pi / 4
    assert si("0.1 deg", "rad") == 0.1 * (math.pi / 180)


@pytest.mark.parametrize("words", [("furlong", "mm"), ("Angle", "degg")])
def test_an_unknown_unit_word_is_refused(words, tmp_path):
    (tmp_path / "run.csv").write_text(f"t;x ({words[-1] if words[0] == 'Angle' else words[0]})\n0;1\n1;2\n2;3\n")
    with pytest.raises(DataError, match="is unknown; expected one such as"):
        read(tmp_path / "run.csv")


def test_an_unknown_word_in_a_line_of_units_is_refused(tmp_path):
    (tmp_path / "run.csv").write_text("t;x;y;z\ns;mm;deg;wombats\n0;1;2;3\n1;2;3;4\n2;3;4;5\n")
    assert read(tmp_path / "run.csv", columns={"a.x": "x"}).values[0, 0] == 1e-3
    with pytest.raises(DataError, match="column 'z': the unit 'wombats' is unknown"):
        read(tmp_path / "run.csv", columns={"a.z": "z"})


def test_two_meanings_of_a_measured_unit_are_refused():
    assert wrong_kind("g", "kg") == "the unit 'g' has two meanings; write 'kg', 'lbm', 'N', 'lbf' or 'g_n'"
    assert wrong_kind("g", "m/s^2") == wrong_kind("furlong", "m") == wrong_kind("1", "m") == ""
