"""A mechanism in motion: a picture that prints, and a player in its place where a browser runs scripts."""

import os
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from html import escape
from pathlib import Path
from typing import Any

import numpy as np
from markupsafe import Markup

from dalembert.files import write_text
from dalembert.multibody import Drawing
from dalembert.report.inline import inline_json
from dalembert.report.look import FONT
from dalembert.report.pictures.projection import Projection
from dalembert.report.pictures.svg import scene_picture
from dalembert.report.player import LOOK, PAGE_LOOKS, PICTURES, module, player_files
from dalembert.report.player.film import encoded
from dalembert.report.player.playback import Playback
from dalembert.report.scene.motion import motion_scene
from dalembert.report.scene.scene import Scene

WIDTH, LOWEST, HIGHEST = 720, 260, 460
"""Size of the picture, pixels."""


@dataclass(frozen=True, eq=False)
class Animation:
    """A mechanism in motion, drawn to scale with equal axes that hold the whole motion.

    A notebook shows a player: play button, slider and time. It plays 25 frames a second, in real time where that takes
    2 s to 6 s, else slower or faster; at most 150 frames. Print and pages without scripts show a picture, with faint
    outlines of poses along the motion. In space, bodies that have shapes are drawn with them, up to seven bodies with
    their axes, and the mouse turns the view.
    """

    scene: Scene
    title: str = "Mechanism"

    @classmethod
    def of(
        cls,
        drawing: Drawing,
        *,
        paths: Mapping[str, np.ndarray] | None = None,
        measured: Mapping[str, np.ndarray] | None = None,
        title: str = "Mechanism",
    ) -> "Animation":
        """Return the animation of a drawing.

        Parameters
        ----------
        drawing : Drawing
            Lines (frames, points, 2 or 3) and joints (frames, 2 or 3), by name, in m, at times (frames,) in s.
        paths : mapping of str to array, shape (samples, 2 or 3), optional
            Paths of points, in m.
        measured : mapping of str to array, shape (samples, 2 or 3), optional
            Measured positions of points, in m, drawn as crosses.
        title : str

        Examples
        --------
        >>> from types import SimpleNamespace
        >>> angle = np.linspace(0, 1, 51)
        >>> rod = np.stack([np.zeros((51, 2)), np.stack([np.sin(angle), -np.cos(angle)], axis=1)], axis=1)
        >>> swing = SimpleNamespace(times=np.linspace(0, 2, 51), lines={"rod": rod}, joints={"O": rod[:, 0]})
        >>> Animation.of(swing).pace
        'played in real time'
        """
        frames = Playback.of(np.asarray(drawing.times, dtype=float)).frames
        return cls(motion_scene(drawing, frames, paths=paths or {}, measured=measured or {}), title)

    @property
    def pace(self) -> str:
        """The speed of the player, in words."""
        film = self.scene.film
        return Playback.of(self.scene.times).pace if film is None else f"played {film.pace}"

    @property
    def size(self) -> tuple[int, int]:
        """Width and height of the picture, pixels."""
        points = Projection.of(self.scene.dimensions)(self.scene.positions)
        across, up = np.maximum(np.ptp(points, axis=0), 1e-9)
        return WIDTH, int(np.clip(WIDTH * up / across, LOWEST, HIGHEST))

    @property
    def svg(self) -> str:
        """The mechanism at its start, with outlines, paths and measured positions, as SVG."""
        return scene_picture(self.scene, self.title, self.size)

    def element(self, name: str = "", looks: Sequence[Mapping[str, Any]] = (LOOK,)) -> Markup:
        """The picture and the film for a script. ``name``: of its place; ``looks``: on a light and on a dark page."""
        place = f'id="figure-{escape(name)}" ' if name else ""
        width, height = self.size
        film = inline_json({**encoded(self.scene, complete=True), "looks": looks})
        return Markup(
            f'<div {place}class="dalembert-film" data-label="{escape(self.title)}" style="--shape:{width} / {height}">'
            f'<div class="film-still">{self.svg}</div>'
            f'<script type="application/json" data-name="{escape(name)}">{film}</script></div>'
        )

    def _repr_html_(self, looks: Sequence[Mapping[str, Any]] = (LOOK,)) -> str:
        script = module((*player_files(in_space=self.scene.dimensions == 3), PICTURES))
        return f'{self.element(looks=looks)}<script type="module">\n{script}\n</script>'

    def save(self, path: str | os.PathLike[str]) -> Path:
        """Write a page that plays the motion and needs no other file; of a path that ends with .svg, the picture.

        Returns
        -------
        pathlib.Path
            The file written.
        """
        path = Path(path)
        style = f"<style>:root {{color-scheme: light dark}} body {{font: 15px {FONT}; max-width: 1080px}}</style>"
        head = f'<!DOCTYPE html>\n<html lang="en"><meta charset="utf-8"><title>{escape(self.title)}</title>{style}\n'
        write_text(path, self.svg if path.suffix.lower() == ".svg" else head + self._repr_html_(PAGE_LOOKS))
        return path
