"""Who may ask the studio: this machine's own pages, or, beyond it, whoever has the token."""

import secrets
from collections.abc import Awaitable, Callable, MutableMapping
from dataclasses import dataclass
from http.cookies import SimpleCookie
from typing import Any
from urllib.parse import parse_qs, quote, urlsplit

COOKIE = "dalembert-studio"
LOCAL = ("127.0.0.1", "localhost", "[::1]")
MOST_BYTES = 210_000_000
"""Of a request: an uploaded file and what comes with it."""

Scope = MutableMapping[str, Any]
Receive = Callable[[], Awaitable[MutableMapping[str, Any]]]
Send = Callable[[MutableMapping[str, Any]], Awaitable[None]]


@dataclass(frozen=True)
class Guard:
    """Lets through what may be asked, pages and sockets alike.

    A page of another site cannot reach the studio through its user's browser: the host and the origin that the browser
    names must be the studio's own (a name that was made to point here is refused, too). Beyond this machine a token is
    asked for as well, once in the address, then as a cookie.

    Parameters
    ----------
    app : ASGI application
    token : str
        None needed if empty.
    """

    app: Callable[[Scope, Receive, Send], Awaitable[None]]
    token: str = ""

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        if scope["type"] not in ("http", "websocket"):
            await self.app(scope, receive, send)
            return
        headers = {name.decode("latin-1").lower(): value.decode("latin-1") for name, value in scope["headers"]}
        refusal = self._refusal(scope, headers)
        if refusal is not None:
            await _answer(scope, send, *refusal)
        elif self.token and self._given(scope) and scope["type"] == "http":
            cookie = f"{COOKIE}={self.token}; HttpOnly; SameSite=Strict; Path=/"
            path = "/" + quote(scope["path"].lstrip("/"))  # with two slashes it would be another site
            await _answer(scope, send, 303, "", [("location", path), ("set-cookie", cookie)])
        else:
            await self.app(scope, receive, send)

    def _refusal(self, scope: Scope, headers: dict[str, str]) -> tuple[int, str] | None:
        """Status and sentence for what may not be asked."""
        host = headers.get("host", "")
        if not self.token and host.rpartition(":")[0] not in LOCAL and host not in LOCAL:
            return 403, "This studio answers under its own address only, such as http://127.0.0.1:8080."
        origin = headers.get("origin")
        if origin not in (None, "null") and urlsplit(origin).netloc != host:
            return 403, "This request comes from another site, and is refused."
        length = headers.get("content-length", "0")
        if not length.isdigit() or int(length) > MOST_BYTES:
            return 413, f"The file is too large: a request may have {MOST_BYTES} bytes."
        if self.token and not self._given(scope) and not self._known(headers):
            return 401, "Open the address that 'dalembert studio' printed when it started: it has the token in it."
        return None

    def _given(self, scope: Scope) -> bool:
        """Whether the address has the token."""
        given = parse_qs(scope.get("query_string", b"").decode("latin-1")).get("token", [""])[0]
        return secrets.compare_digest(given.encode(), self.token.encode())

    def _known(self, headers: dict[str, str]) -> bool:
        """Whether the browser had the token before."""
        cookie = SimpleCookie(headers.get("cookie", "")).get(COOKIE)
        return cookie is not None and secrets.compare_digest(cookie.value.encode(), self.token.encode())


async def _answer(
    scope: Scope, send: Send, status: int, text: str, headers: list[tuple[str, str]] | None = None
) -> None:
    """A short answer in place of the application's."""
    if scope["type"] == "websocket":
        await send({"type": "websocket.close", "code": 1008})
        return
    given = [("content-type", "text/plain; charset=utf-8"), *(headers or [])]
    raw = [(name.encode("latin-1"), value.encode("latin-1")) for name, value in given]
    await send({"type": "http.response.start", "status": status, "headers": raw})
    await send({"type": "http.response.body", "body": text.encode()})
