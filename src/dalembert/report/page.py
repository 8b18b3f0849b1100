"""The report: one HTML file that holds all it needs."""

import base64
import hashlib
import json
import os
from collections.abc import Mapping, Sequence
from importlib.resources import files
from pathlib import Path
from typing import Any

from jinja2 import Environment, PackageLoader, StrictUndefined
from markupsafe import Markup
from plotly.offline import get_plotlyjs

from dalembert import __version__
from dalembert.files import write_text
from dalembert.report.contents import Result, contents
from dalembert.report.look import DARK, FONT, LIGHT, exchanged, template
from dalembert.report.needs import TrajectoryLike
from dalembert.report.needs_frequency import BackboneLike, DeformationLike, ReductionErrorsLike, TimeComparisonLike
from dalembert.report.needs_telling import PredictionLike, ProfilesLike
from dalembert.report.plot import SAFE


def report(
    result: Result,
    path: str | os.PathLike[str],
    *,
    title: str | None = None,
    trajectory: TrajectoryLike | Mapping[str, TrajectoryLike] | None = None,
    notes: str | Sequence[str] = (),
    study: str | None = None,
    points: Sequence[str] = (),
    truth: Mapping[str, Any] | None = None,
    profiles: ProfilesLike | None = None,
    prediction: PredictionLike | Mapping[str, PredictionLike] | None = None,
    dofs: Sequence[str] = (),
    amplitude: str = "peak",
    time_comparison: TimeComparisonLike | None = None,
    backbone: BackboneLike | None = None,
    deformation: DeformationLike | None = None,
    reduction: ReductionErrorsLike | None = None,
) -> Path:
    """Write an HTML report that opens offline in any browser, in its light or dark, and asks nothing of the network.

    Parameters
    ----------
    result : Fit, Trajectory, FrequencyCurve, Propagation, Comparison, BandFit, ParameterSet, Profiles …
        A result of this package.
    path : path
        The file is written whole or not at all; its folder is made.
    title : str, optional
    trajectory : Trajectory, or mapping of str to Trajectory, optional
        Motion at the identified values, drawn with the measured points of a fit; one for each of several experiments,
        or some of them, by name.
    notes : str or sequence of str
        Paragraphs to stand under the headline; in one text, empty lines part them.
    study : str, optional
        Text of the study file, for the provenance.
    points : sequence of str
        Points whose paths are drawn, for example ``"AB.end"``; the measured points or the free ends if not given.
    truth : mapping of str, optional
        What is known of the parameters, to be drawn beside what was found: (lower, upper) for intervals identified from
        bands, a number for a set of parameters.
    profiles : Profiles, optional
        Profile likelihoods of a fit, for a section of its report.
    prediction : Prediction, or mapping of str to Prediction, optional
        Bands of a fit's response, for a section of its report; one for each of several experiments by name.
    dofs : sequence of str
        Degrees of freedom that a response over frequency is drawn for; those that move most if not given.
    amplitude : str
        What is drawn over frequency: ``"peak"``, ``"rms"``, or ``"harmonic 1"`` and so on.
    time_comparison : TimeComparison, optional
        Points of a response over frequency beside integration in time, for a section of its report.
    backbone : Backbone, optional
        A nonlinear mode, drawn with a response over frequency and for a section of its report.
    deformation : Deformation, optional
        The whole structure at one point of a response over frequency, for a section of its report.
    reduction : ReductionErrors, optional
        What the reduction of the structure changes, for a section of its report.

    Returns
    -------
    pathlib.Path
        The file written.

    Raises
    ------
    InputError
        For a result that is none of these.
    """
    paragraphs = notes.strip().split("\n\n") if isinstance(notes, str) else notes
    sections = contents(
        result,
        title=title,
        trajectory=trajectory,
        notes=[text for text in paragraphs if text],
        study=study,
        points=tuple(points),
        truth=truth,
        profiles=profiles,
        prediction=prediction,
        dofs=tuple(dofs),
        amplitude=amplitude,
        time_comparison=time_comparison,
        backbone=backbone,
        deformation=deformation,
        reduction=reduction,
    )
    environment = _environment()
    scripts = [Markup(get_plotlyjs()), Markup(_packaged("page.js"))]
    page = environment.get_template("page.html").render(
        title=sections[0].title,  # pyright: ignore[reportAttributeAccessIssue]
        sections=sections,
        environment=environment,
        style=Markup(environment.get_template("page.css").render(light=LIGHT, dark=DARK, font=Markup(FONT))),
        scripts=scripts,
        policy=_policy(scripts),
        look=_json({"template": template().to_plotly_json(), "dark": exchanged()}),
        version=__version__,
    )
    path = Path(path)
    path.parent.mkdir(parents=True, exist_ok=True)
    write_text(path, page)
    return path


def _environment() -> Environment:
    return Environment(
        loader=PackageLoader("dalembert.report"),
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )


def _packaged(name: str) -> str:
    return files("dalembert.report").joinpath("templates", name).read_text(encoding="utf-8")


def _json(content: object) -> Markup:
    return Markup(json.dumps(content).translate(SAFE))


def _policy(scripts: list[Markup]) -> str:
    """Content security policy: nothing from elsewhere, and no script but ours, by their hashes."""
    hashes = " ".join(
        f"'sha256-{base64.b64encode(hashlib.sha256(script.encode()).digest()).decode()}'" for script in scripts
    )
    return f"default-src 'none'; script-src {hashes}; style-src 'unsafe-inline'; img-src data: blob:; base-uri 'none'"
