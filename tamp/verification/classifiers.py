"""The classifiers that a user gives the judge: RELATION=FILE, a Python file or learned weights."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path

from tamp.errors import InputError
from tamp.geometric.scene.classifier import Classifier, NoClassifier
from tamp.system.python_object import python_object

SAMPLER_MODES = (":mixed", ":alone")
"""What tamp-solve reads after a sampler's name, and the judge may read as well: it says nothing of
the classifier.
"""


def classifiers_of(pairs: Iterable[str]) -> dict[str, Classifier]:
    """Load classifiers, by relation; one that ships by its name, as in stack=learned.

    Raises:
        InputError: Something else than RELATION=FILE; a file that cannot be used, or without a
            classifier; a name that does not ship.
    """
    found: dict[str, Classifier] = {}
    for pair in pairs:
        relation, equals, name = pair.partition("=")
        if not (relation and equals and name):
            remedy = "For example: --sampler upright=upright.py"
            raise InputError(f"--sampler wants RELATION=FILE, not '{pair}'", remedy=remedy)

        for mode in SAMPLER_MODES:
            name = name.removesuffix(mode)
        made = _made(relation.lower(), Path(name))

        if isinstance(made, NoClassifier):
            raise InputError(
                f"the classifier of '{relation}' cannot tell yet: {made.cannot_tell}", file=name
            )
        if isinstance(made, type) or not isinstance(made, Classifier):
            what = (
                f"'{relation}' has no classifier here: "
                "no object 'grounding' with the method classify"
            )
            raise InputError(
                what, file=name, remedy="classify(scene, arguments) returns a probability"
            )
        found[relation.lower()] = made

    return found


def _made(relation: str, file: Path) -> object:
    if file.suffix == ".py":
        return python_object(file)
    from grounding.registry import GROUNDINGS, LEARNED, file_grounding  # they need numpy only

    if file.suffix == ".safetensors":
        return file_grounding(relation, file)
    shipped = GROUNDINGS[relation] if relation in LEARNED else {}
    if str(file) not in shipped:
        what = f"the judge knows no sampler '{file}' for '{relation}'"
        remedy = "Give the classifier's file: FILE.py or FILE.safetensors"
        raise InputError(what, found=str(file), choices=shipped, remedy=remedy)
    return shipped[str(file)]()
