import plotly.graph_objects as go
import pytest

from dalembert.report.charts.drawing import logarithmic
from dalembert.report.look import DARK, LIGHT, dark, exchanged, plain, themed


def _luminance(colour: str) -> float:
    """Relative luminance of a colour as WCAG 2 defines it."""
    channels = [int(colour[place : place + 2], 16) / 255 for place in (1, 3, 5)]
    linear = [c / 12.92 if c <= 0.04045 else ((c + 0.055) / 1.055) ** 2.4 for c in channels]
    return 0.2126 * linear[0] + 0.7152 * linear[1] + 0.0722 * linear[2]


def _contrast(one: str, other: str) -> float:
    bright, dim = sorted((_luminance(one), _luminance(other)), reverse=True)
    return (bright + 0.05) / (dim + 0.05)


@pytest.mark.parametrize("palette", [LIGHT, DARK])
def test_text_and_lines_can_be_read_on_their_ground(palette):
    assert _contrast(palette.ink, palette.surface) >= 7
    assert _contrast(palette.muted, palette.page) >= 4.5
    assert all(_contrast(colour, palette.surface) >= 3 for colour in palette.series)


@pytest.mark.parametrize("palette", [LIGHT, DARK])
def test_a_verdict_can_be_read_on_the_page_and_its_sign_and_border_be_seen(palette):
    assert _contrast(palette.ink, palette.page) >= 7
    green, amber, orange = (palette.series[place] for place in (2, 4, 1))
    assert all(_contrast(colour, palette.page) >= 3 for colour in (green, amber, orange))


def test_each_light_colour_has_one_dark_counterpart():
    assert len(exchanged()) == len(LIGHT.colours) == len(set(LIGHT.colours))


def test_a_dark_figure_keeps_its_numbers_and_exchanges_its_colours():
    light = themed(go.Figure(go.Scatter(x=[1, 2], y=[3.5, 4.5], line={"color": LIGHT.series[1]})), "Title")
    figure = dark(light)
    assert list(figure.data[0].y) == [3.5, 4.5]
    assert figure.data[0].line.color == DARK.series[1]
    assert figure.layout.template.layout.paper_bgcolor == DARK.surface
    assert light.data[0].line.color == LIGHT.series[1]
    assert figure.layout.title.text == "Title"


def test_tags_in_a_name_are_shown_not_read():
    assert plain("<a href='x'>&</a>") == "&lt;a href='x'&gt;&amp;&lt;/a&gt;"


def test_a_logarithmic_axis_of_few_decades_has_labels_between_them():
    axis = logarithmic(go.Figure(go.Scatter(y=[20.0, 300.0])))
    assert {20.0, 50.0, 100.0, 200.0} <= set(axis["tickvals"])
    assert logarithmic(go.Figure(go.Scatter(y=[1e-3, 20.0])))["dtick"] == 1
    assert logarithmic(go.Figure(go.Scatter(y=[2.0, 3.0]))) == {"type": "log"}
