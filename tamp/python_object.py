"""An object from a Python file that the user names on a command line; the file is run."""

from __future__ import annotations

import importlib.util
from pathlib import Path
from typing import Any

from tamp.errors import InputError

NAME = "grounding"
"""What the object is called in the file."""


def python_object(path: Path) -> Any:
    """What a Python file calls NAME; None where it calls nothing so.

    Raises:
        InputError: There is no such file, or it fails.
    """
    if not path.is_file():
        raise InputError("no such file", file=path)
    spec = importlib.util.spec_from_file_location(f"_own_{path.stem}", path)
    if spec is None or spec.loader is None:
        raise InputError("this is no Python file", file=path)
    module = importlib.util.module_from_spec(spec)
    try:
        spec.loader.exec_module(module)
    except Exception as error:
        line = error.lineno if isinstance(error, SyntaxError) else None
        raise InputError(f"it cannot be run: {type(error).__name__}: {error}", file=path, line=line) from error
    return vars(module).get(NAME)
