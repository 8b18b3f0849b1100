"""The finding about a component because of which samples run one by one."""

from types import SimpleNamespace

import pytest

import dalembert.multibody as mb
from dalembert.multibody.spatial import SpatialSystem
from dalembert.study.run.model_findings import _one_by_one
from spatial_scenes import SCENES


def scene(name: str) -> SpatialSystem:
    build, fields = SCENES[name]
    return build(**fields)


@pytest.mark.parametrize(
    ("name", "task", "solver", "found"),
    [
        ("bushing", "propagate", mb.GeneralizedAlpha(1e-3), ["part"]),
        ("bushing", "simulate", mb.GeneralizedAlpha(1e-3), []),
        ("bushing", "propagate", mb.RadauIIA(), []),
        ("SphericalJoint", "propagate", mb.GeneralizedAlpha(1e-3), []),
    ],
)
def test_it_names_the_component_where_a_batch_could_use_lanes(name, task, solver, found) -> None:
    study = SimpleNamespace(task=task, has_system=True, solver=solver, system=lambda: scene(name))
    findings = _one_by_one(study)
    assert [finding.values["component"] for finding in findings] == found
    assert all((finding.code, finding.severity) == ("samples-one-by-one", "note") for finding in findings)
