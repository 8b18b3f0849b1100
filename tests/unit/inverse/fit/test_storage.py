"""A fit comes back from its file bit for bit."""

import numpy as np
import pytest

from dalembert.data import Measurements
from dalembert.errors import DataError
from dalembert.inverse import Fit, identify
from dalembert.optimize import ParticleSwarm
from small_models import DECAY, LINE, measured

ARRAYS = ("values", "deviations", "correlation", "singular_values", "directions", "response", "residuals", "weights")


@pytest.mark.parametrize(
    "fit",
    [
        identify(LINE, measured(LINE, [1.0, 2.0], 0.1, deviations=0.1), seed=3),
        identify(DECAY, measured(DECAY, [2.0, 0.8], 0.1), method=ParticleSwarm(5, 4), polish=True),
    ],
    ids=["least squares", "swarm"],
)
def test_everything_comes_back_bit_for_bit(fit, tmp_path):
    fit.save(tmp_path / "fit.nc")
    back = Fit.load(tmp_path / "fit.nc")
    for name in ARRAYS:
        assert getattr(back, name).tobytes() == getattr(fit, name).tobytes(), name
        assert getattr(back, name).dtype == np.float64
    for name in ("misfit", "success", "status", "method", "simulations", "provenance", "parameters"):
        assert getattr(back, name) == getattr(fit, name), name
    assert back.data.fingerprint == fit.data.fingerprint
    for name in ("history", "starts"):
        for one, same in zip(getattr(fit, name), getattr(back, name), strict=True):
            for key, value in vars(one).items():
                np.testing.assert_array_equal(value, getattr(same, key), strict=False)
    assert back.summary() == fit.summary()
    assert str(back.identifiability()) == str(fit.identifiability())


def test_the_dataset_is_labelled_by_name_and_unit():
    dataset = identify(LINE, measured(LINE, [1.0, 2.0])).to_xarray()
    assert float(dataset["values"].sel(parameter="slope")) == pytest.approx(2)
    assert dataset["response"].sel(channel="y").shape == (41,)
    assert dataset["coordinate"].attrs == {"long_name": "time", "units": "s"}


def test_a_file_that_is_not_there_is_told(tmp_path):
    with pytest.raises(DataError) as error:
        Fit.load(tmp_path / "fit.nc")
    assert str(error.value) == f"{tmp_path / 'fit.nc'}: there is no such file; expected a result written by Fit.save"


def test_a_file_of_another_kind_is_told(tmp_path):
    (tmp_path / "fit.nc").write_text("no")
    with pytest.raises(
        DataError, match=r"fit.nc: cannot be read as NetCDF \(.*\); expected a result written by Fit.save"
    ):
        Fit.load(tmp_path / "fit.nc")


def test_a_dataset_without_a_fit_is_told(tmp_path):
    identify(LINE, measured(LINE, [1.0, 2.0])).to_xarray().assign_attrs(format="sweep 1").to_netcdf(
        tmp_path / "sweep.nc", engine="h5netcdf"
    )
    with pytest.raises(DataError) as error:
        Fit.load(tmp_path / "sweep.nc")
    assert str(error.value) == (
        f"{tmp_path / 'sweep.nc'}: holds 'sweep 1'; expected 'dalembert fit 1', a result written by Fit.save"
    )


def test_measurements_along_another_coordinate_come_back(tmp_path):
    data = measured(DECAY, [2.0, 0.8])
    fit = identify(DECAY, Measurements.of(data.coordinate, {"x": data.values[:, 0]}, {"x": 0.1}))
    fit.save(tmp_path / "fit.nc")
    assert Fit.load(tmp_path / "fit.nc").data.deviations.tolist() == [0.1]
