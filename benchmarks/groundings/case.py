"""What is measured: of which grounding, trained on how many scenes, from which seed, on how many test scenes."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass
from typing import Any

from grounding.registry import PARAMETER_FREE, SHARED_WEIGHTS, TRAINING_VARIANTS

SIZES = (10, 50, 100, 500, 1_000, 5_000, 20_000)
"""Training scenes; the last one is the whole set."""

CLASSIFIERS = ("mlp-bb", "gnn-bb", "mlp-pc", "gnn-pc", "tree-bb", "tree-pc", "surface", "transfer", "flow")
"""Of figure 4. The classifiers of `uniform+mlp` and `uniform+gnn` are those of `mlp-bb` and `gnn-bb`."""

GENERATORS = (
    "uniform", "uniform+mlp", "uniform+gnn", "tree-bb", "tree-pc", "mlp-bb", "gnn-bb", "mlp-pc", "gnn-pc",
    "surface", "transfer", "flow",
)  # fmt: skip
"""Of figures 5 and 7: the paper's, the hand-made one, ours."""

FAILING = (*GENERATORS[:9], *TRAINING_VARIANTS, *GENERATORS[9:])
"""Of figure 6: also the networks taught by the discriminator or the classifier alone."""

FIGURES = ("fig4", "fig5", "fig6", "fig7")


@dataclass(frozen=True)
class Case:
    """One measurement, one line of the results.

    Attributes:
        measure: "accuracy" (figure 4), "success" (figures 5 and 6) or "times" (figure 7).
        relation: "on" or "inside".
        model: A name of `grounding.registry`.
        samples: Scenes that it was trained on; 0 of a model that is not trained.
        seed: Of its training; all are judged on the same test scenes.
        scenes: How many of these.
    """

    measure: str
    relation: str
    model: str
    samples: int
    seed: int
    scenes: int

    @property
    def config(self) -> dict[str, Any]:
        """All that tells it from another one, for the record."""
        return asdict(self)

    @property
    def weights(self) -> str:
        """The name of its weights, of those of the model that it borrows them from."""
        return f"{self.relation}-{SHARED_WEIGHTS.get(self.model, self.model)}-{self.samples}-{self.seed}"


@dataclass(frozen=True)
class Plan:
    """How much is measured.

    Attributes:
        relations: "on", "inside" or both.
        models: At most these.
        sizes: Training scenes, increasing; the last one is the whole set.
        seeds: Trainings on the whole set; one on fewer scenes.
        scenes: Test scenes of a measurement of success; of accuracy twice as many, of times a tenth.
        cloud_scenes: The same of models on clouds, which take 0.1 s for each pose.
    """

    relations: Sequence[str]
    models: Sequence[str]
    sizes: Sequence[int]
    seeds: int
    scenes: int
    cloud_scenes: int


def cases(figure: str, plan: Plan) -> list[Case]:
    """All measurements of a figure, the first seeds and the whole training set first.

    Args:
        figure: One of FIGURES.
        plan: How much is measured.
    """
    measure, names = _MEASURED[figure]
    return [
        Case(
            measure, relation, model, *((0, 0) if model in PARAMETER_FREE else training), _scenes(measure, model, plan)
        )
        for training in _trainings(figure, plan)
        for relation in plan.relations
        for model in names
        if model in plan.models
    ]


_MEASURED: Mapping[str, tuple[str, Sequence[str]]] = {
    "fig4": ("accuracy", CLASSIFIERS),
    "fig5": ("success", GENERATORS),
    "fig6": ("success", FAILING),
    "fig7": ("times", GENERATORS),
}


def _trainings(figure: str, plan: Plan) -> list[tuple[int, int]]:
    """Samples and seed."""
    whole = plan.sizes[-1]
    smaller = [(size, 0) for size in plan.sizes[:-1]] if figure == "fig5" else []
    more = [(whole, seed) for seed in range(1, plan.seeds)] if figure != "fig7" else []
    return [(whole, 0), *smaller, *more]


def _scenes(measure: str, model: str, plan: Plan) -> int:
    scenes = plan.cloud_scenes if model.endswith("-pc") else plan.scenes
    return {"accuracy": 2 * scenes, "success": scenes, "times": max(1, scenes // 10)}[measure]
