"""Measurements from a CSV file."""

import pytest

from dalembert.data import read_csv


@pytest.fixture
def file(tmp_path):
    path = tmp_path / "motion.csv"
    path.write_text("t,case1_x,case1_y\n0.00,2.4392,-1.7071\n0.05, 2.4380 ,-1.7186\n\n0.10,2.4342,-1.7533\n")
    return path


def test_columns_are_named_as_the_channels_that_they_measure(file):
    data = read_csv(file, columns={"AB.end.y": "case1_y", "AB.end.x": "case1_x"}, deviations=1e-4)
    assert data.channels == ("AB.end.y", "AB.end.x")
    assert data.coordinate.values.tolist() == [0.0, 0.05, 0.1]
    assert data.values.tolist() == [[-1.7071, 2.4392], [-1.7186, 2.438], [-1.7533, 2.4342]]
    assert data.deviations.tolist() == [1e-4, 1e-4]


def test_without_columns_all_but_the_time_are_read(file):
    assert read_csv(file).channels == ("case1_x", "case1_y")


def test_another_separator_and_a_byte_order_mark_are_read(tmp_path):
    path = tmp_path / "motion.csv"
    path.write_bytes("zeit;x\n0;1\n1;2\n".encode("utf-8-sig"))
    assert read_csv(path, time="zeit", separator=";").values.tolist() == [[1.0], [2.0]]
