"""Sphinx: Markdown pages and notebooks (MyST), the reference from docstrings (numpydoc), and a gallery of studies."""

import sys
from pathlib import Path

from sphinx.application import Sphinx

from dalembert import __version__

sys.path.append(str(Path(__file__).parent))
import study_gallery
from notebook_text import markdown

project = "dalembert"
author = "the dalembert developers"
copyright = f"2026, {author}"  # noqa: A001 (the name that Sphinx reads)
release = version = __version__

extensions = ["myst_parser", "sphinx.ext.autodoc", "sphinx.ext.napoleon", "mathml"]
html_math_renderer = "mathml"
myst_enable_extensions = ["dollarmath", "colon_fence"]
myst_heading_anchors = 3
source_suffix = {".md": "markdown", ".ipynb": "markdown", study_gallery.SUFFIX: "markdown"}
exclude_patterns = ["_build"]

autodoc_member_order = "bysource"
suppress_warnings = ["ref.python"]  # words in descriptions of arrays that are names of several attributes, too
autodoc_typehints = "signature"
napoleon_google_docstring = False
napoleon_use_rtype = False

html_theme = "furo"
html_static_path = ["_static"]
html_css_files = ["gallery.css"]
html_title = f"dalembert {release}"


def read_notebook(app: Sphinx, page: str, source: list[str]) -> None:
    """Give MyST the text of a notebook in place of its JSON."""
    if app.env.doc2path(page).suffix == ".ipynb":
        source[0] = markdown(source[0])


def write_gallery(app: Sphinx) -> None:
    """Write the pages of the studies before Sphinx looks for pages."""
    study_gallery.write(Path(app.srcdir) / "gallery")


def show_gallery(app: Sphinx, page: str, source: list[str]) -> None:
    """Put pictures of studies into a page."""
    source[0] = study_gallery.with_pictures(source[0], "" if page.startswith("gallery/") else "gallery/")


def setup(app: Sphinx) -> None:
    """Called by Sphinx."""
    app.connect("builder-inited", write_gallery)
    app.connect("source-read", read_notebook)
    app.connect("source-read", show_gallery)
