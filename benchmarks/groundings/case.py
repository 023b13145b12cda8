"""What is measured: of which grounding, trained on how many scenes, from which seed, on how many test scenes."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass
from typing import Any

from benchmarks.paper_ways import BEST, MIDDLE, Variant
from grounding.paper.trainer_options import HEADLINE_SCHEME
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

DEPARTED = ("mlp-pc-middle", "gnn-pc-middle", "gnn-bb-departed")
"""Of all figures in the paper's layout: its networks on codes about the middle, and the one that passes the blind
ceiling.
"""

NAMES = (*FAILING, *DEPARTED)
"""All that can be measured, in the order of the tables."""

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
        draws: Poses a scene.
    """

    measure: str
    relation: str
    model: str
    samples: int
    seed: int
    scenes: int
    draws: int = 1

    @property
    def config(self) -> dict[str, Any]:
        """All that tells it from another one, for the record; draws where there are several."""
        return {name: value for name, value in asdict(self).items() if name != "draws" or value != 1}

    @property
    def weights(self) -> str:
        """The name of its weights, of those of the model that it borrows them from."""
        return f"{self.relation}-{self.trained}-{self.samples}-{self.seed}"

    @property
    def trained(self) -> str:
        """The name of what is trained for it."""
        return SHARED_WEIGHTS.get(self.model, self.model)

    @property
    def variant(self) -> Variant:
        """How it is trained, where it is a network of the paper's."""
        name = self.trained
        if name == "gnn-bb-departed":
            return BEST[self.relation]
        if name in DEPARTED:
            return Variant(name.removesuffix("-middle"), self._scheme, MIDDLE)
        if name in TRAINING_VARIANTS:
            return Variant(TRAINING_VARIANTS[name], name.rpartition("-")[2])
        return Variant(name, self._scheme)

    @property
    def _scheme(self) -> str:
        return HEADLINE_SCHEME.get(self.relation, "both")


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
        draws: Poses a scene that success is measured by.
    """

    relations: Sequence[str]
    models: Sequence[str]
    sizes: Sequence[int]
    seeds: int
    scenes: int
    cloud_scenes: int
    draws: int = 1


def cases(figure: str, plan: Plan) -> list[Case]:
    """All measurements of a figure, the first seeds and the whole training set first.

    Args:
        figure: One of FIGURES.
        plan: How much is measured.
    """
    measure, names = _MEASURED[figure]
    return [
        Case(
            measure,
            relation,
            model,
            *((0, 0) if model in PARAMETER_FREE else training),
            _scenes(measure, model, plan),
            plan.draws if measure == "success" else 1,
        )
        for training in _trainings(figure, plan)
        for relation in plan.relations
        for model in (*names, *DEPARTED)
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
    scenes = plan.cloud_scenes if on_clouds(model) else plan.scenes
    return {"accuracy": 2 * scenes, "success": scenes, "times": max(1, scenes // 10)}[measure]


def on_clouds(model: str) -> bool:
    """Check whether a model sees clouds."""
    return "-pc" in model
