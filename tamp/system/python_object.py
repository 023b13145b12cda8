"""An object from a Python file that the user names on a command line; the file is run."""

from __future__ import annotations

from importlib.abc import InspectLoader
from importlib.util import decode_source
from pathlib import Path
from types import CodeType, ModuleType
from typing import Any

from tamp.errors import InputError
from tamp.system.reading import read_bytes

MOST_BYTES = 10_000_000
"""The largest Python file that is read."""

OBJECT_NAME = "grounding"
"""What the object is called in the file."""


class _Text(InspectLoader):
    """Loads a module from a text that was read before."""

    def __init__(self, path: Path, source: str) -> None:
        self._path, self._source = path, source

    def get_source(self, fullname: str) -> str:
        """Return the text."""
        return self._source

    def get_code(self, fullname: str) -> CodeType:
        """Compile the text; errors in it name the file."""
        return self.source_to_code(self._source, str(self._path))


def python_source(path: Path) -> str:
    """Read a Python file, in the encoding that it says.

    Raises:
        InputError: There is no such file, or it is no text.
    """
    content = read_bytes(path, MOST_BYTES, kind="Python file")
    try:
        return decode_source(content)
    except (SyntaxError, UnicodeDecodeError) as error:
        raise InputError(f"this is no Python file: {error}", file=path) from None


def python_object(path: Path, source: str | None = None) -> Any:
    """Run a Python file and return what it calls NAME; None where it calls nothing so.

    Args:
        path: The file.
        source: What stands in it, when it was read before; the file need not be here then.

    Raises:
        InputError: There is no such file, or it fails.
    """
    if source is None:
        source = python_source(path)
    module = ModuleType(f"_own_{path.stem}")
    module.__file__ = str(path)
    try:
        _Text(path, source).exec_module(module)
    except Exception as error:
        line = error.lineno if isinstance(error, SyntaxError) else None
        raise InputError(
            f"it cannot be run: {type(error).__name__}: {error}", file=path, line=line
        ) from error
    return vars(module).get(OBJECT_NAME)
