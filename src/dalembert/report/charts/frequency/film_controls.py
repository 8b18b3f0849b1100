"""The controls of an animated figure, in a page or a notebook."""

from typing import Any

from dalembert.report.look import LIGHT
from dalembert.report.scene.scene import Film


def controls(film: Film) -> dict[str, Any]:
    """Layout of the play button and the slider, and in ``meta`` what a page with its controls needs."""
    still = {"mode": "immediate", "frame": {"duration": 0, "redraw": True}, "transition": {"duration": 0}}
    duration = 1000 * film.seconds / len(film.labels)
    play = {"frame": {"duration": duration, "redraw": True}, "transition": {"duration": 0}}
    buttons = [
        {"label": "▶ play", "method": "animate", "args": [None, {**play, "fromcurrent": True}]},
        {"label": "❚❚ pause", "method": "animate", "args": [[None], still]},
    ]
    steps = [{"label": text, "method": "animate", "args": [[str(k)], still]} for k, text in enumerate(film.labels)]
    place: dict[str, Any] = {"xanchor": "left", "y": 0, "yanchor": "top"}
    shown = {"prefix": f"{film.name} ", "suffix": f" {film.unit}" + (f", {film.pace}" if film.pace else "")}
    menu = {"type": "buttons", "direction": "left", "showactive": False, "buttons": buttons}
    slider = {
        "steps": steps,
        "currentvalue": {**shown, "font": {"size": 12, "color": LIGHT.ink}},
        "ticklen": 0,
        "minorticklen": 0,
        "font": {"color": "rgba(0, 0, 0, 0)", "size": 1},
    }
    return {
        "updatemenus": [{**place, **menu, "x": 0, "pad": {"t": 22, "r": 10}}],
        "sliders": [{**place, **slider, "x": 0.26, "len": 0.74, "pad": {"t": 4}}],
        "meta": {**vars(film), "labels": list(film.labels)},
    }
