"""The report: one HTML file that holds all it needs."""

import base64
import gzip
import hashlib
import os
from collections.abc import Sequence
from functools import cache
from pathlib import Path
from typing import Any

from jinja2 import Environment, PackageLoader, StrictUndefined
from markupsafe import Markup
from plotly.offline import get_plotlyjs

from dalembert import __version__
from dalembert.files import write_text
from dalembert.report.contents import contents
from dalembert.report.inline import inline_json
from dalembert.report.look import DARK, FONT, LIGHT, exchanged, template
from dalembert.report.options import report_options
from dalembert.report.player import PICTURES, module, player_files
from dalembert.report.section import Motion

SCRIPT = Path(__file__).parent / "templates" / "page.js"


def report(
    result: object,
    path: str | os.PathLike[str],
    *supplements: object,
    notes: str | Sequence[str] = (),
    **options: Any,
) -> Path:
    """Write an HTML report that opens offline in any browser, in its light or dark, and asks nothing of the network.

    Parameters
    ----------
    result : Fit, Trajectory, FrequencyCurve, Propagation, Comparison, BandFit, ParameterSet, Profiles …
        A result of this package, or of a kind that :func:`sections_of` registered.
    path : path
        The file is written whole or not at all; its folder is made.
    *supplements
        Other results that are shown with it,
        and sections of yours (:class:`ReportSection`). A fit is shown with a trajectory
        at the identified values, a population, profiles and a prediction; of several experiments, give a mapping of
        their names. A response over frequency is shown with a comparison in time, a backbone, a deformation and
        reduction errors.
    notes : str or sequence of str
        Paragraphs under the headline. In one text, empty lines separate them.
    **options
        ``title``, a text. ``study``, the text of the study file, for the provenance. ``points`` whose paths are drawn,
        such as ``["AB.end"]``; the measured points or the free ends if not given. A motion is drawn over time at the
        ``points``, and with the ``channels``, such as ``["AB.angle"]``. ``truth``, what is known of the
        parameters by their names, to be drawn with what was identified: (lower, upper) for intervals identified from
        bands, a number for a set of parameters. ``dofs``, degrees of freedom that a response over frequency is drawn
        for; those that move most if not given. ``amplitude``, what is drawn over frequency: ``"peak"``, ``"rms"``, or
        ``"harmonic 1"`` and so on.

    Returns
    -------
    pathlib.Path
        The file written.

    Raises
    ------
    InputError
        For a result that no sections are registered for, and for what no section shows.
    """
    paragraphs = notes.strip().split("\n\n") if isinstance(notes, str) else notes
    sections = contents(result, report_options(supplements, notes=[text for text in paragraphs if text], **options))
    templates = environment()
    motions = [plot.figure for section in sections for plot in section.plots if isinstance(plot, Motion)]
    player = player_files(in_space=any(motion.scene.dimensions == 3 for motion in motions))
    script = module((*player, PICTURES, SCRIPT) if motions else [SCRIPT])
    look = {"template": template().to_plotly_json(), "dark": exchanged()}
    text = templates.get_template("page.html").render(
        title=sections[0].title,
        sections=sections,
        environment=templates,
        style=Markup(templates.get_template("page.css").render(light=LIGHT, dark=DARK, font=Markup(FONT))),
        plotly=_plotly(),
        script=Markup(script),
        policy=_policy([get_plotlyjs(), script]),
        look=inline_json(look),
        version=__version__,
    )
    path = Path(path)
    path.parent.mkdir(parents=True, exist_ok=True)
    write_text(path, text)
    return path


def environment() -> Environment:
    """Templates of the page."""
    return Environment(
        loader=PackageLoader("dalembert.report"),
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )


@cache
def _plotly() -> str:
    """The library of the figures, packed."""
    return base64.b64encode(gzip.compress(get_plotlyjs().encode(), 4, mtime=0)).decode()


def _policy(scripts: list[str]) -> str:
    """Content security policy: nothing from elsewhere, and no script but ours, by their hashes."""
    hashes = " ".join(
        f"'sha256-{base64.b64encode(hashlib.sha256(script.encode()).digest()).decode()}'" for script in scripts
    )
    return f"default-src 'none'; script-src {hashes}; style-src 'unsafe-inline'; img-src data: blob:; base-uri 'none'"
