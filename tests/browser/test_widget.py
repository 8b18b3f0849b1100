"""The widget of a mechanism with sliders in a real browser, connected to the simulation in Python."""

import json

import pytest

from browser.visitor import wait_until
from dalembert.multibody import RevoluteJoint, RigidBar, System
from dalembert.parameter import Parameter
from dalembert.parameters import Parameters

pytest.importorskip("anywidget")
from dalembert.widget import sliders
from dalembert.widget.frontend import MechanismSliders

SHARED = ("look", "parameters", "asked", "answered", "film", "curves", "message")
PAGE = """
<body style="margin:1rem"><div id="cell"></div><script type="module">
const state = %s, listeners = {}, own = {};
const model = {
  get: (name) => state[name],
  set: (name, value) => { state[name] = own[name] = value; },
  on: (name, listener) => { (listeners[name] ??= []).push(listener); },
  off: () => {},
  save_changes: async () => {
    window.requests = (window.requests ?? 0) + 1;
    Object.assign(state, await window.answer(own.asked));
    for (const listener of listeners["change:answered"]) listener();
  },
};
const { default: widget } = await import(URL.createObjectURL(new Blob([%s], { type: "text/javascript" })));
Object.assign(window, { widget, model });
widget.render({ model, el: document.getElementById("cell") });
</script></body>
"""


def pendulum(length):
    system = System()
    rod = system.add(RigidBar("rod", length=length, mass=1.0))
    system.add(RevoluteJoint("pin", system.ground, rod.start))
    return system


@pytest.fixture
def opened(chromium):
    """A page with the widget, and the widget."""
    parameters = Parameters((Parameter("length", 0.5, 2.0, "m"),))
    widget = sliders(pendulum, parameters, end=2.0, channels=["rod.end.x"])

    def answer(asked):
        widget.asked = asked
        return {name: getattr(widget, name) for name in SHARED}

    page = chromium.page(width=1000, height=620)
    page.expose_function("answer", answer)
    state = {name: getattr(widget, name) for name in SHARED}
    page.set_content(PAGE % (json.dumps(state), json.dumps(MechanismSliders._esm).replace("</", "<\\/")))
    wait_until(page, "document.querySelector('[data-part=rod]')?.getAttribute('d')")
    return page, widget


def end_of_rod(page):
    """Positions of the ends of the rod in the picture."""
    path = page.locator("[data-part=rod]").get_attribute("d")
    return [tuple(map(float, point.split())) for point in path.removeprefix("M").split("L")]


def length_of_rod(page):
    (x0, y0), (x1, y1) = end_of_rod(page)
    return ((x1 - x0) ** 2 + (y1 - y0) ** 2) ** 0.5


def test_a_slider_by_keyboard_changes_the_motion(chromium, opened, tmp_path):
    page, widget = opened
    before = length_of_rod(page)
    slider = page.get_by_label("length in m")
    slider.focus()
    page.keyboard.press("Home")
    wait_until(page, "Number(document.getElementById('cell').dataset.answered) >= 1")
    assert widget.values == {"length": 0.5}
    assert length_of_rod(page) == pytest.approx(0.4 * before, rel=0.01)  # 0.5 m in place of 1.25 m, at the same scale
    assert page.locator("label output").inner_text() == "0.5"
    page.screenshot(path=tmp_path / "widget.png")
    assert chromium.complaints == []


def test_the_newest_value_wins(opened):
    page, widget = opened
    page.evaluate("""() => {
        const slider = document.querySelector('label input');
        for (let value = 50; value < 150; value++) {
            slider.value = value / 100;
            slider.dispatchEvent(new Event('input'));
        }
    }""")
    wait_until(page, "window.requests === 2 && Number(document.getElementById('cell').dataset.answered) === 2")
    assert widget.values["length"] == pytest.approx(1.49, abs=0.01)


def test_play_and_time_move_the_mechanism(opened):
    page, _ = opened
    page.get_by_role("button", name="Play").click()
    wait_until(page, "document.querySelector('.player output').textContent > 't = 0.3'")
    page.get_by_role("button", name="Pause").click()
    page.get_by_label("Time").focus()
    page.keyboard.press("End")
    wait_until(page, "document.querySelector('.player output').textContent === 't = 2.00 s'")
    assert page.locator("svg.curve line").get_attribute("transform") == "translate(420 0)"


def test_an_error_of_the_model_is_a_sentence(opened):
    page, widget = opened
    widget._source = type("Failing", (), {"at": staticmethod(_fail)})()
    page.get_by_label("length in m").focus()
    page.keyboard.press("End")
    wait_until(page, "document.querySelector('[role=alert]').textContent === 'It is too long. Choose another.'")


def _fail(values):
    from dalembert.errors import ModelError

    raise ModelError("It is too long. Choose another.")


def test_the_widget_works_in_a_shadow_tree(opened):
    """As marimo shows it: styles of the page do not reach it."""
    page, widget = opened
    page.evaluate("""() => {
        const host = document.body.appendChild(document.createElement('div'));
        host.id = 'host';
        window.shadow = host.attachShadow({ mode: 'open' }).appendChild(document.createElement('div'));
        window.widget.render({ model: window.model, el: window.shadow });
    }""")
    wait_until(page, "window.shadow.querySelector('[data-part=rod]')?.getAttribute('d')")
    slider = page.locator("#host").get_by_label("length in m")
    slider.focus()
    page.keyboard.press("Home")
    wait_until(page, "Number(window.shadow.dataset.answered) >= 1")
    assert widget.values == {"length": 0.5}
