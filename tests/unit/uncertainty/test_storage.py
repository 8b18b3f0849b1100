"""Propagations and comparisons come back from their files bit for bit."""

import pytest

from dalembert.errors import DataError
from dalembert.surrogate import Tensor, TotalDegree
from dalembert.uncertainty import Chebyshev, Comparison, Propagation, compare, propagate
from small_models import DECAY, LINE
from support import says

BOX = {"size": (1.0, 2.0), "rate": (0.5, 1.0)}
ARRAYS = ("lower", "upper", "error", "at_lower", "at_upper")
FACTS = ("channels", "units", "method", "kind", "runs", "failures", "success", "status", "seconds", "provenance")


def assert_same(back: Propagation, result: Propagation) -> None:
    for name in ARRAYS:
        given, read = getattr(result, name), getattr(back, name)
        assert (read is None) == (given is None), name
        if given is not None:
            assert read.shape == given.shape
            assert read.tobytes() == given.tobytes(), name
    for name in FACTS:
        assert getattr(back, name) == getattr(result, name), name
    assert str(back.box) == str(result.box)
    assert back.box.lower.tobytes() == result.box.lower.tobytes()
    assert back.fingerprint == result.fingerprint
    assert back.summary() == result.summary()


@pytest.mark.parametrize(
    "method", ["vertex", "scan", "optimise", Chebyshev(Tensor(4), bounds="bernstein", tolerance=0.1)], ids=str
)
def test_everything_comes_back_bit_for_bit(method, tmp_path):
    result = propagate(DECAY, BOX, method)
    result.save(tmp_path / "bands.nc")
    assert_same(Propagation.load(tmp_path / "bands.nc"), result)


def test_a_comparison_comes_back_with_all_its_results(tmp_path):
    box = {"offset": (-1.0, 2.0), "slope": 1.0}
    comparison = compare(LINE, box, ["vertex", "taylor", "scan", Chebyshev(Tensor(2), bounds="bernstein")])
    comparison.save(tmp_path / "methods.nc")
    back = Comparison.load(tmp_path / "methods.nc")
    for one, same in zip(comparison.results, back.results, strict=True):
        assert_same(same, one)
    assert (back.reference, back.refused, back.rows) == (comparison.reference, (), comparison.rows)


def test_methods_that_gave_no_bounds_come_back_with_their_reasons(tmp_path):
    comparison = compare(DECAY, BOX, [Chebyshev(TotalDegree(1))], reference="vertex")
    comparison.save(tmp_path / "methods.nc")
    assert len(comparison.refused) == 1
    assert Comparison.load(tmp_path / "methods.nc").refused == comparison.refused


def test_the_dataset_is_labelled_by_name_and_unit():
    dataset = propagate(DECAY, BOX, "vertex").to_xarray()
    assert float(dataset["box_upper"].sel(parameter="rate")) == 1.0
    assert dataset["at_lower"].sel(channel="x", parameter="size").shape == (41,)
    assert dataset["coordinate"].attrs == {"long_name": "time", "units": "s"}


@pytest.mark.parametrize(
    ("kind", "what"), [(Propagation, "propagation"), (Comparison, "comparison")], ids=["propagation", "comparison"]
)
def test_a_file_of_another_kind_is_told(kind, what, tmp_path):
    path = tmp_path / "other.nc"
    expected = f"a result written by {kind.__name__}.save"
    with pytest.raises(DataError, match=says(f"{path}: there is no such file; expected {expected}")):
        kind.load(path)
    propagate(LINE, {"offset": 1.0, "slope": 2.0}, "vertex").to_xarray().assign_attrs(format="sweep 1").to_netcdf(
        path, engine="h5netcdf"
    )
    with pytest.raises(DataError, match=says(f"{path}: holds 'sweep 1'; expected 'dalembert {what} 1', {expected}")):
        kind.load(path)
