"""Who is let in to the studio."""

import asyncio

import pytest

from dalembert.studio.guard import COOKIE, MOST_BYTES, Guard

TOKEN = "a-token-that-nobody-guesses"
HERE = {"host": "127.0.0.1:8080"}
THERE = {"host": "lab.example:8080"}


def asked(
    token: str = "", headers: dict | None = None, query: str = "", kind: str = "http", path: str = "/run/a"
) -> tuple[int | str, dict]:
    """Status of an answer, or "let through", and the answer's headers."""
    sent, through = [], []

    async def app(scope, receive, send):
        through.append(scope)

    async def send(message):
        sent.append(message)

    scope = {
        "type": kind,
        "path": path,
        "query_string": query.encode(),
        "headers": [(name.encode(), value.encode()) for name, value in (headers or HERE).items()],
    }
    asyncio.run(Guard(app, token)(scope, None, send))  # type: ignore[arg-type]
    if through:
        return "let through", {}
    first = sent[0]
    return first.get("status", first.get("code")), {
        name.decode(): text.decode() for name, text in first.get("headers", ())
    }


@pytest.mark.parametrize("host", ["127.0.0.1:8080", "localhost:8080", "[::1]:8080", "localhost"])
@pytest.mark.parametrize("kind", ["http", "websocket"])
def test_this_machine_is_let_in(host, kind):
    assert asked(headers={"host": host, "origin": f"http://{host}"}, kind=kind)[0] == "let through"


@pytest.mark.parametrize(("kind", "status"), [("http", 403), ("websocket", 1008)])
def test_pages_of_other_sites_and_names_made_to_point_here_are_not(kind, status):
    assert asked(headers={"host": "evil.example"}, kind=kind)[0] == status
    assert asked(headers={"host": "evil.127.0.0.1:80"}, kind=kind)[0] == status
    assert asked(headers={**HERE, "origin": "https://evil.example"}, kind=kind)[0] == status


def test_beyond_this_machine_a_token_is_asked_for_once():
    assert asked(TOKEN, THERE)[0] == 401
    assert asked(TOKEN, THERE, "token=wrong")[0] == 401
    assert asked(TOKEN, THERE, "token=%C3%A4")[0] == 401
    status, headers = asked(TOKEN, THERE, f"token={TOKEN}")
    assert (status, headers["location"]) == (303, "/run/a")
    assert headers["set-cookie"] == f"{COOKIE}={TOKEN}; HttpOnly; SameSite=Strict; Path=/"
    assert asked(TOKEN, {**THERE, "cookie": f"{COOKIE}={TOKEN}"})[0] == "let through"
    assert asked(TOKEN, {**THERE, "cookie": f"{COOKIE}=wrong"})[0] == 401
    assert asked(TOKEN, THERE, kind="websocket")[0] == 1008
    assert asked(TOKEN, {**THERE, "cookie": f"{COOKIE}={TOKEN}"}, kind="websocket")[0] == "let through"


@pytest.mark.parametrize(
    ("path", "location"),
    [
        ("/run/π", "/run/%CF%80"),
        ("/run/日本", "/run/%E6%97%A5%E6%9C%AC"),
        ("/run/ü b", "/run/%C3%BC%20b"),
        ("/run/a\r\nX: y", "/run/a%0D%0AX%3A%20y"),
        ("//evil.example/a", "/evil.example/a"),
        ("/", "/"),
    ],
)
def test_the_way_on_from_an_address_with_a_token_is_that_page_of_this_site(path, location):
    status, headers = asked(TOKEN, THERE, f"token={TOKEN}", path=path)
    assert (status, headers["location"]) == (303, location)


@pytest.mark.parametrize("length", [str(MOST_BYTES + 1), "-1", "many"])
def test_what_is_too_large_is_refused_before_it_is_read(length):
    assert asked(headers={**HERE, "content-length": length})[0] == 413
