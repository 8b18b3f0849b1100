import xml.etree.ElementTree as ET

import numpy as np
import pytest

from dalembert.report import Animation
from dalembert.report.player.playback import Playback
from films import decoded, kinds
from stand_ins import motion

SVG = "{http://www.w3.org/2000/svg}"


def test_each_frame_holds_the_drawing_at_its_time():
    drawing = motion(samples=2001, end=2.0).drawing()
    animation = Animation.of(drawing)
    frames = Playback.of(drawing.times).frames
    drawn = decoded(animation.scene)
    np.testing.assert_allclose(drawn["body OA"], drawing.lines["OA"][frames], rtol=1e-6, atol=1e-6)
    np.testing.assert_allclose(drawn["body AB"], drawing.lines["AB"][frames], rtol=1e-6, atol=1e-6)
    np.testing.assert_allclose(drawn["joint A"][:, 0], drawing.joints["A"][frames], rtol=1e-6, atol=1e-6)
    np.testing.assert_array_equal(animation.scene.times, drawing.times[frames])


def test_the_picture_has_equal_axes_and_holds_the_whole_motion():
    drawing = motion().drawing()
    path = np.array([[-5.0, 0.0], [0.0, 4.0]])
    animation = Animation.of(drawing, paths={"P": path})
    picture = ET.fromstring(animation.svg)
    strokes = {
        group.get("class"): [
            np.array([point.split() for point in piece.split("L")], dtype=float)
            for line in group.iter(f"{SVG}path")
            for piece in line.get("d").removeprefix("M").split("M")
        ]
        for group in picture.iter(f"{SVG}g")
        if group.get("class") in ("outline", "path", "body")
    }
    width, height = animation.size
    for pixels in (piece for pieces in strokes.values() for piece in pieces):
        assert (pixels > 0).all()
        assert (pixels < (width, height)).all()
    right, down = strokes["path"][0][1] - strokes["path"][0][0]
    assert right / 5.0 == pytest.approx(-down / 4.0, rel=1e-3)


def test_ground_and_moving_joints_differ():
    shown = kinds(Animation.of(motion().drawing()).scene)
    assert (shown["joint O"], shown["joint A"]) == ("ground", "joint")


def test_path_and_measured_points_are_drawn_where_they_are():
    measured = np.array([[0.5, 0.25], [0.75, -1.0]])
    animation = Animation.of(motion().drawing(), paths={"tip": measured}, measured={"tip": measured})
    drawn = decoded(animation.scene)
    np.testing.assert_array_equal(drawn["measured tip"][0, :, 0], [0.5, 0.75])
    np.testing.assert_array_equal(drawn["path tip"][0, :, 1], [0.25, -1.0])
    assert len(decoded(Animation.of(motion().drawing()).scene)["outline"][0]) > 0
    parts = [group.get("class") for group in ET.fromstring(animation.svg).iter(f"{SVG}g")]
    assert parts == ["outline", "path", "measured", "body", "body", "joint", "joint"]


def test_a_path_has_the_points_that_its_shape_needs():
    angle = np.linspace(0.0, 4.0, 5001)
    circle = np.column_stack([np.cos(angle), np.sin(angle)])
    drawn = decoded(Animation.of(motion().drawing(), paths={"P": circle}).scene)["path P"][0]
    assert 40 < len(drawn) < 400
    middles = (drawn[1:] + drawn[:-1]) / 2
    assert np.abs(np.linalg.norm(middles, axis=1) - 1.0).max() < 1e-3


@pytest.mark.parametrize(
    ("end", "seconds", "pace"),
    [
        (2.0, 2.0, "played in real time"),
        (5.0, 5.0, "played in real time"),
        (0.03, 2.0, "played 66.7 times slower than real"),
        (60.0, 6.0, "played 10 times faster than real"),
    ],
)
def test_a_film_is_in_real_time_where_that_can_be_watched(end, seconds, pace):
    film = Playback.of(np.linspace(0, end, 30_001))
    assert film.seconds == seconds
    assert film.pace == pace
    assert len(film.frames) == 25 * seconds <= 150
    assert film.times[0] == 0
    assert film.times[-1] == end


def test_few_samples_are_shown_as_they_are():
    film = Playback.of(np.linspace(0, 2, 41))
    assert film.frames.tolist() == list(range(41))
    assert Playback.of(np.array([0.5])).frames.tolist() == [0]


def test_a_large_mechanism_makes_a_bounded_file():
    drawing = motion(samples=5001, end=10.0).drawing()
    for number in range(300):
        drawing.lines[f"body {number}"] = drawing.lines["AB"] + 0.01 * number
    animation = Animation.of(drawing)
    assert len(animation.scene.times) == 150
    assert len(animation.element()) < 3_000_000
    bodies = decoded(animation.scene)["body 302 bodies"]
    assert np.isnan(bodies[0, :, 0]).sum() == 302
    ends = drawing.lines["body 7"][0, [0, -1], 0].astype(np.float32)
    assert set(ends) <= set(bodies[0, :, 0])


def test_a_motionless_mechanism_is_drawn():
    drawing = motion(samples=2).drawing()
    for line in drawing.lines.values():
        line[:] = 0.0
    drawing.joints.clear()
    animation = Animation.of(drawing)
    assert len(animation.scene.times) == 2
    assert ET.fromstring(animation.svg).tag == f"{SVG}svg"


def test_a_notebook_plays_an_animation_and_a_file_keeps_it(tmp_path):
    animation = Animation.of(motion().drawing(), title="A <b> pendulum")
    html = animation._repr_html_()
    assert html.count('<script type="module">') == 1
    assert "A &lt;b&gt; pendulum" in html
    assert "<b>" not in html
    page = animation.save(tmp_path / "pendulum.html").read_text()
    assert page.count('<script type="module">') == 1
    assert ET.fromstring(animation.save(tmp_path / "pendulum.svg").read_text()).get("aria-label") == "A <b> pendulum"
