"""Columns of the messages in an MCAP file, as robots record them."""

from collections import Counter
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

from dalembert.data.columns import Columns, chosen, of_numbers
from dalembert.data.format import Format, Request
from dalembert.data.messages import Decoders, encoding_of, fields
from dalembert.data.opening import library, reading
from dalembert.errors import DataError

LOGGED = "log_time"
"""Column of the times in s at which messages were recorded, since the first of the topic."""


class Mcap(Format):
    """MCAP with messages of one topic, or of ``topic:field`` with several; times by field or ``log_time``.

    Messages are JSON, of ROS 1 or ROS 2, or Protobuf. A time stamp in a message is a column of times.
    """

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

    def all_columns(self, path: Path) -> dict[str, tuple[np.ndarray, str]]:
        topics = _topics(path)
        several = len(topics) > 1
        return {
            f"{topic}:{name}" if several else name: (array, "s" if name == LOGGED else "")
            for topic, arrays in topics.items()
            for name, array in of_numbers(arrays).items()
        }


def _topics(path: Path) -> dict[str, dict[str, np.ndarray]]:
    messages: dict[str, list[Mapping[str, Any]]] = {}
    skipped: Counter[str] = Counter()
    with reading(path, "MCAP"):
        reader = library("mcap.reader", path, "MCAP files", "mcap")
        decoders = Decoders(path)
        with path.open("rb") as stream:
            for schema, channel, message in reader.make_reader(stream).iter_messages():
                decoded = decoders.decoded(schema, channel, message)
                if decoded is None:
                    skipped[encoding_of(schema, channel)] += 1
                    continue
                row = {LOGGED: message.log_time, **dict(fields("", decoded))}
                messages.setdefault(channel.topic, []).append(row)
    if not messages:
        raise DataError(
            f"{path}: no message can be decoded; the file has: {', '.join(skipped) or 'no messages'}; expected JSON, "
            "messages of ROS 1 or ROS 2 with their definitions, or Protobuf; convert them to JSON"
        )
    return {topic: _columns(rows) for topic, rows in messages.items()}


def _columns(rows: list[Mapping[str, Any]]) -> dict[str, np.ndarray]:
    """Columns of messages; NaN where a message does not have a field. Stamps in ns are seconds since the first."""
    names = dict.fromkeys(name for row in rows for name in row)
    return {name: _column([row.get(name, np.nan) for row in rows]) for name in names}


def _column(entries: list[float | int]) -> np.ndarray:
    first = next((entry for entry in entries if isinstance(entry, int)), None)
    if first is None:
        return np.array(entries, dtype=float)
    return np.array([(entry - first) * 1e-9 if isinstance(entry, int) else np.nan for entry in entries])
