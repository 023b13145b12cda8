"""The registry of groundings: by relation and name, made from the weights that ship or that a user
trained.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

from grounding.certainty import cannot_tell
from grounding.model import RelationModel
from grounding.runtime import Grounding, Proposer
from grounding.weights import Weights, read_weights
from tamp.errors import InputError
from tamp.geometric.samplers.choice import ANY_RELATION
from tamp.geometric.samplers.registry import SAMPLERS
from tamp.geometric.samplers.sampler import Generator

if TYPE_CHECKING:
    from grounding.relations.grounding import LearnedRelation

SHIPPED = Path(__file__).resolve().parent / "assets"
"""Where the shipped weights are."""


def _relational(weights: Weights) -> RelationModel:
    from grounding.relational.model import RelationalModel

    return RelationalModel(weights)


def _paper(weights: Weights) -> RelationModel:
    from grounding.paper.runtime import PaperModel

    return PaperModel(weights)


def _tree(weights: Weights) -> RelationModel:
    from grounding.paper.trees import TreeModel

    return TreeModel(weights)


def _uniform(weights: Weights | None = None) -> RelationModel:
    from grounding.paper.uniform import UniformModel

    return UniformModel(weights)


def _surface() -> RelationModel:
    from grounding.surface import SurfaceModel

    return SurfaceModel()


MODELS: Mapping[str, Callable[[Weights], RelationModel]] = {
    "transfer": _relational,
    "flow": _relational,
    "mlp-bb": _paper,
    "gnn-bb": _paper,
    "mlp-pc": _paper,
    "gnn-pc": _paper,
    "tree-bb": _tree,
    "tree-pc": _tree,
    "uniform+mlp": _uniform,
    "uniform+gnn": _uniform,
}
"""Model name to what makes it of weights."""

SHARED_WEIGHTS: Mapping[str, str] = {"uniform+mlp": "mlp-bb", "uniform+gnn": "gnn-bb"}
"""Model name to the one whose weights it uses, of which it takes the classifier."""

TRAINING_VARIANTS: Mapping[str, str] = {
    f"{model}-{scheme}": model
    for model in ("mlp-bb", "gnn-bb")
    for scheme in ("discriminator", "classifier")
}
"""Name of what ships of one training scheme, of the household layout, to the model that it is."""

PARAMETER_FREE: Mapping[str, Callable[[], RelationModel]] = {
    "surface": _surface,
    "uniform": _uniform,
}
"""Model name to what makes it of nothing."""

FEW_SHOT = "conjunctions"
"""The model of relations from a few demonstrations (`tamp-learn new`)."""

RELATIONS = ("on", "inside")

LEARNED = ("stack", "pack", "left_of", "between")
"""Relations that were learned from the scripted demonstrations of examples/table/show.py: their
name is "learned", and the domain `learned` has them."""


def load_model(path: Path, model: str | None = None) -> RelationModel:
    """Load the model of a weight file.

    Args:
        path: The file; its card is beside it.
        model: Which model to make of it; by default the one that the card names.

    Raises:
        InputError: The file is missing, damaged, or of a model that this version does not know; or
            the model asked for is not made of such weights.
    """
    weights = read_weights(path)
    trained = str(weights.card.get("model"))
    if trained not in MODELS or trained in SHARED_WEIGHTS:
        choices = [name for name in MODELS if name not in SHARED_WEIGHTS]
        raise InputError(
            f"unknown model '{trained}'",
            file=path.with_suffix(".json"),
            found=trained,
            choices=choices,
        )

    name = model or trained
    if name not in MODELS and name not in PARAMETER_FREE:
        raise InputError(f"unknown model '{name}'", found=name, choices=MODELS)
    if SHARED_WEIGHTS.get(name, name) != trained:
        raise InputError(
            f"these are weights of '{trained}'; '{name}' is not made of them", file=path
        )

    try:
        return MODELS[name](weights)
    except InputError as error:
        raise error.at(path) from None
    except (AttributeError, IndexError, KeyError, TypeError, ValueError) as error:
        raise InputError(f"these are no weights of '{name}': {error}", file=path) from None


def shipped_model(relation: str, name: str) -> RelationModel:
    """Load the model of a name, of the weights that ship, or of none where it needs none.

    Raises:
        InputError: An unknown relation or name, or weights that do not ship; then how to train
            them.
    """
    if relation not in RELATIONS:
        raise InputError(f"unknown relation '{relation}'", found=relation, choices=RELATIONS)
    if name in PARAMETER_FREE:
        return PARAMETER_FREE[name]()
    if name not in MODELS and name not in TRAINING_VARIANTS:
        raise InputError(
            f"unknown model '{name}'",
            found=name,
            choices=[*MODELS, *TRAINING_VARIANTS, *PARAMETER_FREE],
        )
    path = shipped_weights(relation, name)
    model = TRAINING_VARIANTS.get(name, name)
    if not path.is_file():
        scheme = f" --scheme {name.rpartition('-')[2]}" if name in TRAINING_VARIANTS else ""
        trained = SHARED_WEIGHTS.get(model, model)
        remedy = f"Train it: tamp-learn train {relation} --model {trained}{scheme} --out {path}"
        raise InputError(f"no weights of '{name}' for '{relation}' are shipped", remedy=remedy)
    return load_model(path, model)


def load_grounding(path: Path, model: str | None = None) -> Grounding | Proposer | LearnedRelation:
    """Load a model for the planner; without a classifier where the card says that it cannot tell
    yet.
    """
    weights = read_weights(path)
    few = weights.card.get("model") == FEW_SHOT
    grounding = _learned_relation(weights, path) if few else _grounding(load_model(path, model))
    why = cannot_tell(weights.card)
    return grounding if why is None else Proposer(grounding, why)


def is_few_shot(name: str) -> bool:
    """Check whether a name is a file of weights that `tamp-learn new` has written."""
    path = Path(name)
    if path.suffix != ".safetensors" or not path.is_file():
        return False
    return read_weights(path).card.get("model") == FEW_SHOT


def _learned_relation(weights: Weights, path: Path) -> LearnedRelation:
    from grounding.relations.grounding import LearnedRelation

    try:
        return LearnedRelation(weights)
    except InputError as error:
        raise error.at(path) from None
    except (AttributeError, IndexError, KeyError, TypeError, ValueError) as error:
        raise InputError(f"these are no weights of '{FEW_SHOT}': {error}", file=path) from None


def file_grounding(relation: str, path: Path) -> Grounding | Proposer | LearnedRelation:
    """Load a grounding of a file that must be about this relation.

    Raises:
        InputError: It is about another one, or as for `load_model`.
    """
    found = read_weights(path).card.get("relation")
    if found != relation:
        raise InputError(f"these are weights for '{found}', not '{relation}'", file=path)
    return load_grounding(path)


def shipped_grounding(relation: str, name: str) -> Grounding:
    """Load a shipped model for the planner."""
    return _grounding(shipped_model(relation, name))


def _grounding(model: RelationModel) -> Grounding:
    from grounding.paper.planner_adapter import SnappingSampler
    from grounding.paper.runtime import PaperModel
    from grounding.relational.model import RelationalModel
    from grounding.relational.planner_adapter import PlacingSampler

    if isinstance(model, RelationalModel):
        return PlacingSampler(model)
    return SnappingSampler(model) if isinstance(model, PaperModel) else Grounding(model)


def shipped_weights(relation: str, name: str) -> Path:
    """Return the path of the shipped weights of a model, if they are there."""
    return SHIPPED / f"{relation}_{SHARED_WEIGHTS.get(name, name)}.safetensors"


GROUNDINGS: Mapping[str, Mapping[str, Callable[..., Grounding | Generator]]] = {
    **{
        relation: {
            **SAMPLERS[relation],
            **{
                name: partial(shipped_grounding, relation, name)
                for name in (*MODELS, *TRAINING_VARIANTS)
            },
        }
        for relation in RELATIONS
    },
    **{
        relation: {
            "learned": partial(
                file_grounding, relation, SHIPPED / f"{relation}_learned.safetensors"
            )
        }
        for relation in LEARNED
    },
    ANY_RELATION: {".safetensors": file_grounding},
}
"""Relation to name to what makes the grounding: what `--sampler on=transfer` and `--sampler
on=FILE.safetensors` mean.

`surface` and `uniform` are the planner's own. Where the weights of a name do not ship, asking for
it says so and how to train them.
"""
