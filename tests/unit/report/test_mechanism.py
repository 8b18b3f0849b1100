import numpy as np
import pytest
from dalembert.report.charts.motion.playback import Playback

from dalembert.report.charts import mechanism
from dalembert.report.section import Plot
from stand_ins import motion


def test_each_frame_holds_the_drawing_at_its_time():
    drawing = motion(samples=2001, end=2.0).drawing()
    figure = mechanism(drawing)
    names = [trace.name for trace in figure.data]
    for frame, at in zip(figure.frames, Playback.of(drawing.times).frames, strict=True):
        drawn = dict(zip((names[place] for place in frame.traces), frame.data, strict=True))
        np.testing.assert_allclose(drawn["OA"].x, drawing.lines["OA"][at, :, 0], rtol=1e-6, atol=1e-6)
        np.testing.assert_allclose(drawn["AB"].y, drawing.lines["AB"][at, :, 1], rtol=1e-6, atol=1e-6)
        np.testing.assert_allclose(drawn["joints"].x, drawing.joints["A"][at, None, 0], rtol=1e-6, atol=1e-6)
        assert frame.name == str(at)


def test_axes_are_equal_and_hold_the_whole_motion():
    drawing = motion().drawing()
    path = np.array([[-5.0, 0.0], [0.0, 4.0]])
    figure = mechanism(drawing, paths={"P": path})
    points = np.concatenate([*(line.reshape(-1, 2) for line in drawing.lines.values()), path])
    assert figure.layout.yaxis.scaleanchor == "x"
    assert figure.layout.yaxis.scaleratio == 1
    for axis, values in ((figure.layout.xaxis, points[:, 0]), (figure.layout.yaxis, points[:, 1])):
        assert axis.range[0] < values.min()
        assert axis.range[1] > values.max()


def test_ground_and_moving_joints_differ():
    traces = {trace.name: trace for trace in mechanism(motion().drawing()).data}
    assert traces["fixed to ground"].text == ("O",)
    assert traces["joints"].text == ("A",)


def test_path_and_measured_points_are_drawn_where_they_are():
    measured = np.array([[0.5, 0.25], [0.75, -1.0]])
    figure = mechanism(motion().drawing(), paths={"tip": measured}, measured={"tip": measured})
    traces = {trace.name: trace for trace in figure.data}
    np.testing.assert_array_equal(traces["tip measured"].x, [0.5, 0.75])
    np.testing.assert_array_equal(traces["path of tip"].y, [0.25, -1.0])


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


def test_play_button_lasts_as_long_as_the_film_and_the_slider_reaches_every_frame():
    figure = mechanism(motion(samples=501, end=4.0).drawing())
    play = figure.layout.updatemenus[0].buttons[0]
    assert play.args[1]["frame"]["duration"] * len(figure.frames) == pytest.approx(4000)
    steps = figure.layout.sliders[0].steps
    assert [step.args[0][0] for step in steps] == [frame.name for frame in figure.frames]
    assert (steps[0].label, steps[-1].label) == ("0.00", "4.00")


def test_a_large_mechanism_makes_a_bounded_file():
    drawing = motion(samples=5001, end=10.0).drawing()
    for number in range(300):
        drawing.lines[f"body {number}"] = drawing.lines["AB"] + 0.01 * number
    figure = mechanism(drawing)
    assert len(figure.frames) == 150
    assert len(Plot("mechanism", figure).json) < 3_000_000
    bodies = next(trace for trace in figure.data if trace.name == "302 bodies")
    assert np.isnan(bodies.x).sum() == 302
    assert {
        drawing.lines["body 7"][0, 0, 0].astype(np.float32),
        drawing.lines["body 7"][0, -1, 0].astype(np.float32),
    } <= set(bodies.x)


def test_a_motionless_mechanism_is_drawn():
    drawing = motion(samples=2).drawing()
    for line in drawing.lines.values():
        line[:] = 0.0
    drawing.joints.clear()
    assert len(mechanism(drawing).frames) == 2
