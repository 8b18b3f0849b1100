"""Defects of measured data: one sentence each that says where and what to do."""

import numpy as np
import pytest

from dalembert.data import Bands, Measurements, read_bands, read_csv
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
        "{path}: the file holds only a header line; expected a line of column names and then lines of numbers",
    ),
    "a short line": (
        "t,x,y\n0,1,2\n0.1,1\n",
        {},
        "{path}, line 3: 2 cells; expected 3, as the header has",
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
        read_csv(path, **options)
    assert str(error.value) == sentence.format(path=path)


def test_a_file_that_is_not_there_is_answered_with_its_neighbours(tmp_path):
    (tmp_path / "motion.csv").touch()
    with pytest.raises(DataError) as error:
        read_csv(tmp_path / "motions.csv")
    assert str(error.value) == f"folder {tmp_path}: unknown file 'motions.csv'; did you mean 'motion.csv'?"


def test_a_file_that_is_not_text_is_told(tmp_path):
    path = tmp_path / "motion.csv"
    path.write_bytes(b"t,x\n\xff\xfe\xfa")
    with pytest.raises(DataError) as error:
        read_csv(path)
    assert str(error.value).startswith(f"{path}: cannot be read as text with columns (")


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
