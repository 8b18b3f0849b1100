"""Messages of robots as numbers by the paths of their fields, whatever encoding they have."""

import json
from collections.abc import Callable, Iterator, Mapping
from pathlib import Path
from typing import Any

from dalembert.data.opening import library

PACKAGES = {
    ("ros1", "ros1msg"): "mcap_ros1",
    ("cdr", "ros2msg"): "mcap_ros2",
    ("protobuf", "protobuf"): "mcap_protobuf",
}
"""Packages that decode messages, by the encodings of message and schema."""

STAMPS = (("sec", "nanosec"), ("secs", "nsecs"), ("seconds", "nanos"), ("sec", "nsec"))
"""Fields of time stamps: of ROS 2, ROS 1 and Protobuf, and in JSON."""


class Decoders:
    """Functions that decode messages, by the numbers of their schemas; ``path``: the file, for messages."""

    def __init__(self, path: Path) -> None:
        self._path = path
        self._factories: dict[str, Any] = {}
        self._decoders: dict[tuple[int, str], Callable[[bytes], Any] | None] = {}

    def decoded(self, schema: Any, channel: Any, message: Any) -> Any:
        """Return a message as nested mappings, lists and numbers or as an object; None if nothing decodes it."""
        if channel.message_encoding == "json":
            return json.loads(message.data)
        key = (channel.schema_id, channel.message_encoding)
        if key not in self._decoders:
            package = PACKAGES.get((channel.message_encoding, schema.encoding if schema else ""))
            factory = None if package is None else self._factory(package)
            self._decoders[key] = None if factory is None else factory.decoder_for(channel.message_encoding, schema)
        decoder = self._decoders[key]
        return None if decoder is None else decoder(message.data)

    def _factory(self, package: str) -> Any:
        if package not in self._factories:
            name = f"{package.replace('_', '-')}-support"
            module = library(f"{package}.decoder", self._path, "such messages", "mcap", name)
            self._factories[package] = module.DecoderFactory()
        return self._factories[package]


def encoding_of(schema: Any, channel: Any) -> str:
    """Return the encoding of a message and that of its schema, in words."""
    schema_encoding = schema.encoding if schema else ""
    both = dict.fromkeys(filter(None, (channel.message_encoding, schema_encoding)))
    return " with ".join(both) or "no encoding"


def fields(front: str, value: Any) -> Iterator[tuple[str, float | int]]:
    """Numbers in a message by their paths; a time stamp as a whole number of nanoseconds, beside its parts.

    >>> dict(fields("", {"header": {"stamp": {"sec": 2, "nanosec": 5}}, "x": [1.5, True], "name": "elbow"}))
    {'header.stamp': 2000000005, 'header.stamp.sec': 2.0, 'header.stamp.nanosec': 5.0, 'x[0]': 1.5}
    """
    entries = _entries(value)
    if entries is not None:
        seconds, rest = next((pair for pair in STAMPS if set(pair) == set(entries)), ("", ""))
        if front and isinstance(entries.get(seconds), int) and isinstance(entries.get(rest), int):
            yield front, entries[seconds] * 10**9 + entries[rest]
        for name, entry in entries.items():
            yield from fields(f"{front}.{name}" if front else name, entry)
    elif isinstance(value, int | float):
        if not isinstance(value, bool):
            yield front, float(value)
    elif not isinstance(value, str | bytes) and hasattr(value, "__len__"):
        for number, entry in enumerate(value):
            yield from fields(f"{front}[{number}]", entry)


def _entries(value: Any) -> Mapping[str, Any] | None:
    if isinstance(value, Mapping):
        return value
    if hasattr(value, "DESCRIPTOR"):  # Protobuf: numbers that have their default value are not sent
        return {field.name: getattr(value, field.name) for field in value.DESCRIPTOR.fields if _is_sent(value, field)}
    names = getattr(value, "__slots__", None)
    return {name: getattr(value, name) for name in names} if names and not isinstance(value, str) else None


def _is_sent(message: Any, field: Any) -> bool:
    """Whether a field of a Protobuf message has a value; a message in it may be absent, and may contain itself."""
    return not field.has_presence or field.message_type is None or message.HasField(field.name)
