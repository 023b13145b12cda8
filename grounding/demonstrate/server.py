"""The page of demonstrations, served on this machine: itself, pictures, and what is done on it."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

from grounding.demonstrate.studio import Message, Studio
from tamp.errors import InputError
from tamp.view.page import drawing_script, filled
from tamp.view.server import NOT_FOUND, LocalServer, Reply

ASSETS = Path(__file__).resolve().parent / "assets"

MOST = 200_000
"""Bytes that the page sends at once: the poses of a scene's bodies are some thousands."""


class DemonstrationServer(LocalServer):
    """Serves a studio to the browser. Use it as a context manager.

    Args:
        studio: What is shown, and does what the page asks for.
        port: Where to listen; 0 takes any free port.

    Raises:
        InputError: The port is taken, not allowed or none.
    """

    def __init__(self, studio: Studio, port: int = 0) -> None:
        self._studio = studio
        self._page = demonstration_page().encode()
        super().__init__(port, most=MOST)

    def get(self, path: str) -> Reply:
        """Return the page, what it shows, how far a command is, the last plan, or a thumbnail."""
        if path in ("/", "/index.html"):
            return Reply(self._page)
        if path == "/state":
            return _json(self._studio.state())
        if path == "/run":
            return _json(self._studio.run_state())
        if path == "/plan.html":
            return self._watched()
        if path.startswith("/thumbnails/"):
            content = self._studio.picture(path.removeprefix("/thumbnails/"))
            return NOT_FOUND if content is None else Reply(content, "image/png")
        return NOT_FOUND

    def _watched(self) -> Reply:
        """Return the page on which the last plan is watched."""
        try:
            return Reply(self._studio.uses.page.read_bytes())
        except OSError:
            return NOT_FOUND

    def post(self, path: str, content: bytes) -> Reply:
        """Do what the page asks for; what cannot be done is said in words, with status 400."""
        try:
            message = _read(content)
            return _json(self._studio.act(path.removeprefix("/"), message))
        except InputError as error:
            return _json({"error": str(error)}, 400)


def demonstration_page() -> str:
    """Return the page: one file that asks nobody else for anything."""
    script = f"{drawing_script()}\n" + "\n".join(
        _asset(name) for name in ("hands.js", "demonstrate.js")
    )
    return filled(
        _asset("demonstrate.html"), {"@STYLE@": _asset("demonstrate.css"), "@SCRIPT@": script}
    )


def _asset(name: str) -> str:
    return (ASSETS / name).read_text(encoding="utf-8").strip()


def _read(content: bytes) -> Message:
    try:
        message = json.loads(content)
    except (ValueError, RecursionError):
        raise InputError("the page sent no JSON") from None
    if not isinstance(message, dict):
        raise InputError("the page sent something else than an object")
    return message


def _json(message: Any, status: int = 200) -> Reply:
    text = json.dumps(message, ensure_ascii=True, allow_nan=False, separators=(",", ":"))
    return Reply(text.encode(), "application/json", status)
