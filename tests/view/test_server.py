"""The page is served to whoever opened it on this machine, and to nobody else."""

from __future__ import annotations

import http.client
import socket
import urllib.error
import urllib.request
import webbrowser
from threading import Thread

import pytest

from tamp.errors import InputError
from tamp.view import server as module
from tamp.view.server import LocalServer, PageServer, Reply, check_browser, serve_until_interrupted


def test_the_server_answers_with_the_page_and_nothing_else() -> None:
    with PageServer(b"<!DOCTYPE html>hello") as server:
        thread = Thread(target=server.serve_forever, daemon=True)
        thread.start()
        with urllib.request.urlopen(server.address, timeout=10) as answer:
            assert (
                answer.status == 200
                and answer.headers["Content-Type"] == "text/html; charset=utf-8"
            )
            assert answer.read() == b"<!DOCTYPE html>hello"
        with pytest.raises(urllib.error.HTTPError, match="404"):
            urllib.request.urlopen(f"{server.address}etc/passwd", timeout=10)
        assert server.address.startswith("http://127.0.0.1:")
        with pytest.raises(InputError, match="cannot listen on port"):
            PageServer(b"", server.server_address[1])
        server.shutdown()
        thread.join(10)
    with pytest.raises(InputError, match="cannot listen on port 70000"):
        PageServer(b"", 70000)


@pytest.mark.parametrize(
    "host", ["evil.example", "evil.example:{port}", "", "127.0.0.1.evil.example:{port}"]
)
def test_the_server_is_asked_by_its_own_name_only(host: str) -> None:
    with PageServer(b"<!DOCTYPE html>secret") as server:
        Thread(target=server.serve_forever, daemon=True).start()
        port = server.server_address[1]
        for name, status in (
            (host.format(port=port), 421),
            (f"localhost:{port}", 200),
            (f"127.0.0.1:{port}", 200),
        ):
            connection = http.client.HTTPConnection("127.0.0.1", port, timeout=10)
            connection.request("GET", "/", headers={"Host": name})
            answer = connection.getresponse()
            assert answer.status == status and (b"secret" in answer.read()) == (status == 200)
            connection.close()
        server.shutdown()


class Taking(LocalServer):
    """A server that takes up to five bytes, and keeps them."""

    def __init__(self) -> None:
        super().__init__(most=5)
        self.sent: list[tuple[str, bytes]] = []

    def post(self, path: str, content: bytes) -> Reply:
        self.sent.append((path, content))
        return Reply(b"taken", "text/plain")


JSON = {"Content-Type": "application/json"}


@pytest.mark.parametrize(
    ("content", "headers", "status"),
    [
        (b"12345", JSON, 200),
        (b"12345", {"Content-Type": "Application/JSON; charset=utf-8"}, 200),
        (b"123456", JSON, 413),
        (b"1", {"Content-Type": "text/plain"}, 415),
        (b"1", {**JSON, "Origin": "http://evil.example"}, 403),
        (b"1", {**JSON, "Host": "evil.example"}, 421),
        (b"1", {**JSON, "Content-Length": "-1"}, 411),
    ],
)
def test_only_a_page_of_its_own_may_send_and_no_more_than_is_taken(
    content: bytes, headers: dict[str, str], status: int
) -> None:
    with Taking() as server:
        Thread(target=server.serve_forever, daemon=True).start()
        connection = http.client.HTTPConnection("127.0.0.1", server.server_address[1], timeout=10)
        connection.request("POST", "/label?1", content, headers)
        assert connection.getresponse().status == status
        connection.close()
        server.shutdown()
    assert server.sent == ([("/label", content)] if status == 200 else [])


def test_the_head_of_a_page_comes_without_the_page() -> None:
    with PageServer(b"hello") as server:
        Thread(target=server.serve_forever, daemon=True).start()
        port = server.server_address[1]
        with socket.create_connection(("127.0.0.1", port), timeout=10) as connection:
            connection.sendall(f"HEAD / HTTP/1.0\r\nHost: 127.0.0.1:{port}\r\n\r\n".encode())
            with connection.makefile("rb") as answer:
                said = answer.read()
        server.shutdown()
    assert b" 200 " in said and b"Content-Length: 5\r\n" in said and said.endswith(b"\r\n\r\n")


def test_without_a_browser_one_is_told_what_else_there_is(monkeypatch: pytest.MonkeyPatch) -> None:
    def none() -> None:
        raise webbrowser.Error

    monkeypatch.setattr(webbrowser, "get", none)
    with pytest.raises(InputError, match=r"no browser was found to open. Look at it elsewhere"):
        check_browser("Look at it elsewhere")


@pytest.mark.parametrize("heard", [True, False])
def test_a_page_of_which_nobody_could_read_is_not_served(
    heard: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    done: list[str] = []
    monkeypatch.setattr(module, "unheard", lambda: not heard)
    monkeypatch.setattr(webbrowser, "open", done.append)
    with PageServer(b"") as server:
        monkeypatch.setattr(server, "serve_forever", lambda: done.append("served"))
        serve_until_interrupted(server, browser=True)
        serve_until_interrupted(server, browser=False)
        assert done == ([server.address, "served", "served"] if heard else [])
