"""Files with several trials: each is read by its label."""

import json

import numpy as np
import pytest

from dalembert.data import read, read_trials
from dalembert.errors import DataError


def written(folder, *rows, name="runs.csv"):
    path = folder / name
    path.write_text("\n".join(["run,t,x", *(",".join(map(str, row)) for row in rows)]) + "\n")
    return path


def test_each_trial_counts_from_its_first_sample(tmp_path):
    path = written(tmp_path, (1, 0.0, 5), (1, 0.1, 6), ("left", 7.0, 8), ("left", 7.2, 9))
    trials = read_trials(path, "run", columns={"bar.x": "x"})
    assert list(trials) == ["1", "left"]
    np.testing.assert_allclose(trials["left"].coordinate.values, [0.0, 0.2])
    assert trials["left"].values.ravel().tolist() == [8.0, 9.0]
    assert read_trials(path, "run", start=0)["left"].coordinate.values.tolist() == [7.0, 7.2]


def test_lines_of_trials_may_alternate(tmp_path):
    path = written(tmp_path, (1, 0.0, 5), (2, 0.0, 8), (1, 0.1, 6), (2, 0.1, 9))
    assert {label: data.values.ravel().tolist() for label, data in read_trials(path, 1).items()} == {
        "1": [5.0, 6.0],
        "2": [8.0, 9.0],
    }


def test_long_numbers_of_trials_stay_apart(tmp_path):
    path = written(tmp_path, (1234567, 0.0, 5), (1234567, 0.1, 6), (1234568, 0.2, 8), (1234568, 0.3, 9))
    assert list(read_trials(path, "run")) == ["1234567", "1234568"]


def test_trials_of_json(tmp_path):
    rows = [{"run": run, "t": time, "x": run + time} for run in (1, 2) for time in (3.0, 3.5)]
    (tmp_path / "runs.json").write_text(json.dumps(rows))
    trials = read_trials(tmp_path / "runs.json", "run", columns={"bar.x": "x"})
    assert {label: data.values.ravel().tolist() for label, data in trials.items()} == {"1": [4.0, 4.5], "2": [5.0, 5.5]}


def test_wrong_trials_are_refused_with_their_place(tmp_path):
    path = written(tmp_path, (1, 0.0, 5), (1, 0.1, 6), (2, 0.2, 8), (2, 0.1, 9))
    with pytest.raises(DataError, match=r"line 5, column 't': 0\.1 comes after 0\.2"):
        read_trials(path, "run")
    with pytest.raises(DataError, match="unknown column 'trial'"):
        read_trials(path, "trial")
    with pytest.raises(DataError, match="column 'run': unknown trial '3'; known: 1, 2"):
        read(path, trial=("run", 3))


@pytest.mark.parametrize("empty", ["", "NaN"])
def test_a_line_without_a_trial_is_refused(empty, tmp_path):
    path = written(tmp_path, (1, 0.0, 5), (1, 0.1, 6), (empty, 0.2, 8))
    with pytest.raises(DataError, match="line 4, column 'run': no trial"):
        read_trials(path, "run")
