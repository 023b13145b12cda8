"""A grounding written in Python, from a file that the user names on the command line."""

from __future__ import annotations

from pathlib import Path

from tamp.errors import InputError
from tamp.python_object import NAME, python_object
from tamp.streams.choice import GIVEN, MODES, Grounding
from tamp.streams.relations import Classifier, Generator

SUFFIX = ".py"


def given_by_files(samplers: dict[str, str]) -> tuple[dict[str, str], dict[str, Grounding]]:
    """Part what `--sampler` says into names, for `load_problem(samplers=)`, and objects, for its `groundings`.

    A file is run, so only a command line may name one: what comes with a problem or a plan does not run.

    Args:
        samplers: Relation to NAME or FILE.py, or either with a mode.

    Raises:
        InputError: As for `python_grounding`.
    """
    names, objects = dict(samplers), dict[str, Grounding]()
    for relation, text in samplers.items():
        file, colon, mode = (
            text.rpartition(":") if text.endswith(tuple(f":{mode}" for mode in MODES)) else (text, "", "")
        )
        if Path(file).suffix == SUFFIX:
            objects[relation] = python_grounding(Path(file))
            names[relation] = f"{GIVEN}{colon}{mode}"
    return names, objects


def python_grounding(path: Path) -> Grounding:
    """The object of name NAME in a Python file, which is run.

    Raises:
        InputError: There is no such file, it fails, or it has no such object with `propose` or `classify`.
    """
    found = python_object(path)
    if isinstance(found, type) or not isinstance(found, Generator | Classifier):
        what = f"'{NAME}' has neither propose nor classify" if found is not None else f"it defines no '{NAME}'"
        what = f"'{NAME}' is a class, not an object" if isinstance(found, type) else what
        remedy = f"{NAME} = Mine(), an object with the methods of tamp/streams/relations.py"
        raise InputError(what, file=path, remedy=remedy)
    return found
