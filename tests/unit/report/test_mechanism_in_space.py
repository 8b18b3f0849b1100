"""Reports on mechanisms in space."""

import re

import numpy as np
import pytest

import dalembert as da
from dalembert.errors import InputError
from dalembert.multibody.spatial import Shape
from dalembert.report import Animation, figures, report
from dalembert.report.player.playback import Playback
from films import decoded, kinds
from spatial_pendulum import SOLVER, TRUE, build, motion, records, response


@pytest.fixture(scope="module")
def trajectory():
    return motion(samples=2001)


def test_each_frame_holds_the_drawing_at_its_time(trajectory):
    drawing = trajectory.drawing()
    scene = Animation.of(drawing).scene
    frames, shown, drawn = Playback.of(drawing.times).frames, kinds(scene), decoded(scene)
    assert (shown["body one"], shown["body two"]) == ("surface", "line")
    axes = drawing.axes["one"][frames]
    corners = axes[:, :1] + drawing.surfaces["one"].corners @ axes[:, 1:]
    np.testing.assert_allclose(drawn["body one"], corners, atol=1e-6)
    tip = trajectory.channels(["two.tip.x", "two.tip.y", "two.tip.z"])[frames]
    np.testing.assert_allclose(drawn["body two"][:, -1], tip, atol=1e-6)
    np.testing.assert_allclose(drawn["joint hinge"][:, 0], drawing.joints["hinge"][frames], atol=1e-6)
    rays = drawn["axis z"][:, 1] - drawn["axis z"][:, 0]
    np.testing.assert_allclose(rays / np.linalg.norm(rays, axis=1, keepdims=True), axes[:, 3], atol=1e-5)


def test_the_picture_holds_the_whole_motion(trajectory):
    path = np.array([[-5.0, 0.0, 1.0], [0.0, 4.0, 3.0]])
    animation = Animation.of(trajectory.drawing(), paths={"P": path})
    numbers = re.search(r'class="path".*?d="M([-\d.]+) ([-\d.]+)L([-\d.]+) ([-\d.]+)"', animation.svg)
    pixels = np.array(numbers.groups(), dtype=float).reshape(2, 2)
    assert (pixels > 0).all()
    assert (pixels < animation.size).all()


def test_ground_and_moving_joints_differ(trajectory):
    shown = kinds(Animation.of(trajectory.drawing()).scene)
    assert (shown["joint ball"], shown["joint hinge"]) == ("ground", "joint")


def test_a_report_on_a_motion_draws_the_path_of_the_last_point(trajectory, tmp_path):
    made = figures(trajectory)
    assert list(made) == ["mechanism", "energies", "violations", "newton"]
    path = decoded(made["mechanism"].scene)["path two.tip"][0]
    passed = trajectory.channels([f"two.tip.{axis}" for axis in "xyz"])
    assert np.linalg.norm(path[:, None] - passed, axis=2).min(axis=1).max() < 1e-6
    np.testing.assert_allclose(path[[0, -1]], passed[[0, -1]], atol=1e-6)
    assert "path one.low" in decoded(figures(trajectory, points=["one.low"])["mechanism"].scene)
    page = report(trajectory, tmp_path / "motion.html").read_text()
    assert "Drag to turn" in page
    with pytest.raises(InputError, match=r"unknown channel 'two\.top\.x'; did you mean 'two\.tip\.x'"):
        figures(trajectory, points=["two.top"])


def test_a_report_on_an_identification_draws_what_was_measured(tmp_path):
    data = records()
    fit = da.identify(response(), data, starts=1, start=TRUE * 1.05)
    found = da.simulate(build(*fit.values), 1.0, SOLVER)
    made = figures(fit, found)
    drawn = decoded(made["mechanism"].scene)
    np.testing.assert_array_equal(drawn["measured two.tip"][0], data.values[:, :3].astype(np.float32))
    assert {"path two.tip", "path one.low", "measured one.low"} <= set(drawn)
    labels = [made[name].layout.yaxis.title.text for name in made if name.startswith("responses")]
    assert set(labels) == {"position (m)"}
    report(fit, tmp_path / "fit.html", found)


def test_a_large_mechanism_makes_a_bounded_file(trajectory):
    drawing = trajectory.drawing()
    for number in range(300):
        drawing.lines[f"body {number}"] = drawing.lines["two"] + 0.01 * number
        drawing.axes[f"body {number}"] = drawing.axes["two"]
    animation = Animation.of(drawing)
    assert "body 301 bodies" in kinds(animation.scene)
    assert "axis z" not in kinds(animation.scene)
    assert len(animation.element()) < 3_000_000
    for number in range(300):
        drawing.surfaces[f"body {number}"] = drawing.surfaces["one"]
    animation = Animation.of(drawing)  # too many corners: lines
    assert "surface" not in kinds(animation.scene).values()
    assert len(animation.element()) < 3_000_000
    drawing.surfaces.clear()
    drawing.surfaces.update({f"body {number}": Shape.box((0.1, 0.1, 0.1)).surface for number in range(8)})
    shown = kinds(Animation.of(drawing).scene)
    assert [kind for part, kind in shown.items() if part.startswith("body")] == ["line", *["surface"] * 8]
    assert "body 294 bodies" in shown


def test_a_motionless_mechanism_is_drawn():
    animation = Animation.of(da.equilibrium(build(2.0, 0.4, 0.0)).drawing())
    assert len(animation.scene.times) == 1
    assert animation.svg.startswith("<svg")
