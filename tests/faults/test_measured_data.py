"""Defects of measured data: one sentence each that says where and what to do."""

import numpy as np
import pytest

from dalembert.data import Bands, Measurements, read, read_bands
from dalembert.errors import DataError
from dalembert.forward import PythonModel
from dalembert.inverse import identify

FILES = {
    "a column that is missing": (
        "t,case1_x\n0,1\n",
        {"columns": {"x": "case_x"}},
        "{path}: unknown column 'case_x'; did you mean 'case1_x'?",
    ),
    "a time column that is missing": (
        "time,x\n0,1\n",
        {},
        "{path}: unknown column 't'; known: time, x",
    ),
    "a NaN": (
        "t,x\n0,1\n0.1,nan\n",
        {},
        "{path}, line 3, column 'x': nan; expected a finite number; remove the line or the column",
    ),
    "an infinity": (
        "t,x\n0,1\n0.1,-inf\n",
        {},
        "{path}, line 3, column 'x': -inf; expected a finite number; remove the line or the column",
    ),
    "an empty cell": (
        "t,x\n0,1\n0.1,\n",
        {},
        "{path}, line 3, column 'x': the cell is empty; expected a number; fill it or remove the line",
    ),
    "a word": (
        "t,x\n0,1\n0.1,one\n",
        {},
        "{path}, line 3, column 'x': 'one' is not a number",
    ),
    "a time that goes backwards": (
        "t,x\n0,1\n0.2,1\n0.1,1\n",
        {},
        "{path}, line 4, column 't': 0.1 comes after 0.2; expected growing values; "
        "sort the lines or remove the repeated one",
    ),
    "a time that stands still after a blank line": (
        "t,x\n0,1\n\n0,1\n",
        {},
        "{path}, line 4, column 't': 0 comes after 0; expected growing values; "
        "sort the lines or remove the repeated one",
    ),
    "an empty file": (
        "",
        {},
        "{path}: the file holds nothing; expected a line of column names and then lines of numbers",
    ),
    "no lines of numbers": (
        "t,x\n",
        {},
        "{path}: the file holds no line of numbers; expected column names and then lines of numbers",
    ),
    "a short line": (
        "t,x,y\n0,1,2\n0.1,1\n",
        {},
        "{path}, line 3: 2 cells; expected 3, as the header has",
    ),
    "commas where there should be semicolons": (
        "t,angle\n0,1\n",
        {"separator": ";"},
        "{path}: there is no column 't' with the separator or decimal mark that was given; the file seems to have "
        "cells separated by commas, names in line 1; leave separator and decimal out",
    ),
    "decimal commas where there should be points": (
        "t;x\n0,0;1,5\n",
        {"decimal": "."},
        "{path}: there is no column 't' with the separator or decimal mark that was given; the file seems to have "
        "cells separated by semicolons, decimal commas, names in line 1; leave separator and decimal out",
    ),
    "points beside decimal commas": (
        "t;x\n0,0;1.500,5\n",
        {"separator": ";", "decimal": ","},
        "{path}, line 2, column 'x': '1.500,5' is not a number",
    ),
    "thousands beside decimal commas": (
        "t;x\n0,0;1.500\n",
        {"separator": ";", "decimal": ","},
        "{path}, line 2, column 'x': '1.500' is not a number",
    ),
    "one mark for cells and decimals": (
        "t,x\n0,1\n",
        {"decimal": ","},
        "{path}: there is no column 't' with the separator or decimal mark that was given; the file seems to have "
        "cells separated by commas, names in line 1; leave separator and decimal out",
    ),
    "one mark for both": (
        "t,x\n0,1\n",
        {"separator": ",", "decimal": ","},
        "{path}: ',' stands between the cells and before the decimals; give separator the character that stands "
        "between the cells, such as ';'",
    ),
    "no mark of decimals": (
        "t,x\n0,1\n",
        {"decimal": ":"},
        "{path}: decimal is ':'; expected 'auto', '.' or ','",
    ),
    "a number of no column": (
        "t,x\n0,1\n",
        {"columns": {"x": 3}},
        "{path}: there is no column 3; expected a number from 1 to 2",
    ),
    "a word in a file without a header": (
        "0 1\n0.1 2\n0.2 one\n",
        {},
        "{path}, line 3, column '2': 'one' is not a number",
    ),
    "a short line in a file without a header": (
        "0 1 2\n0.1 2\n0.2 3 4\n0.3 4 5\n",
        {},
        "{path}, line 2: 2 cells; expected 3, as most lines have",
    ),
    "units that are none": (
        "t,angle\ns,degrees?\n0,1\n",
        {},
        "{path}: unknown column 't'; known: degrees?, s",
    ),
    "a separator of two characters": (
        "t,x\n0,1\n",
        {"separator": ", "},
        "{path}: separator is ', '; expected 'auto', or one character, such as ';'",
    ),
    "a deviation that is missing": (
        "t,x,y\n0,1,2\n",
        {"deviations": {"x": 0.1}},
        "{path}: no deviation given for channel 'y'; give one for each of x, y",
    ),
}


@pytest.mark.parametrize("defect", FILES)
def test_a_defect_of_a_file_is_told_with_file_line_and_column(defect, tmp_path):
    text, options, sentence = FILES[defect]
    path = tmp_path / "motion.csv"
    path.write_text(text)
    with pytest.raises(DataError) as error:
        read(path, format="csv", **options)
    assert str(error.value) == sentence.format(path=path)


def test_a_file_that_is_not_there_is_answered_with_its_neighbours(tmp_path):
    (tmp_path / "motion.csv").touch()
    with pytest.raises(DataError) as error:
        read(tmp_path / "motions.csv")
    assert str(error.value) == f"folder {tmp_path}: unknown file 'motions.csv'; did you mean 'motion.csv'?"


@pytest.mark.parametrize("content", [b"t,x\n\xff\xfe\x00\x01", b"\xff\xfet\x00,", bytes(range(256))])
def test_a_file_that_is_no_text_is_told(content, tmp_path):
    path = tmp_path / "motion.csv"
    path.write_bytes(content)
    with pytest.raises(DataError) as error:
        read(path, format="csv")
    assert str(error.value) == f"{path}: the file is not text; give its format, or save it as UTF-8 text"


def test_a_damaged_archive_is_told(tmp_path):
    path = tmp_path / "motion.csv.gz"
    path.write_bytes(b"\x1f\x8b broken")
    with pytest.raises(DataError, match="cannot be read as text with columns"):
        read(path)


JSON_FILES = {
    "not JSON": (
        '{"t": [0, 1],\n "x": [1, 2}',
        "{path}, line 2, column 12: the file is not JSON (Expecting ',' delimiter); expected an object of arrays, or "
        "an array of objects or of rows, of numbers",
    ),
    "a number": (
        "3",
        "{path}: the file holds something else than an object of arrays, or an array of objects or of rows, of numbers",
    ),
    "a word": ('{"t": [0, 1], "x": [1, "a"]}', "{path}, column 'x', sample 1: 'a' is not a number"),
    "a short row": ("[[0, 1], [1]]", "{path}, row 2: 1 values; expected 2, as the first row has"),
    "a column that is missing": ('{"time": [0, 1], "x": [1, 2]}', "{path}: unknown column 't'; known: time, x"),
}


@pytest.mark.parametrize("defect", JSON_FILES)
def test_a_defect_of_a_json_file_is_told(defect, tmp_path):
    text, sentence = JSON_FILES[defect]
    path = tmp_path / "motion.json"
    path.write_text(text)
    with pytest.raises(DataError) as error:
        read(path)
    assert str(error.value) == sentence.format(path=path)


def test_a_folder_is_no_file_of_data(tmp_path):
    with pytest.raises(DataError) as error:
        read(tmp_path, format="csv")
    assert str(error.value).startswith(f"{tmp_path}: cannot be read as text with columns (")


BAND_FILES = {
    "columns that are exchanged": (
        "t,x_lower,x_upper\n0,1,2\n0.1,2,1\n",
        {},
        "{path}: channel 'x', sample 1 (time 0.1 s): the lower bound 2 is larger than the upper bound 1; "
        "expected the lower one first; look whether the columns are exchanged",
    ),
    "a column that is missing": (
        "t,x_lower,x_upper\n0,1,2\n",
        {"columns": {"AB.end.x": ("x_lower", "x_uper")}},
        "{path}: unknown column 'x_uper'; did you mean 'x_upper' or 'x_lower'?",
    ),
    "a channel with one column": (
        "t,x_lower,x_upper\n0,1,2\n",
        {"columns": {"AB.end.x": "x_lower"}},
        "columns, channel 'AB.end.x': 'x_lower' was given; expected two names, (lower, upper)",
    ),
    "columns that are no bounds": (
        "t,x,y_lower\n0,1,2\n",
        {},
        "{path}: no two columns are named NAME_lower and NAME_upper; "
        "give columns = {{channel: (lower column, upper column)}}",
    ),
    "an empty cell": (
        "t,x_lower,x_upper\n0,1,\n",
        {},
        "{path}, line 2, column 'x_upper': the cell is empty; expected a number; fill it or remove the line",
    ),
}


@pytest.mark.parametrize("defect", BAND_FILES)
def test_a_defect_of_a_file_of_bands_is_told(defect, tmp_path):
    text, options, sentence = BAND_FILES[defect]
    path = tmp_path / "bounds.csv"
    path.write_text(text)
    with pytest.raises(DataError) as error:
        read_bands(path, **options)
    assert str(error.value) == sentence.format(path=path)


def test_a_bound_that_is_not_finite_is_told_with_its_place():
    with pytest.raises(DataError) as error:
        Bands.of([0.0, 0.5], {"tip.x": ([0.0, 0.0], [1.0, 1.0]), "tip.y": ([0.0, 0.0], [1.0, np.nan])})
    assert str(error.value) == (
        "channel 'tip.y', sample 1 (time 0.5 s): the upper bound is nan; expected a finite number"
    )


TIMES = np.array([0.0, 0.5, 1.0])
MODEL = PythonModel(lambda rate: np.exp(-rate * TIMES), {"rate": (0.1, 2.0)}, ["tip.x"], TIMES)


@pytest.mark.parametrize(
    ("data", "sentence"),
    [
        (
            Measurements.of(TIMES, {"tip.x": [1.0, np.nan, 0.5]}),
            "channel 'tip.x', sample 1 (time 0.5 s): nan; expected a finite number (1 are not); "
            "leave out these samples or the channel",
        ),
        (
            Measurements.of(TIMES, {"tip.y": [1.0, 0.7, 0.5]}),
            "the data name a channel that the model does not give: unknown channel 'tip.y'; did you mean 'tip.x'?",
        ),
        (
            Measurements.of(TIMES[:2], {"tip.x": [1.0, 0.7]}),
            "the data have 2 samples and the model 3; expected the same; build the model with the samples of the data",
        ),
        (
            Measurements.of([*TIMES[:2], 1.1], {"tip.x": [1.0, 0.7, 0.5]}),
            "sample 2: the data lie at time 1.1 s, the model's response at 1 s; expected the same; "
            "build the model with the samples of the data",
        ),
    ],
)
def test_data_that_do_not_fit_the_model_are_refused(data, sentence):
    with pytest.raises(DataError) as error:
        identify(MODEL, data)
    assert str(error.value) == sentence
