"""Columns of the messages in an MCAP file, as robots record them."""

import json
from collections import Counter
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

import numpy as np

from dalembert.data.columns import Columns, chosen, of_numbers
from dalembert.data.format import Format, Request
from dalembert.data.opening import library, reading
from dalembert.errors import DataError

LOGGED = "log_time"
"""Column of the times in s at which messages were recorded, since the first of the topic."""


class Mcap(Format):
    """MCAP with JSON messages of one topic, or of ``topic:field`` with several; times by field or ``log_time``."""

    name = "mcap"
    suffixes = (".mcap",)

    def columns(self, path: Path, request: Request) -> Columns:
        topics = _topics(path)
        wanted = [*(request.labels or ()), *([] if request.along is None else [request.along])]
        named = {name.partition(":")[0] for name in wanted if ":" in name}
        if len(named) > 1:
            raise DataError(
                f"{path}: the columns are of the topics {', '.join(sorted(named))}, whose times differ; read each "
                "topic by itself (more in a study), and merge them"
            )
        topic = next(iter(named), None) or (next(iter(topics)) if len(topics) == 1 else None)
        if topic not in topics:
            raise DataError(f"{path}: name the topic of each column as 'topic:field'; topics: {', '.join(topics)}")
        arrays = topics[topic]
        arrays |= {f"{topic}:{name}": array for name, array in arrays.items()}
        labels = (
            request.labels
            if request.labels is not None
            else [name for name in of_numbers(arrays) if ":" not in name and name not in (request.along, LOGGED)]
        )
        return Columns(path, request.along or "sample", *chosen(path, arrays, request.along, labels, request.missing))

    def held(self, path: Path) -> dict[str, tuple[np.ndarray, str]]:
        topics = _topics(path)
        several = len(topics) > 1
        return {
            f"{topic}:{name}" if several else name: (array, "s" if name == LOGGED else "")
            for topic, arrays in topics.items()
            for name, array in of_numbers(arrays).items()
        }


def _topics(path: Path) -> dict[str, dict[str, np.ndarray]]:
    """Columns of each topic with JSON messages."""
    messages: dict[str, list[Mapping[str, Any]]] = {}
    others: Counter[str] = Counter()
    with reading(path, "MCAP"):
        reader = library("mcap.reader", path, "MCAP files", "mcap")
        with path.open("rb") as stream:
            for schema, channel, message in reader.make_reader(stream).iter_messages():
                if channel.message_encoding != "json":
                    others[channel.message_encoding or (schema.encoding if schema else "")] += 1
                    continue
                fields = dict(_fields("", json.loads(message.data)))
                messages.setdefault(channel.topic, []).append({LOGGED: message.log_time, **fields})
    if not messages:
        raise DataError(
            f"{path}: no message is JSON; the file has: {', '.join(others) or 'no messages'}; convert them to JSON"
        )
    return {topic: _columns(rows) for topic, rows in messages.items()}


def _fields(front: str, value: Any) -> Iterator[tuple[str, float]]:
    """Numbers in a message, by their path."""
    if isinstance(value, Mapping):
        for name, entry in value.items():
            yield from _fields(f"{front}.{name}" if front else name, entry)
    elif isinstance(value, list):
        for number, entry in enumerate(value):
            yield from _fields(f"{front}[{number}]", entry)
    elif isinstance(value, int | float) and not isinstance(value, bool):
        yield front, float(value)


def _columns(rows: list[Mapping[str, Any]]) -> dict[str, np.ndarray]:
    """Columns of messages; NaN where a message does not have a field."""
    names = dict.fromkeys(name for row in rows for name in row)
    table = {name: np.array([row.get(name, np.nan) for row in rows], dtype=float) for name in names if name != LOGGED}
    first = rows[0][LOGGED]
    return {LOGGED: np.array([(row[LOGGED] - first) * 1e-9 for row in rows]), **table}
