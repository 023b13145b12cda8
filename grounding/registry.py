"""Which groundings there are: by relation and name, made from the weights that ship or that a user trained."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import partial
from pathlib import Path

from grounding.model import Model
from grounding.runtime import Grounding
from grounding.weights import Weights, read_weights
from tamp.errors import InputError

SHIPPED = Path(__file__).resolve().parent / "assets"
"""Where the shipped weights are."""


def _relational(weights: Weights) -> Model:
    from grounding.relational.model import RelationalModel

    return RelationalModel(weights)


MODELS: Mapping[str, Callable[[Weights], Model]] = {"transfer": _relational, "flow": _relational}
"""Model name to what makes it of weights."""

RELATIONS = ("on", "inside")


def load_model(path: Path) -> Model:
    """The model of a weight file.

    Raises:
        InputError: The file is missing, damaged, or of a model that this version does not know.
    """
    weights = read_weights(path)
    name = str(weights.card.get("model"))
    if name not in MODELS:
        raise InputError(f"unknown model '{name}'", file=path.with_suffix(".json"), found=name, choices=MODELS)
    try:
        return MODELS[name](weights)
    except (KeyError, TypeError, ValueError) as error:
        raise InputError(f"these are no weights of '{name}': {error}", file=path) from None


def load_grounding(path: Path) -> Grounding:
    """The same for the planner."""
    return Grounding(load_model(path))


def shipped_weights(relation: str, model: str) -> Path:
    """Where the shipped weights of a model are."""
    return SHIPPED / f"{relation}_{model}.safetensors"


GROUNDINGS: Mapping[str, Mapping[str, Callable[[], Grounding]]] = {
    relation: {name: partial(load_grounding, shipped_weights(relation, name)) for name in MODELS}
    for relation in RELATIONS
}
"""Relation to name to what loads the shipped grounding: what `--sampler on=transfer` means."""
