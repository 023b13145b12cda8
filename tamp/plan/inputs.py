"""The files that a plan was made from, with their hashes, as the plan file tells them."""

from __future__ import annotations

import hashlib
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from tamp.errors import InputError


def inputs_document(files: Mapping[str, Sequence[Path]]) -> dict[str, Any]:
    """Describe a problem's files by role; those of a robot only where it is the user's own.

    Raises:
        InputError: One of them is gone.
    """
    document: dict[str, Any] = {
        role: _file(files[role][0]) for role in ("problem", "domain", "streams")
    }
    document["meshes"] = [_file(path) for path in files["meshes"]]
    if files["robot"]:
        document["robot"] = [_file(path) for path in files["robot"]]
    return document


def _file(path: Path) -> dict[str, str]:
    try:
        return {"path": str(path), "sha256": hashlib.sha256(path.read_bytes()).hexdigest()}
    except OSError as error:
        raise InputError(f"it cannot be read any more: {error.strerror}", file=path) from error
