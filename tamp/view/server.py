"""The page in a browser on this machine, served for as long as somebody wants to look."""

from __future__ import annotations

import contextlib
import webbrowser
from collections.abc import Callable
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

PATIENCE = 10.0
"""Seconds in which a request has to be told."""


class PageServer(ThreadingHTTPServer):
    """Answers with one page, whatever is asked of `/`. Use it as a context manager.

    Args:
        content: The page.
        port: Where to listen; 0 takes any free port.

    Raises:
        InputError: The port is taken, not allowed or none.
    """

    daemon_threads = True
    allow_reuse_address = True

    def __init__(self, content: bytes, port: int = 0) -> None:
        self.content = content
        try:
            super().__init__((HOST, port), _Handler)
        except (OSError, OverflowError) as error:
            reason = getattr(error, "strerror", None) or "there is no such port"
            raise InputError(
                f"cannot listen on port {port}: {reason}",
                remedy="Give another one with --port, or none: any free one is taken",
            ) from error

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


class _Handler(BaseHTTPRequestHandler):
    timeout = PATIENCE
    server: PageServer  # pyright: ignore[reportIncompatibleVariableOverride]

    def do_GET(self) -> None:
        """Send the page, or not found."""
        self._answer(body=True)

    def do_HEAD(self) -> None:
        """Send the headers of the page without its content."""
        self._answer(body=False)

    def log_message(self, format: str, *args: object) -> None:
        """Log nothing: the terminal is the user's."""

    def _answer(self, body: bool) -> None:
        if self.headers.get("Host", "").lower() not in self.server.names:
            self.send_error(
                421, "asked for by another name"
            )  # a page from elsewhere whose name was turned to us
            return
        found = self.path.partition("?")[0] in ("/", "/index.html")
        content = self.server.content if found else b"not found\n"
        self.send_response(200 if found else 404)
        self.send_header("Content-Type", "text/html; charset=utf-8" if found else "text/plain")
        self.send_header("Content-Length", str(len(content)))
        for name, value in HEADERS.items():
            self.send_header(name, value)
        self.end_headers()
        if body:
            with contextlib.suppress(ConnectionError):
                self.wfile.write(content)


def check_browser() -> None:
    """Refuse early when no browser can be opened.

    Raises:
        InputError: There is none.
    """
    try:
        webbrowser.get()
    except webbrowser.Error:
        raise InputError(
            "no browser was found to open",
            remedy="Write a page with --html FILE or a picture with --png FILE, "
            "or serve with tamp-view --no-browser",
        ) from None


def serve(
    content: bytes, say: Callable[[str], None], *, port: int = 0, browser: bool = True
) -> None:
    """Serve a page and open it, until interrupted.

    Raises:
        InputError: The port cannot be had.
    """
    with PageServer(content, port) as server:
        say(f"{server.address} shows it until Ctrl-C.")
        if unheard():  # nobody knows where the page is; the command says so
            return
        if browser:
            webbrowser.open(server.address)
        with contextlib.suppress(KeyboardInterrupt):
            server.serve_forever()
