"""Errors that are expected with their whole message, which is a snapshot: ``make wording`` writes the message of today."""

from collections.abc import Iterator
from contextlib import contextmanager

import pytest


@contextmanager
def refused(kind: type[Exception], message: str) -> Iterator[None]:
    """Expect an error of a kind with exactly this message, as in ``with refused(InputError, snapshot("...")):``."""
    with pytest.raises(kind) as caught:
        yield
    assert str(caught.value) == message
