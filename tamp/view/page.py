"""One HTML file that shows a scene or plays a plan: everything is in it, it asks for nothing from
anywhere.
"""

from __future__ import annotations

import html
import json
import re
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from tamp.errors import InputError, printable
from tamp.system.outputs import write_whole

ASSETS = Path(__file__).resolve().parent / "assets"

SCRIPTS = ("page.js", "robot.js", "start.js")
"""Of the page, in this order, after the one that draws."""


def page(document: Mapping[str, Any]) -> str:
    """Render the HTML page of a document from `page_document`."""
    document = harmless(dict(document))
    data = json.dumps(document, ensure_ascii=True, allow_nan=False, separators=(",", ":"))
    parts = {
        "@TITLE@": html.escape(str(document["title"])),
        "@STYLE@": _asset("page.css"),
        "@SCRIPT@": "\n".join((drawing_script(), *map(_asset, SCRIPTS))),
        "@DATA@": data.replace("<", "\\u003c"),  # so that no name ends the script element
    }
    return filled(_asset("page.html"), parts)


def filled(template: str, parts: Mapping[str, str]) -> str:
    """Fill in the marks of a template, all at once: what is filled in may look like a mark."""
    marks = re.compile("|".join(parts))
    return marks.sub(lambda mark: parts[mark[0]], template)


def drawing_script() -> str:
    """Return the script that draws bodies, for any page of ours."""
    return _asset("draw.js")


def harmless(value: Any) -> Any:
    """Escape what hides or turns text around, in names out of files, in backslashes."""
    if isinstance(value, str):
        return printable(value)
    if isinstance(value, dict):
        return {name: harmless(inner) for name, inner in value.items()}
    return [harmless(inner) for inner in value] if isinstance(value, list | tuple) else value


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
