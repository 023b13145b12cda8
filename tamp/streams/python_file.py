"""A grounding written in Python, from a file that the user names on the command line."""

from __future__ import annotations

from collections.abc import Mapping
from importlib.abc import InspectLoader
from importlib.util import decode_source
from pathlib import Path
from types import CodeType, ModuleType

from tamp.errors import InputError
from tamp.reading import read_bytes
from tamp.streams.choice import GIVEN, MODES, Grounding
from tamp.streams.relations import Classifier, Generator

SUFFIX = ".py"

MOST_BYTES = 10_000_000
"""The largest Python file that is read."""

NAME = "grounding"
"""What the object is called in the file."""


class _Text(InspectLoader):
    """Loads a module from a text that was read before."""

    def __init__(self, path: Path, source: str) -> None:
        self._path, self._source = path, source

    def get_source(self, fullname: str) -> str:
        """The text."""
        return self._source

    def get_code(self, fullname: str) -> CodeType:
        """The text, compiled; errors in it name the file."""
        return self.source_to_code(self._source, str(self._path))


def given_by_files(
    samplers: Mapping[str, str], sources: Mapping[str, str] | None = None
) -> tuple[dict[str, str], dict[str, Grounding]]:
    """Part what `--sampler` says into names, for `load_problem(samplers=)`, and objects, for its `groundings`.

    A file is run, so only a command line may name one: what comes with a problem or a plan does not run.

    Args:
        samplers: Relation to NAME or FILE.py, or either with a mode.
        sources: What stands in the files, by name, where that is known already: then they are not read.

    Raises:
        InputError: As for `python_grounding`.
    """
    names, objects = dict(samplers), dict[str, Grounding]()
    for relation, text in samplers.items():
        file, mode = parted(text)
        if Path(file).suffix == SUFFIX:
            objects[relation] = python_grounding(Path(file), (sources or {}).get(file))
            names[relation] = f"{GIVEN}{mode}"
    return names, objects


def parted(text: str) -> tuple[str, str]:
    """A sampler's name or file, and its mode with the colon before it, if it has one."""
    mode = next((f":{mode}" for mode in MODES if text.endswith(f":{mode}")), "")
    return text.removesuffix(mode) if mode else text, mode


def python_source(path: Path) -> str:
    """What stands in a Python file, in the encoding that it says.

    Raises:
        InputError: There is no such file, or it is no text.
    """
    content = read_bytes(path, MOST_BYTES, kind="Python file")
    try:
        return decode_source(content)
    except (SyntaxError, UnicodeDecodeError) as error:
        raise InputError(f"this is no Python file: {error}", file=path) from None


def python_grounding(path: Path, source: str | None = None) -> Grounding:
    """The object of name NAME in a Python file, which is run.

    Args:
        path: The file.
        source: What stands in it, when it was read before; the file need not be here then.

    Raises:
        InputError: There is no such file, it fails, or it has no such object with `propose` or `classify`.
    """
    if source is None:
        source = python_source(path)
    loader = _Text(path, source)
    module = ModuleType(f"_own_{path.stem}")
    module.__file__ = str(path)
    try:
        loader.exec_module(module)
    except Exception as error:
        line = error.lineno if isinstance(error, SyntaxError) else None
        raise InputError(f"it cannot be run: {type(error).__name__}: {error}", file=path, line=line) from error
    found = vars(module).get(NAME)
    if isinstance(found, type) or not isinstance(found, Generator | Classifier):
        what = f"'{NAME}' has neither propose nor classify" if found is not None else f"it defines no '{NAME}'"
        what = f"'{NAME}' is a class, not an object" if isinstance(found, type) else what
        remedy = f"{NAME} = Mine(), an object with the methods of tamp/streams/relations.py"
        raise InputError(what, file=path, remedy=remedy)
    return found
