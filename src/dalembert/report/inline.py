"""Data and scripts that stand in a page."""

import json
from typing import Any

from markupsafe import Markup

SAFE = str.maketrans({"<": "\\u003c", ">": "\\u003e", "&": "\\u0026"})
"""Characters that could end a script element, as JSON may write them."""


def inline_json(value: Any) -> Markup:
    """Return a value as JSON for a script element.
    >>> print(inline_json({"name": "</script>"}))
    {"name":"\\u003c/script\\u003e"}
    """
    text = value if isinstance(value, str) else json.dumps(value, separators=(",", ":"))
    return Markup(text.translate(SAFE))
