"""One HTML file that shows a scene or plays a plan: everything is in it, it asks for nothing from anywhere."""

from __future__ import annotations

import html
import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from tamp.data import write_whole
from tamp.errors import InputError

ASSETS = Path(__file__).resolve().parent / "assets"


def page(document: Mapping[str, Any]) -> str:
    """The page of a document from `page_document`."""
    data = json.dumps(document, ensure_ascii=True, allow_nan=False, separators=(",", ":"))
    parts = {
        "@TITLE@": html.escape(str(document["title"])),
        "@STYLE@": _asset("page.css"),
        "@SCRIPT@": f"{_asset('draw.js')}\n{_asset('page.js')}",
        "@DATA@": data.replace("<", "\\u003c"),  # so that no name ends the script element
    }
    text = _asset("page.html")
    for mark, content in parts.items():
        before, _, after = text.partition(mark)
        text = f"{before}{content}{after}"
    return text


def write_page(document: Mapping[str, Any], file: Path) -> None:
    """Write the page, whole or not at all. Folders are made.

    Raises:
        InputError: The file cannot be written.
    """
    try:
        write_whole(file, page(document).encode())
    except OSError as error:
        raise InputError(f"cannot write the page: {error.strerror}", file=file) from error


def _asset(name: str) -> str:
    return (ASSETS / name).read_text(encoding="utf-8").strip()
