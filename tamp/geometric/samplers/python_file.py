"""A grounding written in Python, from a file that the user names on the command line."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

from tamp.errors import InputError
from tamp.geometric.samplers.choice import SAMPLER_MODES, USER_OBJECT, Grounding
from tamp.geometric.samplers.sampler import Classifier, Generator
from tamp.system.python_object import OBJECT_NAME, python_object

PYTHON_SUFFIX = ".py"


def given_by_files(
    samplers: Mapping[str, str], sources: Mapping[str, str] | None = None
) -> tuple[dict[str, str], dict[str, Grounding]]:
    """Part what `--sampler` says into names, for `load_problem(samplers=)`, and objects, for its
    `groundings`.

    A file is run, so only a command line may name one: what comes with a problem or a plan does not
    run.

    Args:
        samplers: Relation to NAME or FILE.py, or either with a mode.
        sources: What stands in the files, by name, where that is known already: then they are not
            read.

    Raises:
        InputError: As for `python_grounding`.
    """
    names, objects = dict(samplers), dict[str, Grounding]()
    for relation, text in samplers.items():
        file, mode = parted(text)
        if Path(file).suffix == PYTHON_SUFFIX:
            objects[relation] = python_grounding(Path(file), (sources or {}).get(file))
            names[relation] = f"{USER_OBJECT}{mode}"
    return names, objects


def parted(text: str) -> tuple[str, str]:
    """Split a sampler's name or file from its mode with the colon before it, if it has one."""
    mode = next((f":{mode}" for mode in SAMPLER_MODES if text.endswith(f":{mode}")), "")
    return text.removesuffix(mode) if mode else text, mode


def python_grounding(path: Path, source: str | None = None) -> Grounding:
    """Load the object of name NAME from a Python file, which is run.

    Args:
        path: The file.
        source: What stands in it, when it was read before; the file need not be here then.

    Raises:
        InputError: There is no such file, it fails, or it has no such object with `propose` or
            `classify`.
    """
    found = python_object(path, source)
    if isinstance(found, type) or not isinstance(found, Generator | Classifier):
        what = (
            f"'{OBJECT_NAME}' has neither propose nor classify"
            if found is not None
            else f"it defines no '{OBJECT_NAME}'"
        )
        what = f"'{OBJECT_NAME}' is a class, not an object" if isinstance(found, type) else what
        methods = "the methods of tamp/geometric/samplers/sampler.py"
        remedy = f"{OBJECT_NAME} = Mine(), an object with {methods}"
        raise InputError(what, file=path, remedy=remedy)
    return found
