import numpy as np

import dalembert as da
from dalembert.report import figures
from dalembert.report.options import ReportOptions
from dalembert.report.registry import registered_sections
from dalembert.study import load, run_study

STUDY = """
[study]
title = "A falling rod"
[model]
gravity = [0.0, -9.81]
[[model.body]]
kind = "RigidBar"
name = "rod"
length = "800 mm"
mass = "1.5 kg"
[[model.joint]]
kind = "RevoluteJoint"
name = "pin"
a = "ground"
b = "rod.start"
[solver]
step = "2 ms"
[simulate]
times = { end = "0.1 s", every = "20 ms" }
points = ["rod.end"]
channels = ["rod.end.angle", "rod.end.y"]
"""


def _motion():
    system = da.System(gravity=(0.0, -9.81))
    rod = system.add(da.RigidBar("rod", length=0.8, mass=1.5, angle=0.0))
    system.add(da.RevoluteJoint("pin", system.ground, rod.start))
    return da.simulate(system, end=0.1, solver=da.GeneralizedAlpha(step=2e-3))


def test_a_motion_is_drawn_over_time_at_the_points_and_with_the_channels():
    motion = _motion()
    drawn = figures(motion, points=["rod.end"], channels=["rod.end.angle", "rod.end.y"])
    assert [trace.name for trace in drawn["outputs-1"].data] == ["rod.end.angle"]
    assert [trace.name for trace in drawn["outputs-2"].data] == ["rod.end.y", "rod.end.x"]
    np.testing.assert_array_equal(drawn["outputs-2"].data[0].y, motion.channels(["rod.end.y"])[:, 0])
    assert drawn["outputs-2"].layout.xaxis.title.text == "time (s)"
    assert drawn["outputs-2"].layout.yaxis.title.text == "position (m)"


def test_all_samples_can_be_downloaded():
    sections = registered_sections(_motion(), ReportOptions(points=("rod.end",)))
    section = next(one for one in sections if getattr(one, "heading", "") == "Outputs over time")
    head, first, *_ = section.blocks[-1].table.csv.splitlines()
    assert (head, first) == ("time (s),rod.end.x,rod.end.y", "0.0,0.8,0.0")


def test_no_figure_over_time_where_nothing_is_asked_for():
    assert not [name for name in figures(_motion()) if name.startswith("outputs")]


def test_the_run_folder_has_the_asked_channels_as_csv(tmp_path):
    (tmp_path / "study.toml").write_text(STUDY)
    folder, _ = run_study(load(tmp_path / "study.toml"), tmp_path / "run")
    lines = (folder.path / "outputs.csv").read_text().splitlines()
    assert lines[:2] == ["t,rod.end.angle,rod.end.y,rod.end.x", "0,0,0,0.8"]
    assert len(lines) == 7
    page = (folder.path / "report.html").read_text()
    assert "Outputs over time" in page
    assert "rod.end.angle" in page
