"""Text files as instruments write them: each form gives the same measurements."""

import gzip
import json

import numpy as np
import pytest

from dalembert.data import read, read_bands
from dalembert.data.text_numbers import HEAD
from dalembert.errors import DataError

TIMES = [0.0, 0.5, 1.0, 1.5]
ANGLE = [10.25, -0.5, 3.0, 12.0]
CURRENT = [1.0, 2.5, -1.0, 0.0]
ROWS = list(zip(TIMES, CURRENT, ANGLE, strict=True))


def text(separator: str, *above: str, comma: bool = False, end: str = "") -> str:
    lines = [separator.join(map(repr, row)) + end for row in ROWS]
    lines = [line.replace(".", ",") for line in lines] if comma else lines
    return "\n".join([*above, *lines]) + "\n"


FORMS = {
    "commas": (text(",", "t,i,a"), "cells separated by commas, names in line 1"),
    "commas and blanks": (text(", ", "t, i, a"), "cells separated by commas, names in line 1"),
    "semicolons": (text(";", "t;i;a"), "cells separated by semicolons, names in line 1"),
    "semicolons and decimal commas": (
        text(";", "t;i;a", comma=True),
        "cells separated by semicolons, decimal commas, names in line 1",
    ),
    "tabs": (text("\t", "t\ti\ta"), "cells separated by tabs, names in line 1"),
    "tabs and decimal commas": (
        text("\t", "t\ti\ta", comma=True),
        "cells separated by tabs, decimal commas, names in line 1",
    ),
    "blanks": (text("   ", "t  i  a"), "cells separated by blanks, names in line 1"),
    "blanks and decimal commas": (
        text("  ", "t  i  a", comma=True),
        "cells separated by blanks, decimal commas, names in line 1",
    ),
    "comments": (
        text(",", "% rig 7", "# run 3, by hand", "t,i,a"),
        "cells separated by commas, names in line 3",
    ),
    "comments among the numbers": (
        text(",", "t,i,a").replace("0.5,", "# a pause\n0.5,"),
        "cells separated by commas, names in line 1",
    ),
    "a header with a percent sign": (text("\t", "% rig 7", "% t\ti\ta"), "cells separated by tabs, names in line 2"),
    "a header with a hash": (text(" ", "# t i a"), "cells separated by blanks, names in line 1"),
    "a header with a hash, in other marks": (text(",", "#t i a"), "cells separated by commas, names in line 1"),
    "a title": (text(";", "Rig 7;run 3;", "t;i;a"), "cells separated by semicolons, names in line 2"),
    "units": (text(",", "t,i,a", "s,A,rad"), "cells separated by commas, names in line 1, units in line 2"),
    "units in brackets": (
        text(";", "t;i;a", "[s];[A];[-]"),
        "cells separated by semicolons, names in line 1, units in line 2",
    ),
    "units in a comment": (
        text(" ", "# t i a", "# s A rad"),
        "cells separated by blanks, names in line 1, units in line 2",
    ),
    "a separator at the end of each line": (
        text(";", "t;i;a;", end=";"),
        "cells separated by semicolons, names in line 1",
    ),
    "a separator at the end of the numbers alone": (
        text(";", "t;i;a", end=";"),
        "cells separated by semicolons, names in line 1",
    ),
    "a title of words above a header with a hash": (
        text(",", "Instrument XY 200", "# t,i,a", "# s,A,rad"),
        "cells separated by commas, names in line 2, units in line 3",
    ),
    "a comment as wide as the header below it": (
        text(",", "t,i,a", "# one, two, three"),
        "cells separated by commas, names in line 1",
    ),
    "a title of words and numbers": (
        text(" ", "Serial: 1234, firmware 1.2", "t i a"),
        "cells separated by blanks, names in line 2",
    ),
    "a header of settings": (
        text(";", "Version;2;", "Mark;Comma;", "***", "t;i;a"),
        "cells separated by semicolons, names in line 4",
    ),
    "the first line of a spreadsheet": (text(";", "sep=;", "t;i;a"), "cells separated by semicolons, names in line 2"),
    "quotes": (text(",", '"t","i","a"'), "cells separated by commas, names in line 1"),
    "lines of Windows": (text(",", "t,i,a").replace("\n", "\r\n"), "cells separated by commas, names in line 1"),
    "blank lines": (text(",", "t,i,a", "").replace("\n1.0,", "\n\n1.0,"), "cells separated by commas, names in line 1"),
}


@pytest.mark.parametrize("form", FORMS)
def test_each_form_gives_the_same_measurements(form, tmp_path):
    content, said = FORMS[form]
    (tmp_path / "run.txt").write_text(content)
    data = read(tmp_path / "run.txt", columns={"bar.angle": "a", "motor": "i"})
    assert data.coordinate.values.tolist() == TIMES
    np.testing.assert_array_equal(data.values, np.column_stack([ANGLE, CURRENT]))
    assert data.origin == f"{tmp_path / 'run.txt'}: {said}"


@pytest.mark.parametrize("separator", [",", ";", "\t", "  "])
def test_columns_of_a_file_without_a_header_have_numbers(separator, tmp_path):
    (tmp_path / "run.dat").write_text(text(separator))
    data = read(tmp_path / "run.dat", columns={"bar.angle": 3, "motor": "2"})
    assert data.coordinate.values.tolist() == TIMES
    np.testing.assert_array_equal(data.values, np.column_stack([ANGLE, CURRENT]))
    assert data.origin.endswith("no header")
    reversed_ = read(tmp_path / "run.dat", time=1, columns={"bar.angle": 3})
    np.testing.assert_array_equal(reversed_.values[:, 0], ANGLE)
    assert read(tmp_path / "run.dat").channels == ("2", "3")


def test_a_header_with_fewer_names_names_the_first_columns(tmp_path):
    (tmp_path / "run.txt").write_text(text("\t", "t\ti"))
    data = read(tmp_path / "run.txt", columns={"bar.angle": 3, "motor": "i"})
    np.testing.assert_array_equal(data.values, np.column_stack([ANGLE, CURRENT]))


def test_columns_of_a_file_with_a_header_have_numbers_too(tmp_path):
    (tmp_path / "run.txt").write_text(text(",", "t,a,a"))
    np.testing.assert_array_equal(read(tmp_path / "run.txt", columns={"bar.angle": 3}).values[:, 0], ANGLE)


@pytest.mark.parametrize(
    "content",
    [
        text(",", "t,i,a", "ms,A,deg"),
        text(",", "t,i,a", "[ms],[A],[deg]"),
        text(" ", "# t i a", "# ms A deg"),
        text(",", "Instrument XY 200", "# t,i,a", "# ms,A,deg"),
    ],
)
def test_a_line_of_units_counts(content, tmp_path):
    (tmp_path / "run.txt").write_text(content)
    data = read(tmp_path / "run.txt", columns={"bar.angle": "a"})
    np.testing.assert_allclose(data.coordinate.values, 1e-3 * np.array(TIMES))
    np.testing.assert_allclose(data.values[:, 0], np.deg2rad(ANGLE))
    given = read(tmp_path / "run.txt", columns={"bar.angle": "a"}, units={"a": "rad"})
    np.testing.assert_allclose(given.values[:, 0], ANGLE)


@pytest.mark.parametrize("brackets", ["[]", "()"])
def test_units_behind_names_count(brackets, tmp_path):
    left, right = brackets
    time, angle = f"time {left}ms{right}", f"angle {left}deg{right}"
    (tmp_path / "run.txt").write_text(text(";", f"{time};motor current;{angle}"))
    data = read(tmp_path / "run.txt", time=time, columns={"bar.angle": angle})
    np.testing.assert_allclose(data.coordinate.values, 1e-3 * np.array(TIMES))
    np.testing.assert_allclose(data.values[:, 0], np.deg2rad(ANGLE))
    assert data.origin.endswith("names in line 1, units behind names")


def test_brackets_without_a_unit_are_part_of_the_name(tmp_path):
    (tmp_path / "run.txt").write_text(text(";", "t;i;angle (filtered)"))
    data = read(tmp_path / "run.txt", columns={"bar.angle": "angle (filtered)"})
    np.testing.assert_array_equal(data.values[:, 0], ANGLE)


@pytest.mark.parametrize("encoding", ["utf-8", "utf-8-sig", "utf-16", "cp1252"])
def test_usual_encodings_are_read(encoding, tmp_path):
    content = text(";", "t;Größe;Winkel °")
    (tmp_path / "run.csv").write_bytes(content.encode(encoding))
    data = read(tmp_path / "run.csv", columns={"bar.angle": "Winkel °"})
    np.testing.assert_array_equal(data.values[:, 0], ANGLE)


def test_compressed_files_are_read(tmp_path):
    for name, content in (("run.csv.gz", text(",", "t,i,a")), ("run.json.gz", json.dumps({"t": TIMES, "a": ANGLE}))):
        (tmp_path / name).write_bytes(gzip.compress(content.encode()))
        np.testing.assert_array_equal(read(tmp_path / name, columns={"bar.angle": "a"}).values[:, 0], ANGLE)


@pytest.mark.parametrize(
    "content",
    [
        {"t": TIMES, "i": CURRENT, "a": ANGLE, "rig": 7},
        [dict(zip("tia", row, strict=True)) for row in ROWS],
    ],
)
def test_json_by_name(content, tmp_path):
    (tmp_path / "run.json").write_text(json.dumps(content))
    data = read(tmp_path / "run.json", columns={"bar.angle": "a", "motor": "i"})
    assert data.coordinate.values.tolist() == TIMES
    np.testing.assert_array_equal(data.values, np.column_stack([ANGLE, CURRENT]))


def test_json_by_rows(tmp_path):
    (tmp_path / "run.json").write_text(json.dumps(ROWS))
    data = read(tmp_path / "run.json", columns={"bar.angle": 3, "motor": "2"})
    np.testing.assert_array_equal(data.values, np.column_stack([ANGLE, CURRENT]))


def test_missing_values_of_json(tmp_path):
    (tmp_path / "run.json").write_text(json.dumps({"t": TIMES, "a": [1.0, None, 2.0, 3.0]}))
    data = read(tmp_path / "run.json", missing="leave-out")
    assert data.present.ravel().tolist() == [True, False, True, True]


def test_a_column_of_words_does_not_disturb(tmp_path):
    lines = [f"{t};ok;{a}".replace(".", ",") for t, a in zip(TIMES, ANGLE, strict=True)]
    (tmp_path / "run.csv").write_text("\n".join(["t;state;a", *lines]))
    np.testing.assert_array_equal(read(tmp_path / "run.csv", columns={"bar.angle": "a"}).values[:, 0], ANGLE)


def test_bands_have_the_same_forms(tmp_path):
    (tmp_path / "bands.txt").write_text("t;x_lower;x_upper\n0,0;1,5;2,5\n0,1;1,0;2,0\n")
    assert read_bands(tmp_path / "bands.txt").upper.tolist() == [[2.5], [2.0]]


def test_a_long_file_is_read_as_its_lines_are(tmp_path):
    rows = [f"{row}.5;{row % 7},25" for row in range(HEAD + 10)]
    plain = [row.replace(".5", ",5") for row in rows]
    for name, given in {"plain": plain, "gap": [*plain[:-1], f"{HEAD + 9},5;"]}.items():
        (tmp_path / name).with_suffix(".csv").write_text("\n".join(["t;x", *given]))
    data = read(tmp_path / "plain.csv")
    assert data.coordinate.values[[0, -1]].tolist() == [0.5, HEAD + 9.5]
    assert data.values[:8, 0].tolist() == [0.25, 1.25, 2.25, 3.25, 4.25, 5.25, 6.25, 0.25]
    assert np.isnan(read(tmp_path / "gap.csv", missing="leave-out").values[-1, 0])


def test_a_time_that_goes_back_late_in_a_long_file_has_its_line(tmp_path):
    rows = [f"{row},1" for row in range(HEAD + 10)]
    rows[HEAD + 5] = "3,1"
    (tmp_path / "back.csv").write_text("\n".join(["# rig", "t,x", *rows]))
    with pytest.raises(DataError, match=f"line {HEAD + 8}, column 't': 3 comes after {HEAD + 4}"):
        read(tmp_path / "back.csv")


@pytest.mark.parametrize("cell", ["1_0", "１0"])
@pytest.mark.parametrize("separator", [",", ";"])
def test_a_number_that_only_python_reads_is_refused(cell, separator, tmp_path):
    lines = ["t,x", "0.0,1.0", f"1.0,{cell}", "2.0,3.0", "3.0,4.0"]
    (tmp_path / "run.csv").write_text("\n".join(lines).replace(",", separator) + "\n")
    with pytest.raises(DataError) as caught:
        read(tmp_path / "run.csv")
    assert str(caught.value) == f"{tmp_path / 'run.csv'}, line 3, column 'x': {cell!r} is not a number"


def test_a_column_is_read_for_one_channel(tmp_path):
    (tmp_path / "run.csv").write_text(text(",", "t,i,a"))
    with pytest.raises(DataError, match="column 'a' is given for 2 channels; expected one channel for a column"):
        read(tmp_path / "run.csv", columns={"bar.x": "a", "bar.y": "a"})


@pytest.mark.parametrize(
    ("columns", "sentence"),
    [
        ({"a": "x", "b": 2}, "'x' and '2' are one column; expected one channel for a column"),
        ({"a": "t"}, "column 't' has what the samples lie along; expected another column for a channel"),
        ({"a": 1}, "column '1' has what the samples lie along"),
    ],
)
def test_one_column_is_not_two(columns, sentence, tmp_path):
    (tmp_path / "run.csv").write_text("t,x\n0,1\n1,2\n")
    with pytest.raises(DataError) as caught:
        read(tmp_path / "run.csv", columns=columns)
    assert sentence in str(caught.value)
