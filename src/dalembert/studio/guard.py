"""Who may ask the studio: this machine's own pages, or, beyond it, whoever has the token."""

import secrets
from collections.abc import Awaitable, Callable, MutableMapping
from dataclasses import dataclass
from typing import Any
from urllib.parse import quote, urlsplit

from starlette.requests import HTTPConnection
from starlette.responses import PlainTextResponse, Response
from starlette.websockets import WebSocketClose

COOKIE = "dalembert-studio"
LOCAL = ("127.0.0.1", "localhost", "[::1]")
MOST_BYTES = 210_000_000
"""Of a request: an uploaded file and what comes with it."""

Scope = MutableMapping[str, Any]
Receive = Callable[[], Awaitable[MutableMapping[str, Any]]]
Send = Callable[[MutableMapping[str, Any]], Awaitable[None]]


@dataclass(frozen=True)
class Guard:
    """Lets through what may be requested, pages and sockets alike. A page of another site cannot reach the studio
    through its user's browser: the host and the origin that the browser names must be the studio's own (a name that was
    made to point here is refused, too). Beyond this machine a token is needed as well, once in the address, then as a
    cookie; none is needed if ``token`` is empty.
    """

    app: Callable[[Scope, Receive, Send], Awaitable[None]]
    token: str = ""

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        if scope["type"] not in ("http", "websocket"):
            await self.app(scope, receive, send)
            return
        request = HTTPConnection(scope)
        answer = self._refusal(request)
        if answer is None and self.token and self._has_token(request) and scope["type"] == "http":
            cookie = f"{COOKIE}={self.token}; HttpOnly; SameSite=Strict; Path=/"
            path = "/" + quote(scope["path"].lstrip("/"))  # with two slashes it would be another site
            answer = PlainTextResponse("", 303, {"location": path, "set-cookie": cookie})
        elif answer is not None and scope["type"] == "websocket":
            answer = WebSocketClose(1008)
        await (answer or self.app)(scope, receive, send)

    def _refusal(self, request: HTTPConnection) -> Response | None:
        headers = request.headers
        host = headers.get("host", "")
        if not self.token and host.rpartition(":")[0] not in LOCAL and host not in LOCAL:
            return PlainTextResponse(
                "This studio answers under its own address only, such as http://127.0.0.1:8080.", 403
            )
        origin = headers.get("origin")
        if origin not in (None, "null") and urlsplit(origin).netloc != host:
            return PlainTextResponse("This request comes from another site, and is refused.", 403)
        length = headers.get("content-length", "0")
        if not length.isdigit() or int(length) > MOST_BYTES:
            return PlainTextResponse(f"The file is too large: a request may have {MOST_BYTES} bytes.", 413)
        if self.token and not self._has_token(request) and not self._is_token(request.cookies.get(COOKIE, "")):
            opened = "Open the address that 'dalembert studio' printed when it started: it has the token in it."
            return PlainTextResponse(opened, 401)
        return None

    def _has_token(self, request: HTTPConnection) -> bool:
        return self._is_token(request.query_params.get("token", ""))

    def _is_token(self, token: str) -> bool:
        return secrets.compare_digest(token.encode(), self.token.encode())
