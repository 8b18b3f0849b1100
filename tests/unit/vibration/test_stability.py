"""Stability of points of a curve, the markers of its changes, and how they are kept."""

from pathlib import Path

import numpy as np
import pytest

from dalembert.files import write_dataset
from dalembert.vibration import FrequencyCurve, HarmonicBalance, frequency_response
from vibrating_systems import duffing, one_mass

TURN = 2 * np.pi
METHOD = HarmonicBalance(5)


@pytest.fixture(scope="module")
def duffings_curve() -> FrequencyCurve:
    ends = 0.8 / TURN, 1.6 / TURN
    return frequency_response(duffing(), ends, METHOD, continuation="arc-length", stability=True)


def test_a_curve_is_unstable_between_its_folds(duffings_curve: FrequencyCurve) -> None:
    kinds, (first, last) = zip(*duffings_curve.markers, strict=True)
    assert kinds == ("fold", "fold")
    between = np.zeros(len(duffings_curve), dtype=bool)
    between[first + 1 : last + 1] = True
    np.testing.assert_array_equal(duffings_curve.stable == 0, between)
    np.testing.assert_array_equal(np.flatnonzero(duffings_curve.fold), [first, last])
    assert "points stable" in duffings_curve.summary()


def test_stability_is_kept_with_a_curve(duffings_curve: FrequencyCurve, tmp_path: Path) -> None:
    duffings_curve.save(tmp_path / "curve.nc")
    again = FrequencyCurve.load(tmp_path / "curve.nc")
    assert again.markers == duffings_curve.markers
    assert again.stable.dtype == np.int8
    np.testing.assert_array_equal(again.stable, duffings_curve.stable)


def test_a_curve_written_before_stability_was_kept_is_read(duffings_curve: FrequencyCurve, tmp_path: Path) -> None:
    before = duffings_curve.to_xarray().drop_vars("stable")
    write_dataset(tmp_path / "curve.nc", before)
    again = FrequencyCurve.load(tmp_path / "curve.nc")
    assert set(again.stable) == {-1}
    assert again.markers == duffings_curve.markers


def test_without_asking_only_folds_are_marked() -> None:
    ends = 0.8 / TURN, 1.6 / TURN
    curve = frequency_response(duffing(), ends, METHOD, continuation="arc-length")
    assert [kind for kind, _ in curve.markers] == ["fold", "fold"]
    assert set(curve.stable) == {-1}


def test_a_slider_is_stable_and_points_that_are_not_found_are_not_judged() -> None:
    hard = HarmonicBalance(5, samples=128, iterations=2, halvings=0)
    curve = frequency_response(one_mass(), np.linspace(0.05, 0.3, 6), hard, stability=True)
    np.testing.assert_array_equal(curve.stable, np.where(curve.converged, 1, -1))
