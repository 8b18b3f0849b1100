"""What a study file may say at a place."""

from dalembert.studio.editor.fields import field_at, fields_at, kinds_at, tables_of
from dalembert.studio.editor.names import names_in
from dalembert.studio.editor.outline import channels_of
from dalembert.study import load
from dalembert.study.template import begin

PLANAR = {"model": {"body": [{"kind": "RigidBody"}], "joint": [{}]}, "parameters": {"d": {}}, "solver": {}}
SPATIAL = {"model": {"space": True, "body": [{"kind": "RigidBody"}]}}


def keys(document, place):
    return [field.key for field in fields_at(document, place)]


def test_kinds_and_space_choose_among_tables():
    assert "angle" in keys(PLANAR, ("model", "body", 0))
    assert "orientation" in keys(SPATIAL, ("model", "body", 0))
    assert keys(PLANAR, ("model", "joint", 0)) == ["kind"]
    assert "GearJoint" in kinds_at(PLANAR, ("model", "joint", 0))
    assert keys(PLANAR, ("solver",))[:2] == ["kind", "step"]
    assert "function" not in keys(SPATIAL, ("model",))
    assert keys(PLANAR, ("nowhere",)) == []
    assert keys(PLANAR, ("parameters",)) == []


def test_fields_say_what_a_form_needs():
    upper = field_at(PLANAR, ("parameters", "d", "upper"))
    assert (upper.shape, upper.required) == ("number", True)
    mass = field_at(PLANAR, ("model", "body", 0, "mass"))
    assert (mass.shape, mass.unit, mass.required) == ("number", "kg", True)
    kind = field_at(PLANAR, ("model", "body", 0, "kind"))
    assert kind.shape == "choice"
    assert "PointMass" in kind.choices
    assert field_at(PLANAR, ("simulate", "channels")).names == "channel"
    assert field_at({}, ("identify", "polish")).shape == "switch"
    assert field_at({}, ("identify", "starts")).shape == "whole"
    assert field_at({}, ("identify", "method")).shape == "choice"
    assert field_at({}, ("data", "time")).shape == "number"
    assert field_at({}, ("model", "gravity")).unit == "m/s^2"


def test_tables_have_a_meaning():
    found = tables_of({})
    assert found[("model", "contact", 0)] == "a contact of a structure"
    assert all(found.values())


def test_names(tmp_path):
    study = load(begin("motion", tmp_path / "motion"))
    assert {"rod.end.x", "pin.angle"} <= set(channels_of(study))
    spatial = {"model": {"space": True, "body": [{"kind": "RigidBody", "name": "A", "points": {"tip": [1, 0, 0]}}]}}
    assert names_in(spatial)["point"] == ("ground", "A.centre", "A.origin", "A.tip")
    beam = {"model": {"body": [{"kind": "AncfBeam", "name": "A"}]}}
    assert names_in(beam)["point"] == ("ground", "A.start", "A.end")
    assert names_in({"model": {"mass": [{"name": "m"}]}})["node"] == ("m",)
    assert names_in({"model": 3, "parameters": []})["parameter"] == ()
