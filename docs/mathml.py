"""Equations as MathML, which browsers draw by themselves: no script, and nothing from elsewhere."""

from docutils import nodes
from docutils.utils.math import MathError
from docutils.utils.math.latex2mathml import tex2mathml
from sphinx.application import Sphinx
from sphinx.util import logging
from sphinx.writers.html5 import HTML5Translator

logger = logging.getLogger(__name__)


def inline(translator: HTML5Translator, node: nodes.math) -> None:
    """Write an equation in a line of text."""
    translator.body.append(_mathml(node, block=False))
    raise nodes.SkipNode


def display(translator: HTML5Translator, node: nodes.math_block) -> None:
    """Write an equation in a line of its own."""
    translator.body.append(
        f'<div class="math" style="overflow-x: auto; margin: 0.6em 0">{_mathml(node, block=True)}</div>\n'
    )
    raise nodes.SkipNode


def _mathml(node: nodes.Element, block: bool) -> str:
    """MathML of a node's LaTeX; what cannot be read is a warning, which fails the build."""
    try:
        return tex2mathml(node.astext(), as_block=block)
    except MathError as error:
        logger.warning("the equation %r cannot be read: %s", node.astext(), error, location=node)
        return ""


def setup(app: Sphinx) -> dict[str, bool]:
    """Called by Sphinx."""
    app.add_html_math_renderer("mathml", inline_renderers=(inline, None), block_renderers=(display, None))
    return {"parallel_read_safe": True, "parallel_write_safe": True}
