"""Where the studio listens."""

import socket

from dalembert.studio.server import _listening


def test_who_connects_before_the_pages_are_ready_waits() -> None:
    with _listening("127.0.0.1", 0) as listening, socket.create_connection(listening.getsockname(), timeout=10):
        pass
