"""The texts that a draft had, to undo and redo."""

from dataclasses import dataclass, field

PAUSE = 1.0
"""Time (s) between two keys after which they are two steps of the history."""
MOST = 500
"""Steps that can be undone."""


@dataclass
class History:
    """Texts in their order, and which of them is the present one.
    >>> history = History("a")
    >>> history.add("ab", 0.0)
    >>> history.add("abc", 0.2)
    >>> history.step(-1), history.step(-1), history.step(1)
    ('a', None, 'abc')
    """

    first: str
    _texts: list[str] = field(init=False)
    _now: int = 0
    _typed: float | None = None

    def __post_init__(self) -> None:
        self._texts = [self.first]

    @property
    def can_undo(self) -> bool:
        return self._now > 0

    @property
    def can_redo(self) -> bool:
        return self._now < len(self._texts) - 1

    def add(self, text: str, typed: float | None = None) -> None:
        """Add a text; one that was typed at a time (s) shortly after the last one replaces it."""
        del self._texts[self._now + 1 :]
        together = typed is not None and self._typed is not None and typed - self._typed < PAUSE
        if together:
            self._texts[-1] = text
        else:
            self._texts = [*self._texts[-MOST:], text]
        self._now, self._typed = len(self._texts) - 1, typed

    def step(self, by: int) -> str | None:
        """Go to the text before (-1) or after (1) and return it; None if there is none."""
        if not 0 <= self._now + by < len(self._texts):
            return None
        self._now, self._typed = self._now + by, None
        return self._texts[self._now]
