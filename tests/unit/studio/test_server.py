"""The socket of the studio."""

import socket

from dalembert.studio.server import _listening


def test_connections_wait_until_the_pages_are_ready() -> None:
    with _listening("127.0.0.1", 0) as listening, socket.create_connection(listening.getsockname(), timeout=10):
        pass
