"""Kernels are compiled with fewer passes, or by Numba's own ones with versions that were not tried."""

import tomllib
from pathlib import Path
from typing import NamedTuple

import numba
import numpy as np
import pytest

from dalembert.kernels.pipeline import PIPELINE, TRIED, NumbaPasses, Pipeline, is_tried
from dalembert.multibody.kernels.elementary import size_of


def cube(x):
    return x**3


class Box(NamedTuple):
    """A tuple with an array."""

    values: np.ndarray


def write(out):
    box = Box(out)
    box.values[0] = size_of(out[1])


@pytest.mark.parametrize("passes", [Pipeline, NumbaPasses])
def test_a_power_keeps_the_complex_step_with_both_lists_of_passes(passes):
    compiled = numba.njit(pipeline_class=passes)(cube)
    assert compiled(complex(-0.7, 1e-30)).imag == pytest.approx(3 * 0.49e-30, rel=1e-15)


@pytest.mark.parametrize("passes", [Pipeline, NumbaPasses])
def test_a_write_through_a_field_of_a_tuple_stays(passes):
    # Numba removes it in functions into which it writes an overload with `inline="always"`.
    out = np.array([0.0, -1.5])
    numba.njit(pipeline_class=passes)(write)(out)
    assert out[0] == 1.5


def test_the_installed_version_was_tried():
    assert PIPELINE is Pipeline


@pytest.mark.parametrize("version", [(0, 61), (TRIED[1][0], TRIED[1][1] + 1), (1, 0)])
def test_other_versions_take_the_passes_of_numba_with_a_warning(version):
    with pytest.warns(UserWarning, match="was not tried") as messages:
        assert not is_tried(version)
    (message,) = messages
    name = ".".join(map(str, version))
    assert str(message.message) == (
        f"Numba {name} was not tried with dalembert, so kernels compile more slowly, by Numba's own passes. "
        "Install a version from 0.62 to 0.68."
    )


def test_the_requirement_has_the_same_bounds():
    project = tomllib.loads((Path(__file__).parents[3] / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    first, (major, minor) = TRIED
    requirement = f"numba>={first[0]}.{first[1]},<{major}.{minor + 1}"
    assert requirement in project["dependencies"]
