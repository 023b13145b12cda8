"""The page in a browser on this machine, served for as long as somebody wants to look.

Our own page and not viser's: that one plays offline, too, but has no panel for samples, skeletons
and times; and not http.server's plain handler, which would serve a folder to every page that asks.
"""

from __future__ import annotations

import contextlib
import webbrowser
from collections.abc import Callable
from dataclasses import dataclass
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer

from tamp.errors import InputError
from tamp.system.terminal import unheard

HOST = "127.0.0.1"
"""Nobody else on the network is served."""

HEADERS = {
    "Cache-Control": "no-store",
    "X-Content-Type-Options": "nosniff",
    "X-Frame-Options": "DENY",
    "Cross-Origin-Resource-Policy": "same-origin",
    "Referrer-Policy": "no-referrer",
}
"""The page is for whoever opened it, and for no page of others."""

REQUEST_TIMEOUT_S = 10.0
"""Seconds in which a request has to be told."""


@dataclass(frozen=True)
class Reply:
    """An answer to a browser.

    Attributes:
        content: Its body.
        kind: Its media type.
        status: HTTP's number.
    """

    content: bytes
    kind: str = "text/html; charset=utf-8"
    status: int = 200


NOT_FOUND = Reply(b"not found\n", "text/plain", 404)


class LocalServer(ThreadingHTTPServer):
    """Answers browsers on this machine, one thread a request. Use it as a context manager.

    A page from elsewhere, whose name was turned to us or which sends us something, is refused.

    Args:
        port: Where to listen; 0 takes any free port.
        most: Bytes that a request may bring; 0 for a server that takes nothing.

    Raises:
        InputError: The port is taken, not allowed or none.
    """

    daemon_threads = True
    allow_reuse_address = True

    def __init__(self, port: int = 0, most: int = 0) -> None:
        self.most = most
        try:
            super().__init__((HOST, port), _Handler)
        except (OSError, OverflowError) as error:
            reason = getattr(error, "strerror", None) or "there is no such port"
            raise InputError(
                f"cannot listen on port {port}: {reason}",
                remedy="Give another one with --port, or none: any free one is taken",
            ) from error

    def get(self, path: str) -> Reply:
        """Answer what a browser asks for by its path; subclasses have more to say."""
        return NOT_FOUND

    def post(self, path: str, content: bytes) -> Reply:
        """Answer what a browser sends; subclasses have more to say."""
        return NOT_FOUND

    @property
    def names(self) -> tuple[str, str]:
        """Return the names that a browser on this machine calls us."""
        port = self.server_address[1]
        shown = "" if port == 80 else f":{port}"
        return f"{HOST}{shown}", f"localhost{shown}"

    def handle_error(self, request: object, client_address: object) -> None:
        """Ignore the error: who asks wrongly, or goes away, is no matter of the user's."""

    @property
    def address(self) -> str:
        """Return the URL of the page."""
        return f"http://{HOST}:{self.server_address[1]}/"


class PageServer(LocalServer):
    """Answers with one page, whatever is asked of `/`. Use it as a context manager.

    Args:
        content: The page.
        port: Where to listen; 0 takes any free port.

    Raises:
        InputError: The port is taken, not allowed or none.
    """

    def __init__(self, content: bytes, port: int = 0) -> None:
        self.content = content
        super().__init__(port)

    def get(self, path: str) -> Reply:
        """Return the page, or not found."""
        return Reply(self.content) if path in ("/", "/index.html") else NOT_FOUND


class _Handler(BaseHTTPRequestHandler):
    timeout = REQUEST_TIMEOUT_S
    server: LocalServer  # pyright: ignore[reportIncompatibleVariableOverride]

    def do_GET(self) -> None:
        """Send what is asked for, or not found."""
        if self._is_ours():
            self._send(self.server.get(self.path.partition("?")[0]))

    def do_HEAD(self) -> None:
        """Send the headers of the answer without its content."""
        if self._is_ours():
            self._send(self.server.get(self.path.partition("?")[0]), body=False)

    def do_POST(self) -> None:
        """Take what a page of ours sends, and answer."""
        if not self._is_ours():
            return
        if not self.server.most:
            self.send_error(501, "nothing is taken here")
            return

        origin = self.headers.get("Origin", "").lower()
        kind = self.headers.get("Content-Type", "").partition(";")[0].strip().lower()
        if origin not in ("", *(f"http://{name}" for name in self.server.names)):
            self.send_error(403, "sent by a page from elsewhere")
            return
        if kind != "application/json":  # no page from elsewhere may send this unasked
            self.send_error(415, "only application/json is taken")
            return

        length = self.headers.get("Content-Length", "")
        if not length.isdecimal() or len(length) > 12:
            self.send_error(411, "how much is sent must be said")
            return
        if int(length) > self.server.most:
            self.close_connection = True
            self.send_error(413, "too much is sent")
            return
        self._send(self.server.post(self.path.partition("?")[0], self.rfile.read(int(length))))

    def log_message(self, format: str, *args: object) -> None:
        """Log nothing: the terminal is the user's."""

    def _is_ours(self) -> bool:
        """Refuse a page from elsewhere whose name was turned to us."""
        if self.headers.get("Host", "").lower() in self.server.names:
            return True
        self.send_error(421, "asked for by another name")
        return False

    def _send(self, reply: Reply, body: bool = True) -> None:
        self.send_response(reply.status)
        self.send_header("Content-Type", reply.kind)
        self.send_header("Content-Length", str(len(reply.content)))
        for name, value in HEADERS.items():
            self.send_header(name, value)
        self.end_headers()
        if body:
            with contextlib.suppress(ConnectionError):
                self.wfile.write(reply.content)


def check_browser(
    remedy: str = "Write a page with --html FILE or a picture with --png FILE, "
    "or serve with tamp-view --no-browser",
) -> None:
    """Refuse early when no browser can be opened.

    Args:
        remedy: What to do then.

    Raises:
        InputError: There is none.
    """
    try:
        webbrowser.get()
    except webbrowser.Error:
        raise InputError("no browser was found to open", remedy=remedy) from None


def serve(
    content: bytes, say: Callable[[str], None], *, port: int = 0, browser: bool = True
) -> None:
    """Serve a page and open it, until interrupted.

    Raises:
        InputError: The port cannot be had.
    """
    with PageServer(content, port) as server:
        say(f"{server.address} shows it until Ctrl-C.")
        serve_until_interrupted(server, browser)


def serve_until_interrupted(server: LocalServer, browser: bool) -> None:
    """Open the server's page, if that is wanted, and answer until interrupted."""
    if unheard():  # nobody knows where the page is; the command says so
        return
    if browser:
        webbrowser.open(server.address)
    with contextlib.suppress(KeyboardInterrupt):
        server.serve_forever()
