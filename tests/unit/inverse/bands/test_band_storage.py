"""An identification from bands comes back from its file bit for bit."""

import numpy as np
import pytest

from dalembert.errors import DataError
from dalembert.inverse import BandFit, GlobalSurrogate, Nested, identify_bands
from dalembert.optimize import ParticleSwarm
from dalembert.surrogate import Adaptive
from small_models import DECAY, LINE, banded

BANDS = banded(DECAY, [1.8, 0.7], [2.2, 0.9], points=2)
PLAIN = ("misfit", "success", "status", "method", "simulations", "seconds", "provenance", "parameters", "intervals")
PLAIN += ("unknowns", "checked_misfit")
ARRAYS = ("middle_deviations", "radius_deviations", "correlation", "singular_values", "directions", "weights", "lower")
ARRAYS += ("upper", "error")


@pytest.mark.parametrize(
    "fit",
    [
        identify_bands(DECAY, BANDS, seed=3),
        identify_bands(DECAY, BANDS, intervals=["rate"], method=GlobalSurrogate(Adaptive(1e-6), checks=0)),
        identify_bands(DECAY, BANDS, method=Nested(ParticleSwarm(5, 3))),
        identify_bands(LINE, banded(LINE, [1.0, 2.0], [1.5, 2.5], points=2), weights=[1.0, 0.5]),
    ],
    ids=["global", "not checked", "nested", "weighted"],
)
def test_everything_comes_back_bit_for_bit(fit, tmp_path):
    fit.save(tmp_path / "fit.nc")
    back = BandFit.load(tmp_path / "fit.nc")
    for name in PLAIN:
        assert getattr(back, name) == getattr(fit, name), name
    for name in ARRAYS:
        assert getattr(back, name).tobytes() == getattr(fit, name).tobytes(), name
    for name in ("checked_lower", "checked_upper"):
        np.testing.assert_equal(getattr(back, name), getattr(fit, name))
    assert (back.box.lower.tobytes(), back.box.upper.tobytes()) == (fit.box.lower.tobytes(), fit.box.upper.tobytes())
    assert back.bands.fingerprint == fit.bands.fingerprint
    for name in ("history", "starts"):
        for one, same in zip(getattr(fit, name), getattr(back, name), strict=True):
            for key, value in vars(one).items():
                np.testing.assert_array_equal(value, getattr(same, key), strict=False)
    assert back.summary() == fit.summary()
    assert str(back.identifiability()) == str(fit.identifiability())


def test_the_dataset_is_labelled_by_name_and_unit():
    dataset = identify_bands(DECAY, BANDS).to_xarray()
    assert float(dataset["box_lower"].sel(parameter="rate")) == pytest.approx(0.7)
    assert dataset["given_upper"].sel(channel="x").shape == (41,)
    assert dataset["correlation"].sel(unknown="rate radius").shape == (4,)
    assert dataset["coordinate"].attrs == {"long_name": "time", "units": "s"}


def test_a_file_that_holds_something_else_is_told(tmp_path):
    path = tmp_path / "fit.nc"
    with pytest.raises(DataError) as missing:
        BandFit.load(path)
    assert str(missing.value) == f"{path}: there is no such file; expected a result written by BandFit.save"
    identify_bands(DECAY, BANDS).to_xarray().assign_attrs(format="dalembert fit 1").to_netcdf(path, engine="h5netcdf")
    with pytest.raises(DataError) as other:
        BandFit.load(path)
    assert str(other.value) == (
        f"{path}: holds 'dalembert fit 1'; expected 'dalembert bandfit 1', a result written by BandFit.save"
    )


def test_ends_of_intervals_have_names():
    fit = identify_bands(DECAY, BANDS)
    assert list(fit.estimates) == ["size lower", "size upper", "rate lower", "rate upper"]
    assert fit.estimates["rate upper"] == fit.box.upper[1]
