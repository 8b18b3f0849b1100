"""Notebooks as the Markdown that they are: the site shows it, and the tests run its code."""

import json


def markdown(notebook: str) -> str:
    """The cells of a notebook one after the other, those of code as code blocks.

    >>> cells = [{"cell_type": "markdown", "source": ["# Title"]}, {"cell_type": "code", "source": ["x = 1"]}]
    >>> print(markdown(json.dumps({"cells": cells})))
    # Title
    <BLANKLINE>
    ```python
    x = 1
    ```
    <BLANKLINE>
    """
    texts = [(cell["cell_type"], "".join(cell["source"])) for cell in json.loads(notebook)["cells"]]
    return "\n\n".join(f"```python\n{text}\n```" if kind == "code" else text for kind, text in texts) + "\n"
