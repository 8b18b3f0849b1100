"""Sphinx: Markdown pages (MyST) and the reference from the docstrings (numpydoc)."""

from dalembert import __version__

project = "dalembert"
author = "the dalembert developers"
copyright = f"2026, {author}"  # noqa: A001 (the name that Sphinx reads)
release = version = __version__

extensions = ["myst_parser", "sphinx.ext.autodoc", "sphinx.ext.napoleon", "sphinx.ext.mathjax"]
myst_enable_extensions = ["dollarmath", "colon_fence"]
myst_heading_anchors = 3
exclude_patterns = ["_build"]

autodoc_member_order = "bysource"
autodoc_typehints = "signature"
napoleon_google_docstring = False
napoleon_use_rtype = False

html_theme = "furo"
html_title = f"dalembert {release}"
