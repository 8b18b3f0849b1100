"""XML with line numbers that records which of its elements and attributes were read."""

__all__ = ["Element", "parsed"]

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any
from xml.parsers import expat

import numpy as np

from dalembert.errors import InputError, counted, require_known, shown
from dalembert.multibody.trees.omissions import Omission

UNLIMITED = float(np.finfo(float).max)
"""The largest number stands for no limit: most readers of URDF know no infinite numbers."""
MOVING = ("inertial", "mass", "inertia", "axis", "dynamics", "mimic")
"""Elements of links and joints on which the motion depends."""
STANDING = ("fixed", "floating", "planar")
"""Joints that are imported as fixed ones, so that their other elements have no effect."""


@dataclass(eq=False)
class Element:
    """An element of a file.

    ``owner``: the link, joint or other part of the robot that it belongs to, for messages.
    """

    tag: str
    line: int
    owner: str
    attributes: Mapping[str, str]
    children: list["Element"] = field(default_factory=list)
    text: str = ""
    file: str = ""
    depth: int = 0
    used: set[str] = field(default_factory=set)
    known: bool = False

    @property
    def place(self) -> str:
        """Where it is, for messages."""
        return f"{self.file}, line {self.line}: {self.owner}{': <' + self.tag + '>' if self.depth > 1 else ''}"

    @property
    def words(self) -> str:
        """What it is, for sentences."""
        return f"<{self.tag}> of {self.owner}" if self.depth > 1 else self.owner

    def all(self, tag: str) -> list["Element"]:
        """The children with a tag."""
        found = [child for child in self.children if child.tag == tag]
        for child in found:
            child.known = True
        return found

    def child(self, tag: str) -> "Element | None":
        """The first child with a tag; further ones remain to be listed."""
        for found in self.children:
            if found.tag == tag:
                found.known = True
                return found
        return None

    def required(self, tag: str) -> "Element":
        """The first child with a tag."""
        found = self.child(tag)
        if found is None:
            raise InputError(f"{self.place} has no element <{tag}>. Add it")
        return found

    def word(self, name: str) -> str | None:
        """The value of an attribute, or None."""
        self.used.add(name)
        return self.attributes.get(name)

    def required_word(self, name: str) -> str:
        """The value of an attribute."""
        found = self.word(name)
        if found is None:
            raise InputError(f"{self.place} has no attribute {name!r}. Add it")
        return found

    def numbers(self, name: str, count: int, default: tuple[float, ...] | None = None) -> tuple[float, ...]:
        """Finite numbers of an attribute; the default where it is missing."""
        given = self.word(name) if default is not None else self.required_word(name)
        if given is None:
            assert default is not None
            return default
        try:
            found = tuple(map(float, given.split()))
        except ValueError:
            found = ()
        if len(found) != count or not np.all(np.isfinite(found)):
            expected = "a finite number" if count == 1 else f"{count} finite numbers"
            advice = ". Convert the file by xacro first" if "${" in given else ""
            raise InputError(f"{self.place}: {name} is {shown(given)}; expected {expected}{advice}")
        return found

    def number(self, name: str, default: float | None = None) -> float:
        """A finite number of an attribute; the default where it is missing."""
        return self.numbers(name, 1, None if default is None else (default,))[0]

    def limit(self, name: str, default: float) -> float:
        """A number of an attribute that may be infinite, or so large that it stands for no limit."""
        given = self.attributes.get(name, "").strip().lower()
        if given in ("inf", "-inf"):
            self.used.add(name)
            return float(given)
        value = self.number(name, default)
        return float(np.copysign(np.inf, value)) if abs(value) >= UNLIMITED else value

    @property
    def size(self) -> tuple[int, int]:
        """Numbers of elements and of attributes, with all that is in it."""
        inner = [child.size for child in self.children]
        return 1 + sum(own[0] for own in inner), len(self.attributes) + sum(own[1] for own in inner)

    def unread(self, moves: bool = True) -> Iterator[Omission]:
        """Each element and each attribute that was not read; ``moves``: whether they can change the motion."""
        if not self.known:
            elements, attributes = (
                counted(own, what) for own, what in zip(self.size, ("element", "attribute"), strict=True)
            )
            text = f"line {self.line}: {self.words} is not imported ({elements}, {attributes})"
            yield Omission(text, moves and self.tag in MOVING)
            return
        for name in self.attributes:
            if name not in self.used:
                text = f"line {self.line}: attribute {name!r} of {self.words} is not imported"
                yield Omission(text, moves and self.tag in MOVING)
        if self.text.strip():
            yield Omission(f"line {self.line}: the text {shown(self.text.strip())} in {self.words} is not imported")
        for child in self.children:
            yield from child.unread(moves and self.attributes.get("type") not in STANDING)


def parsed(path: Path, tag: str, what: str) -> Element:
    """The outermost element of a file."""
    try:
        content = path.read_bytes()
    except FileNotFoundError:
        raise InputError(f"{path}: there is no such file. Check the path") from None
    except OSError as error:
        raise InputError(f"{path} cannot be read: {error.strerror}. Expected {what}") from None
    parser, whole, around = expat.ParserCreate(), [], []

    def start(name: str, attributes: dict[str, Any]) -> None:
        outer = around[-1] if around else None
        owner = outer.owner if outer and len(around) > 1 else f"{name} {attributes.get('name', '')!r}"
        own = Element(name, parser.CurrentLineNumber, owner, attributes, file=path.name, depth=len(around))
        (outer.children if outer else whole).append(own)
        around.append(own)

    def text(data: str) -> None:
        around[-1].text += data

    parser.StartElementHandler, parser.CharacterDataHandler = start, text
    parser.EndElementHandler = lambda name: around.pop()
    try:
        parser.Parse(content, True)
    except expat.ExpatError as error:
        reason = expat.errors.messages[error.code]
        raise InputError(f"{path}, line {error.lineno}: the file is no XML ({reason}). Expected {what}") from None
    except (LookupError, ValueError) as error:  # an encoding that Python has not, or that expat cannot take
        raise InputError(f"{path}: the file cannot be decoded ({error}). Save it as UTF-8") from None
    require_known("outermost element", whole[0].tag, [tag], str(path))
    whole[0].known = True
    return whole[0]
