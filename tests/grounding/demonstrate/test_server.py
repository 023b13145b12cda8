"""The server: only the page that it serves may ask for anything, and within bounds."""

from __future__ import annotations

import http.client
import json
import re
import socket
from collections.abc import Callable, Iterator
from threading import Thread
from typing import Any

import pytest

from grounding.demonstrate.server import MOST, DemonstrationServer, demonstration_page
from grounding.demonstrate.studio import Studio
from tamp.view.server import PageServer

JSON = {"Content-Type": "application/json"}


@pytest.fixture
def server(studio_of: Callable[..., Studio]) -> Iterator[DemonstrationServer]:
    with DemonstrationServer(studio_of("stack(a, b)")) as opened:
        thread = Thread(target=opened.serve_forever, daemon=True)
        thread.start()
        yield opened
        opened.shutdown()
        thread.join(10)


def ask(
    server: DemonstrationServer,
    path: str,
    content: bytes | None = None,
    headers: dict[str, str] | None = None,
) -> tuple[int, bytes, http.client.HTTPMessage]:
    connection = http.client.HTTPConnection("127.0.0.1", server.server_address[1], timeout=30)
    kind = "GET" if content is None else "POST"
    connection.request(
        kind, path, content, {**(JSON if content is not None else {}), **(headers or {})}
    )
    answer = connection.getresponse()
    result = answer.status, answer.read(), answer.headers
    connection.close()
    return result


def test_the_page_asks_nobody_else_for_anything() -> None:
    page = demonstration_page()
    assert "connect-src 'self'" in page and not re.search(r"https?://", page)
    assert "@STYLE@" not in page and "@SCRIPT@" not in page


def test_page_state_and_pictures(server: DemonstrationServer) -> None:
    status, content, headers = ask(server, "/")
    assert (
        status == 200
        and content.startswith(b"<!DOCTYPE html>")
        and headers["Cache-Control"] == "no-store"
    )
    status, content, headers = ask(server, "/state")
    assert status == 200 and headers["Content-Type"] == "application/json"
    number = json.loads(content)["stage"]["number"]
    message = {"stage": number, "poses": {}, "holds": False, "anyway": True}
    status, content, _ = ask(server, "/label", json.dumps(message).encode())
    assert status == 200 and json.loads(content)["saved"] == "stack_001.yaml"
    status, content, headers = ask(server, "/thumbnails/stack_001.yaml?1")
    assert (
        status == 200 and headers["Content-Type"] == "image/png" and content.startswith(b"\x89PNG")
    )
    for path in ("/thumbnails/stack_002.yaml", "/thumbnails/", "/etc/passwd", "/label"):
        assert ask(server, path)[0] == 404


@pytest.mark.parametrize(
    "host", ["evil.example", "evil.example:{port}", "", "127.0.0.1.evil.example:{port}"]
)
def test_by_another_name_nothing_is_told_or_done(host: str, server: DemonstrationServer) -> None:
    named = {"Host": host.format(port=server.server_address[1])}
    assert ask(server, "/state", headers=named)[0] == 421
    assert ask(server, "/next", b"{}", named)[0] == 421


@pytest.mark.parametrize(
    ("headers", "status"),
    [
        ({"Origin": "http://evil.example"}, 403),
        ({"Origin": "null"}, 403),
        ({"Origin": "https://127.0.0.1:{port}"}, 403),
        ({"Content-Type": "text/plain"}, 415),
        ({"Content-Type": "application/x-www-form-urlencoded"}, 415),
        ({"Origin": "http://127.0.0.1:{port}"}, 200),
        (
            {
                "Origin": "http://localhost:{port}",
                "Content-Type": "application/json; charset=utf-8",
            },
            200,
        ),
    ],
)
def test_pages_from_elsewhere_do_nothing(
    headers: dict[str, str], status: int, server: DemonstrationServer
) -> None:
    port = server.server_address[1]
    headers = {name: value.format(port=port) for name, value in headers.items()}
    before = json.loads(ask(server, "/state")[1])["stage"]["number"]
    assert ask(server, "/next", b"{}", headers)[0] == status
    assert json.loads(ask(server, "/state")[1])["stage"]["number"] == before + (status == 200)


@pytest.mark.parametrize(
    "content",
    [
        b"",
        b"{",
        b"[]",
        b"7",
        b"nan",
        b"\xff\xfe",
        b'{"a": 1' + b"0" * 5000 + b"}",
        b"[" * 50_000,
        b'{"text": 1e999}',
    ],
)
def test_what_is_no_message_is_an_error_in_words(
    content: bytes, server: DemonstrationServer
) -> None:
    status, answer, _ = ask(server, "/relation", content)
    assert status == 400 and json.loads(answer)["error"]


def test_too_much_is_not_even_read(server: DemonstrationServer) -> None:
    with socket.create_connection(server.server_address, timeout=30) as connection:
        host = f"127.0.0.1:{server.server_address[1]}"
        head = f"POST /next HTTP/1.1\r\nHost: {host}\r\nContent-Type: application/json\r\n"
        connection.sendall(f"{head}Content-Length: {MOST + 1}\r\n\r\n".encode())
        assert b" 413 " in connection.recv(1000)
    for length in ("", "-5", "many", "1" * 50):
        with socket.create_connection(server.server_address, timeout=30) as connection:
            said = f"Content-Length: {length}\r\n" if length else ""
            connection.sendall(f"{head}{said}\r\n".encode())
            assert b" 411 " in connection.recv(1000)


def test_many_tabs_at_once(server: DemonstrationServer) -> None:
    answers: list[int] = []

    def label() -> None:
        for _ in range(5):
            number = json.loads(ask(server, "/state")[1])["stage"]["number"]
            message: dict[str, Any] = {"stage": number, "poses": {}, "holds": False, "anyway": True}
            answers.append(ask(server, "/label", json.dumps(message).encode())[0])

    threads = [Thread(target=label) for _ in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join(120)
    assert answers == [200] * 20
    assert len(json.loads(ask(server, "/state")[1])["cards"]) == 20


def test_the_viewer_takes_nothing() -> None:
    with PageServer(b"<!DOCTYPE html>") as viewer:
        thread = Thread(target=viewer.serve_forever, daemon=True)
        thread.start()
        connection = http.client.HTTPConnection("127.0.0.1", viewer.server_address[1], timeout=30)
        connection.request("POST", "/", b"{}", JSON)
        assert connection.getresponse().status == 501
        viewer.shutdown()
        thread.join(10)
