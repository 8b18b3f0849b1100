"""Equations of the documentation, and docstrings, can be drawn."""

import inspect
import re
from pathlib import Path

import pytest
from docutils.utils.math.latex2mathml import tex2mathml

import dalembert
from dalembert import data, forward, inverse, multibody, report, structure, study, surrogate, vibration
from dalembert.multibody import spatial

DOCS = Path(__file__).parents[2] / "docs"
PAGES = sorted(page for page in DOCS.rglob("*.md") if "_build" not in page.parts)
CODE = re.compile(r"^```.*?^```|`[^`\n]*`", re.MULTILINE | re.DOTALL)
EQUATION = re.compile(r"\$\$(.+?)\$\$|\$([^$\n]+)\$", re.DOTALL)
LITERAL = re.compile(r"``.*?``|:\w+:`[^`]*`|\\.", re.DOTALL)
SUBSTITUTION = re.compile(r"(?<!\w)\|\S(?:[^|\n]*\S)?\|(?!\w)")
PACKAGES = (dalembert, data, forward, inverse, multibody, report, spatial, structure, study, surrogate, vibration)


@pytest.mark.parametrize("page", PAGES, ids=lambda page: str(page.relative_to(DOCS)))
def test_every_equation_becomes_mathml(page: Path):
    for found in EQUATION.finditer(CODE.sub("", page.read_text(encoding="utf-8"))):
        tex2mathml(found[1] or found[2], as_block=bool(found[1]))


def substitutions(text: str) -> list[str]:
    """Amounts in bars, which Sphinx takes for the names of substitutions."""
    prose = re.split(r"\n\s*Examples\n\s*-+\n", text)[0]
    return SUBSTITUTION.findall(LITERAL.sub("", prose))


@pytest.mark.parametrize("package", PACKAGES, ids=lambda package: package.__name__)
def test_docstrings_have_no_bars(package):
    public = {name: getattr(package, name) for name in package.__all__}
    documented = {name: inspect.getdoc(one) for name, one in public.items() if inspect.isclass(one) or callable(one)}
    found = {name: substitutions(text) for name, text in documented.items() if text}
    assert {name: bars for name, bars in found.items() if bars} == {}


def test_bars_are_seen():
    assert substitutions("An error |e| ≤ ``|x|``, not :math:`|y|`, not \\|z\\|, not float | str.") == ["|e|"]
