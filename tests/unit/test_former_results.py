"""Files of the version that stored how a method ended as text load with that text as one finding."""

from pathlib import Path

import numpy as np
import pytest
import xarray as xr
from inline_snapshot import snapshot

from dalembert.inverse import BandFit, Fit, ParameterSet
from dalembert.uncertainty import Propagation

FOLDER = Path(__file__).parents[1] / "former_results"


@pytest.mark.parametrize(
    ("kind", "name", "status"),
    [
        (
            Fit,
            "fit",
            snapshot(
                "Converged. The response explains 98.28 % of the data's variation. The misfit is 2 times what the given deviations allow; look whether they are too small, the model lacks something, or more starts find a better minimum."
            ),
        ),
        (
            BandFit,
            "band-fit",
            snapshot(
                "Converged. The reproduced bands differ from the given ones by 1.4e-07 of their mean width at rms in 'x'; most in the upper bound of channel 'x', time 2 s, by 6.2e-08. What remains looks like noise. True runs at 2 points where the surrogate takes its bounds differ from it by at most 6e-08 of a channel's range."
            ),
        ),
        (ParameterSet, "set", snapshot("Paved down to the resolution.")),
        (
            Propagation,
            "propagation",
            snapshot(
                "The extremes over the corners of the box: exact where the response is monotone in each parameter, else too narrow; 'optimise' finds extremes inside."
            ),
        ),
    ],
)
def test_the_text_of_a_former_file_is_a_finding_without_a_class(kind, name, status, tmp_path):
    result = kind.load(FOLDER / f"{name}.nc")
    (finding,) = result.outcome
    assert (finding.code, finding.severity, finding.values) == ("unclassified", "note", {})
    assert finding.message == result.status == status
    assert finding.message in result.summary()
    result.save(tmp_path / "again.nc")
    assert kind.load(tmp_path / "again.nc").outcome == result.outcome


def test_findings_that_were_stored_with_codes_keep_them():
    fit = Fit.load(FOLDER / "fit.nc")
    assert fit.findings == ()
    assert fit.identifiability().findings == ()


def test_what_a_former_fit_has_beside_its_arrays_comes_back():
    fit = Fit.load(FOLDER / "fit-of-experiments.nc")
    assert fit.nodes is not None
    assert (fit.nodes.segments, fit.nodes.experiments) == (1, ("a", "b", "c"))
    assert fit.correlated is not None
    assert [process.channel for process in fit.correlated.processes] == ["a.x", "b.x", "c.x"]
    assert fit.integration is not None
    assert (fit.integration.how, len(fit.integration.bias)) == ("at half the step", 4)
    assert fit.halves is not None
    assert (fit.halves.refitted, fit.halves.values.shape) == (False, (2, 4))
    assert [part.name for part in fit.parts] == ["a", "b", "c"]
    validation = Fit.load(FOLDER / "fit-with-validation.nc").validation
    assert validation is not None
    assert (validation.what, validation.explained[0].record) == ("the experiment 'b'", "b")


@pytest.mark.parametrize("name", ["fit", "fit-of-experiments", "fit-with-validation"])
def test_a_former_fit_is_stored_again_with_the_same_bits(name, tmp_path):
    fit = Fit.load(FOLDER / f"{name}.nc")
    fit.save(tmp_path / "again.nc")
    with xr.open_dataset(FOLDER / f"{name}.nc") as former, xr.open_dataset(tmp_path / "again.nc") as now:
        assert set(now.variables) == set(former.variables)
        for variable in former.variables:
            assert now[variable].dims == former[variable].dims
            np.testing.assert_array_equal(now[variable].values, former[variable].values)
