"""What several test files share."""

import re


def says(sentence: str) -> str:
    """Pattern for a message that is this sentence and no more."""
    return f"^{re.escape(sentence)}$"
