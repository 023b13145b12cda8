"""Weights of a learned relation: the house's arrays and card, and back."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import fields
from typing import Any

import numpy as np
from numpy.typing import NDArray

from grounding.certainty import REASON
from grounding.relations.catalogue import catalogue
from grounding.relations.charts import MODES, Carried
from grounding.relations.committee import Committee
from grounding.relations.generator import PoseGenerator
from grounding.relations.learner import Learned
from grounding.weights import Weights
from tamp.errors import InputError

MODEL = "conjunctions"
"""What the card calls it."""

VERSION = 2
"""Of the catalogue of measures: weights of another one are refused."""

KINDS = ("movable", "fixed", "surface", "container")

_COMMITTEE = tuple(one.name for one in fields(Committee) if one.init and one.name != "arguments")
_CARRIED = tuple(one.name for one in fields(Carried))


def weights_of(learned: Learned, card: Mapping[str, Any]) -> Weights:
    """Return what was learned as arrays and a card; `card` is added to it."""
    arrays: dict[str, NDArray[Any]] = {}
    for prefix, committee in (
        ("classifier", learned.committee),
        ("ranking", learned.generator.committee),
    ):
        arrays |= {f"{prefix}_{name}": _finite(getattr(committee, name)) for name in _COMMITTEE}
    arrays |= {f"shown_{name}": getattr(learned.generator.shown, name) for name in _CARRIED}

    held_out = learned.held_out
    said = {
        "model": MODEL,
        "version": VERSION,
        "relation": learned.relation,
        "kinds": list(learned.kinds),
        "level": learned.generator.level,
        "steady": learned.generator.steady,
        "classifies": not learned.cannot_tell,
        "samples": sum(learned.count),
        "positive": learned.count[0],
        "held out": None if held_out is None else [held_out.positive, held_out.negative],
        **card,
    }
    if learned.cannot_tell:
        said[REASON] = learned.cannot_tell
    return Weights(arrays, said)


def read_learned(weights: Weights) -> tuple[tuple[str, ...], Committee, PoseGenerator]:
    """Return the arguments' kinds, the classifier and the generator of weights.

    Raises:
        InputError: They are no such weights, of another version, or do not fit together.
    """
    card = weights.card
    if card.get("version") != VERSION:
        raise InputError(
            f"these weights are of version {card.get('version')!r}, not {VERSION}",
            remedy="Learn it again: tamp-learn new --help",
        )

    kinds = card.get("kinds")
    if not isinstance(kinds, list) or not kinds or not all(one in KINDS for one in kinds):
        raise InputError("the card's 'kinds' are not those of a relation's arguments")
    try:
        committee = _committee(weights, "classifier", len(kinds))
        ranking = _committee(weights, "ranking", len(kinds))
        shown = Carried(*(weights.arrays[f"shown_{name}"] for name in _CARRIED))
    except KeyError as error:
        raise InputError(f"array {error} is missing") from None

    level = card.get("level")
    if not isinstance(level, int) or abs(level) >= len(kinds) or isinstance(level, bool):
        raise InputError(f"the card's 'level' is {level!r}")
    _check_carried(shown, len(kinds))
    return tuple(kinds), committee, PoseGenerator(ranking, shown, level, bool(card.get("steady")))


def _committee(weights: Weights, prefix: str, arguments: int) -> Committee:
    arrays = {name: weights.arrays[f"{prefix}_{name}"] for name in _COMMITTEE}
    for name in ("low", "high"):
        big = np.abs(arrays[name]) >= BEYOND
        arrays[name] = np.where(big, np.sign(arrays[name]) * np.inf, arrays[name])

    columns = len(catalogue(arguments))
    members, depth = arrays["conditions"].shape
    shapes = {
        "zero": (columns,),
        "weights": (members,),
        "scores": (members,),
        **{name: (members, depth) for name in ("low", "high", "soft")},
        **{name: arrays["typical"].shape for name in ("median", "spread", "side")},
    }
    wrong = next((name for name, shape in shapes.items() if arrays[name].shape != shape), None)
    if wrong is not None:
        raise InputError(f"array '{prefix}_{wrong}' has the shape {arrays[wrong].shape}")
    inside = (
        _within(arrays["used"], 0, columns)
        and _within(arrays["typical"], 0, columns)
        and _within(arrays["conditions"], -1, len(arrays["used"]))
    )
    if not inside or (arrays["soft"] <= 0).any() or (arrays["spread"] <= 0).any():
        raise InputError(f"the arrays '{prefix}_...' do not fit together")
    return Committee(arguments, **arrays)


BEYOND = 1e9
"""Bounds in files that mean none: files hold finite numbers alone."""


def _finite(array: NDArray[Any]) -> NDArray[Any]:
    return np.clip(array, -BEYOND, BEYOND) if array.dtype.kind == "f" else array


def _within(array: NDArray[Any], low: int, high: int) -> bool:
    integers = array.dtype.kind == "i" and array.ndim >= 1
    return integers and bool(((array >= low) & (array < high)).all())


def _check_carried(shown: Carried, arguments: int) -> None:
    charts, count = shown.yaw.shape if shown.yaw.ndim == 2 else (0, 0)
    shapes = {
        "codes": (charts, 4),
        "place": (charts, count, 2),
        "outside": (charts, count, 2),
        "R": (count, 3, 3),
    }
    if (
        not charts
        or not count
        or any(getattr(shown, name).shape != shape for name, shape in shapes.items())
    ):
        raise InputError("the arrays 'shown_...' do not fit together")
    turns = 2 * arguments + (2 if arguments > 2 else 0)
    limits = ((0, arguments), (-1, arguments + 2), (0, len(MODES)), (-1, turns))
    if not all(_within(shown.codes[:, column], *limit) for column, limit in enumerate(limits)):
        raise InputError("array 'shown_codes' names what is not there")
